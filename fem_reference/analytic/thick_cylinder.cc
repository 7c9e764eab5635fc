#include "fem_reference/analytic/thick_cylinder.h"

#include <cmath>

namespace fingertip::fem_reference::analytic {
namespace {

/// Unit vector from the axis to x.
Vector3 outward(const Vector3& x) {
  return Vector3(x.x(), x.y(), 0.0) / std::hypot(x.x(), x.y());
}

Matrix3 in_plane() {
  return Vector3(1.0, 1.0, 0.0).asDiagonal();
}

}  // namespace

ThickCylinder::ThickCylinder(const meshes::Rubber& rubber, const Parameters& parameters)
    : lambda_(checked(rubber).lame_lambda()), shear_modulus_(rubber.shear_modulus) {
  const double a = checked_positive("inner_radius", parameters.inner_radius);
  const double b = checked_positive("outer_radius", parameters.outer_radius);
  require(b > a, "outer_radius", b, "must exceed inner_radius");
  const double inside = checked_finite("inner_pressure", parameters.inner_pressure);
  const double outside = checked_finite("outer_pressure", parameters.outer_pressure);
  const double a2 = a * a, b2 = b * b;
  dilation_ = (inside * a2 - outside * b2) / (2.0 * (lambda_ + shear_modulus_) * (b2 - a2));
  source_ = (inside - outside) * a2 * b2 / (2.0 * shear_modulus_ * (b2 - a2));
}

double ThickCylinder::radial_displacement(double r) const {
  return dilation_ * r + source_ / r;
}

double ThickCylinder::radial_stress(double r) const {
  return 2.0 * (lambda_ + shear_modulus_) * dilation_ - 2.0 * shear_modulus_ * source_ / (r * r);
}

double ThickCylinder::hoop_stress(double r) const {
  return 2.0 * (lambda_ + shear_modulus_) * dilation_ + 2.0 * shear_modulus_ * source_ / (r * r);
}

double ThickCylinder::axial_stress() const {
  return 2.0 * lambda_ * dilation_;
}

Vector3 ThickCylinder::displacement(const Vector3& x) const {
  return radial_displacement(std::hypot(x.x(), x.y())) * outward(x);
}

Matrix3 ThickCylinder::gradient(const Vector3& x) const {
  const Vector3 n = outward(x);
  const double shrink = source_ / (x.x() * x.x() + x.y() * x.y());
  return (dilation_ + shrink) * in_plane() - 2.0 * shrink * n * n.transpose();
}

Matrix3 ThickCylinder::stress(const Vector3& x) const {
  const Vector3 n = outward(x);
  const double r = std::hypot(x.x(), x.y());
  Matrix3 result = hoop_stress(r) * in_plane();
  result += (radial_stress(r) - hoop_stress(r)) * n * n.transpose();
  result(2, 2) = axial_stress();
  return result;
}

}  // namespace fingertip::fem_reference::analytic
