#include "fem_reference/analytic/thick_shell.h"

#include <cmath>

namespace fingertip::fem_reference::analytic {

ThickShell::ThickShell(int dimensions, const meshes::Rubber& rubber, const Parameters& parameters)
    : dimensions_(dimensions),
      across_(Vector3(1.0, 1.0, dimensions - 2.0).asDiagonal()),
      lambda_(checked(rubber).lame_lambda()),
      shear_modulus_(rubber.shear_modulus) {
  const double a = checked_positive("inner_radius", parameters.inner_radius);
  const double b = checked_positive("outer_radius", parameters.outer_radius);
  require(b > a, "outer_radius", b, "must exceed inner_radius");
  const double inside = checked_finite("inner_pressure", parameters.inner_pressure);
  const double outside = checked_finite("outer_pressure", parameters.outer_pressure);
  const double ad = std::pow(a, dimensions), bd = std::pow(b, dimensions);
  dilation_ =
      (inside * ad - outside * bd) / ((dimensions * lambda_ + 2.0 * shear_modulus_) * (bd - ad));
  source_ = (inside - outside) * ad * bd / (2.0 * (dimensions - 1) * shear_modulus_ * (bd - ad));
}

Vector3 ThickShell::from_core(const Vector3& x) const {
  return across_ * x;
}

double ThickShell::radial_displacement(double r) const {
  return dilation_ * r + source_ / std::pow(r, dimensions_ - 1);
}

double ThickShell::radial_stress(double r) const {
  return (dimensions_ * lambda_ + 2.0 * shear_modulus_) * dilation_ -
         2.0 * (dimensions_ - 1) * shear_modulus_ * source_ / std::pow(r, dimensions_);
}

double ThickShell::hoop_stress(double r) const {
  return (dimensions_ * lambda_ + 2.0 * shear_modulus_) * dilation_ +
         2.0 * shear_modulus_ * source_ / std::pow(r, dimensions_);
}

Vector3 ThickShell::displacement(const Vector3& x) const {
  const Vector3 w = from_core(x);
  return radial_displacement(w.norm()) * w.normalized();
}

Matrix3 ThickShell::gradient(const Vector3& x) const {
  const Vector3 w = from_core(x), n = w.normalized();
  const double shrink = source_ / std::pow(w.norm(), dimensions_);
  return (dilation_ + shrink) * across_ - dimensions_ * shrink * n * n.transpose();
}

Matrix3 ThickShell::stress(const Vector3& x) const {
  const Vector3 w = from_core(x), n = w.normalized();
  const double hoop = hoop_stress(w.norm());
  return hoop * across_ + (radial_stress(w.norm()) - hoop) * n * n.transpose() +
         2.0 * lambda_ * dilation_ * (Matrix3::Identity() - across_);
}

}  // namespace fingertip::fem_reference::analytic
