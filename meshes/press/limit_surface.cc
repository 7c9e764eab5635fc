#include "meshes/press/limit_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fingertip::meshes::inline press {

using Eigen::Vector2d;

namespace {

/// Between which k is sought, and how many centres a surface has beside both ends.
constexpr double least_exponent = 0.5, greatest_exponent = 40.0;
constexpr int centres = 40;

double push_of(const ContactPoint& point) {
  return point.area * point.normal_traction;
}

/// <r²>/<r>² of p ∝ (1 - (r/a)^k)^(1/k), which falls with k and knows no a: <(r/a)^n> is
/// B((n + 2)/k, 1/k + 1) over that of n = 0.
double spread_of(double k) {
  const auto moment = [k](double n) { return std::beta((n + 2.0) / k, 1.0 / k + 1.0); };
  return moment(2.0) * moment(0.0) / std::pow(moment(1.0), 2);
}

double exponent_of(std::span<const ContactPoint> field, const Vector2d& centre, double force) {
  double first = 0.0, second = 0.0;
  for (const ContactPoint& point : field) {
    const double r = (point.place.head<2>() - centre).norm();
    first += push_of(point) * r;
    second += push_of(point) * r * r;
  }
  const double spread = second * force / (first * first);
  double low = least_exponent, high = greatest_exponent;
  if (!(spread < spread_of(low) && spread > spread_of(high))) return unknown;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (spread_of(middle) > spread ? low : high) = middle;
  }
  return high;
}

}  // namespace

LimitPoint limit_point(std::span<const ContactPoint> field, double away, double direction) {
  const Vector2d centre = centre_of_pressure(field).head<2>(),
                 along(std::cos(direction), std::sin(direction));
  LimitPoint result{.away = away};
  Vector2d sum = Vector2d::Zero();
  for (const ContactPoint& point : field) {
    const Vector2d arm = point.place.head<2>() - centre;
    const Vector2d turning = std::isinf(away) ? Vector2d(-along) : Vector2d(arm - away * along);
    const double length = turning.norm();
    if (!(length > 0.0)) continue;
    const Vector2d rub = push_of(point) / length * Vector2d(-turning.y(), turning.x());
    sum += rub;
    result.moment += arm.x() * rub.y() - arm.y() * rub.x();
  }
  result.force = sum.norm();
  return result;
}

LimitSurface limit_surface(std::span<const ContactPoint> field, double direction) {
  LimitSurface surface;
  double force = 0.0;
  for (const ContactPoint& point : field) force += push_of(point);
  if (!(force > 0.0)) return surface;
  const Vector2d centre = centre_of_pressure(field).head<2>();
  surface.normal_force = force;
  surface.radius = contact_radius(field);
  for (int i = 0; i <= centres; ++i) {
    const double share = double(i) / centres;
    const double away = i < centres ? surface.radius * share / (1.0 - share)
                                    : std::numeric_limits<double>::infinity();
    surface.points.push_back(limit_point(field, away, direction));
  }
  surface.greatest_moment = surface.points.front().moment;
  double least = std::numeric_limits<double>::infinity();
  for (const LimitPoint& point : surface.points)
    least =
        std::min(least, std::hypot(point.force / force, point.moment / surface.greatest_moment));
  surface.ellipse_error = 1.0 / least - 1.0;
  surface.exponent = exponent_of(field, centre, force);
  return surface;
}

RadiusLaw radius_law(std::span<const LimitSurface> surfaces) {
  double count = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const LimitSurface& surface : surfaces) {
    if (!(surface.normal_force > 0.0 && surface.radius > 0.0)) continue;
    const double n = std::log(surface.normal_force), a = std::log(surface.radius);
    count += 1.0, x += n, y += a, xx += n * n, xy += n * a;
  }
  const double spread = count * xx - x * x;
  if (!(spread > 1e-12 * count * xx)) return {};
  const double gamma = (count * xy - x * y) / spread;
  return {std::exp((y - gamma * x) / count), gamma};
}

}  // namespace fingertip::meshes::inline press
