#include "fem_reference/analytic/thick_sphere.h"

namespace fingertip::fem_reference::analytic {

ThickSphere::ThickSphere(const meshes::Rubber& rubber, const Parameters& parameters)
    : bulk_modulus_(checked(rubber).bulk_modulus()), shear_modulus_(rubber.shear_modulus) {
  const double a = checked_positive("inner_radius", parameters.inner_radius);
  const double b = checked_positive("outer_radius", parameters.outer_radius);
  require(b > a, "outer_radius", b, "must exceed inner_radius");
  const double inside = checked_finite("inner_pressure", parameters.inner_pressure);
  const double outside = checked_finite("outer_pressure", parameters.outer_pressure);
  const double a3 = a * a * a, b3 = b * b * b;
  dilation_ = (inside * a3 - outside * b3) / (3.0 * bulk_modulus_ * (b3 - a3));
  source_ = (inside - outside) * a3 * b3 / (4.0 * shear_modulus_ * (b3 - a3));
}

double ThickSphere::radial_displacement(double r) const {
  return dilation_ * r + source_ / (r * r);
}

double ThickSphere::radial_stress(double r) const {
  return 3.0 * bulk_modulus_ * dilation_ - 4.0 * shear_modulus_ * source_ / (r * r * r);
}

double ThickSphere::tangential_stress(double r) const {
  return 3.0 * bulk_modulus_ * dilation_ + 2.0 * shear_modulus_ * source_ / (r * r * r);
}

Vector3 ThickSphere::displacement(const Vector3& x) const {
  return radial_displacement(x.norm()) * x.normalized();
}

Matrix3 ThickSphere::gradient(const Vector3& x) const {
  const double r = x.norm();
  const Vector3 n = x / r;
  return (dilation_ + source_ / (r * r * r)) * Matrix3::Identity() -
         3.0 * source_ / (r * r * r) * n * n.transpose();
}

Matrix3 ThickSphere::stress(const Vector3& x) const {
  const double r = x.norm();
  const Vector3 n = x / r;
  const Matrix3 radial = n * n.transpose();
  return radial_stress(r) * radial + tangential_stress(r) * (Matrix3::Identity() - radial);
}

}  // namespace fingertip::fem_reference::analytic
