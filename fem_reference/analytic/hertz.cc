#include "fem_reference/analytic/hertz.h"

#include <cmath>
#include <numbers>

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {
namespace {

using std::numbers::pi;

double checked_not_negative(std::string_view key, double value) {
  require(std::isfinite(value) && value >= 0.0, key, value, "must be finite and not negative");
  return value;
}

}  // namespace

Hertz::Hertz(const meshes::Rubber& rubber, double radius)
    : modulus_(checked(rubber).youngs_modulus /
               (1.0 - rubber.poissons_ratio() * rubber.poissons_ratio())),
      radius_(checked_positive("radius", radius)) {}

double Hertz::force(double indentation) const {
  return 4.0 / 3.0 * modulus_ * contact_radius(indentation) * indentation;
}

double Hertz::contact_radius(double indentation) const {
  return std::sqrt(radius_ * checked_not_negative("indentation", indentation));
}

double Hertz::max_pressure(double indentation) const {
  return 2.0 * modulus_ * contact_radius(indentation) / (pi * radius_);
}

double Hertz::pressure(double r, double indentation) const {
  const double a = contact_radius(indentation);
  if (checked_not_negative("r", r) >= a) return 0.0;
  return max_pressure(indentation) * std::sqrt(1.0 - r * r / (a * a));
}

double Hertz::indentation_at_force(double force) const {
  const double scale = 4.0 / 3.0 * modulus_ * std::sqrt(radius_);
  return std::pow(checked_not_negative("force", force) / scale, 2.0 / 3.0);
}

}  // namespace fingertip::fem_reference::analytic
