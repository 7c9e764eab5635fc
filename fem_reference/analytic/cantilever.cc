#include "fem_reference/analytic/cantilever.h"

#include <cmath>

namespace fingertip::fem_reference::analytic {
PlaneStrainCantilever::PlaneStrainCantilever(const meshes::Rubber& rubber,
                                             const Parameters& parameters)
    : rubber_(checked(rubber)), parameters_(parameters) {
  checked_positive("height", parameters.height);
  checked_positive("length", parameters.length);
  checked_finite("load_per_width", parameters.load_per_width);
}

double PlaneStrainCantilever::plane_modulus() const {
  const double nu = rubber_.poissons_ratio();
  return rubber_.youngs_modulus / (1.0 - nu * nu);
}

double PlaneStrainCantilever::plane_ratio() const {
  const double nu = rubber_.poissons_ratio();
  return nu / (1.0 - nu);
}

double PlaneStrainCantilever::second_moment() const {
  return std::pow(parameters_.height, 3) / 12.0;
}

double PlaneStrainCantilever::shear_coefficient() const {
  return 10.0 * (1.0 + plane_ratio()) / (12.0 + 11.0 * plane_ratio());
}

double PlaneStrainCantilever::tip_deflection() const {
  const auto& [h, L, q] = parameters_;
  return q * std::pow(L, 3) / (3.0 * plane_modulus() * second_moment()) +
         q * L / (shear_coefficient() * rubber_.shear_modulus * h);
}

Vector3 PlaneStrainCantilever::displacement(const Vector3& x) const {
  const auto& [h, L, q] = parameters_;
  const double nu = plane_ratio(), z = x.z();
  const double slope = L * x.x() - x.x() * x.x() / 2.0;
  const double warping = nu * z * z * z / 6.0 + (1.0 + nu) * z * (h * h / 4.0 - z * z / 3.0);
  const double s = (8.0 + 9.0 * nu) * h * h / 40.0;
  const double lift = nu * ((L - x.x()) * z * z / 2.0 - L * h * h / 24.0);
  return q / (plane_modulus() * second_moment()) *
         Vector3(-z * slope + warping - s * z, 0.0,
                 x.x() * x.x() * (L / 2.0 - x.x() / 6.0) + lift + s * x.x());
}

Matrix3 PlaneStrainCantilever::gradient(const Vector3& x) const {
  const auto& [h, L, q] = parameters_;
  const double nu = plane_ratio(), to_tip = L - x.x(), z = x.z();
  const double slope = L * x.x() - x.x() * x.x() / 2.0;
  const double s = (8.0 + 9.0 * nu) * h * h / 40.0;
  const double warping_z = nu * z * z / 2.0 + (1.0 + nu) * (h * h / 4.0 - z * z);
  Matrix3 result = Matrix3::Zero();
  result(0, 0) = -z * to_tip;
  result(0, 2) = -slope + warping_z - s;
  result(2, 0) = slope - nu * z * z / 2.0 + s;
  result(2, 2) = nu * to_tip * z;
  return q / (plane_modulus() * second_moment()) * result;
}

Matrix3 PlaneStrainCantilever::stress(const Vector3& x) const {
  const auto& [h, L, q] = parameters_;
  const double xx = -(L - x.x()) * x.z();
  Matrix3 result = Matrix3::Zero();
  result(0, 0) = xx;
  result(1, 1) = rubber_.poissons_ratio() * xx;
  result(0, 2) = result(2, 0) = (h * h / 4.0 - x.z() * x.z()) / 2.0;
  return q / second_moment() * result;
}

}  // namespace fingertip::fem_reference::analytic
