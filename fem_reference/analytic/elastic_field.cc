#include "fem_reference/analytic/elastic_field.h"

#include <cmath>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::fem_reference::analytic {

Matrix3 hooke_stress(const meshes::Rubber& rubber, const Matrix3& gradient) {
  return rubber.lame_lambda() * gradient.trace() * Matrix3::Identity() +
         rubber.shear_modulus * (gradient + gradient.transpose());
}

Vector3 ElasticField::body_force(const Vector3&) const {
  return Vector3::Zero();
}

const meshes::Rubber& checked(const meshes::Rubber& rubber) {
  if (auto violations = rubber.violations(); !violations.empty())
    throw meshes::InvalidInput(std::move(violations));
  return rubber;
}

void require(bool holds, std::string_view key, double value, std::string_view rule) {
  if (holds) return;
  const std::string text = std::isnan(value) ? "nan" : meshes::to_text(value);
  throw meshes::InvalidInput(
      meshes::Violation{std::string(key), text, std::string(rule), "give a value in that range"});
}

double checked_positive(std::string_view key, double value) {
  require(std::isfinite(value) && value > 0.0, key, value, "must be finite and positive");
  return value;
}

double checked_finite(std::string_view key, double value) {
  require(std::isfinite(value), key, value, "must be finite");
  return value;
}

}  // namespace fingertip::fem_reference::analytic
