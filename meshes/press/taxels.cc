#include "meshes/press/taxels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::meshes::inline press {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using std::numbers::pi;

namespace {

constexpr double on_surface = 0.01;  ///< of the largest radius
constexpr double shallowest = 0.1;   ///< depth over footprint that the sums below resolve
constexpr int steps_per_pitch = 16;  ///< along the surface
constexpr int finest_rings = 24;     ///< of the places over which a load is spread

Matrix3d turn(const Vector3& from, const Vector3& to) {
  return Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
}

/// What two discs share whose middles are this far apart [m²].
double shared_area(double distance, double a, double b) {
  if (distance >= a + b) return 0.0;
  const double smaller = std::min(a, b);
  if (distance <= std::abs(a - b)) return pi * smaller * smaller;
  // Half the angle under which the common chord is seen from each middle.
  const auto half_angle = [distance](double own, double other) {
    const double cosine =
        (distance * distance + own * own - other * other) / (2.0 * distance * own);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  const double at_a = half_angle(a, b), at_b = half_angle(b, a);
  return a * a * (at_a - 0.5 * std::sin(2.0 * at_a)) + b * b * (at_b - 0.5 * std::sin(2.0 * at_b));
}

/// The mean over a disc of `radius` around the place `to`, seen from a load on the surface, of the
/// stress that it causes; z into the half space, where `to` lies.
Vector3 conducted(const Vector3& load, const Vector3& to, double radius) {
  const double nearest = std::hypot(to.z(), std::max(0.0, to.head<2>().norm() - radius));
  const int rings = std::clamp(int(std::ceil(2.0 * radius / nearest)), 1, finest_rings);
  Vector3 sum = Vector3::Zero();
  for (int ring = 0; ring < rings; ++ring) {
    // Of equal areas per place; the disc's second moment.
    const int count = 6 * ring + 3;
    const double away = radius / rings * std::sqrt(ring * (ring + 1.0) + 0.5);
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * pi * (i + 0.5 * (ring % 2)) / count;
      const Vector3 r = to + away * Vector3(std::cos(angle), std::sin(angle), 0.0);
      const double square = r.squaredNorm();
      sum += r.dot(load) / (square * square * std::sqrt(square)) * r;
    }
  }
  return 3.0 * to.z() / (2.0 * pi * 3.0 * rings * rings) * sum;
}

std::string text_of(const Vector3& place) {
  return "(" + to_text(place.x()) + ", " + to_text(place.y()) + ", " + to_text(place.z()) + ") m";
}

}  // namespace

std::vector<Violation> TaxelSkin::violations() const {
  std::vector<Violation> found;
  if (taxels.empty()) return found;
  if (!(footprint > 0.0 && std::isfinite(footprint)))
    found.push_back({"sensor.footprint", to_text(footprint), "must be finite and positive",
                     "give such a diameter"});
  if (!(depth >= 0.0 && std::isfinite(depth)))
    found.push_back(
        {"sensor.depth", to_text(depth), "must be finite and not negative", "give such a depth"});
  else if (depth > 0.0 && depth < shallowest * footprint)
    found.push_back({"sensor.depth", to_text(depth),
                     "must be 0 or at least a tenth of the footprint (sensor.footprint), over "
                     "which the stress at so small a depth is that of the surface",
                     "write 0 mm"});
  return found;
}

Taxel taxel_at(const Shape& shape, const Vector3& place) {
  const NearestPoint on = shape.nearest(ProfileSurface::contact, place),
                     held = shape.nearest(ProfileSurface::bond, place);
  const auto refuse = [&](const std::string& rule, const std::string& remedy) {
    throw InvalidInput({"sensor.taxels", text_of(place), rule, remedy});
  };
  if (held.distance <= on.distance)
    refuse("lies in the bond, where the hand holds the finger",
           "move it to " + text_of(on.position) + ", or leave it out");
  if (on.distance > on_surface * shape.largest_radius())
    refuse("lies " + to_text(1e3 * on.distance) + " mm off the surface that may touch",
           "move it to " + text_of(on.position));
  return {on.position, on.normal, 0.0};
}

std::vector<Taxel> taxel_rings(const Shape& shape, int rings, int per_ring, double pitch) {
  std::vector<Taxel> taxels(std::size_t(rings) * std::size_t(per_ring));
  const double step = pitch / steps_per_pitch, angle = 2.0 * pi / per_ring;
  const Vector3 pole(0.0, 0.0, shape.pole());
  for (int j = 0; j < per_ring; ++j) {
    const double phi = (j + 0.5) * angle;
    const Vector3 across(-std::sin(phi), std::cos(phi), 0.0);
    NearestPoint at = shape.nearest(ProfileSurface::contact, pole);
    for (int i = 0; i < rings * steps_per_pitch; ++i) {
      const auto after = [&](const NearestPoint& seen, double way) {
        return shape.nearest(ProfileSurface::contact,
                             at.position + way * across.cross(seen.normal).normalized());
      };
      const NearestPoint middle = after(at, 0.5 * step), next = after(middle, step);
      const int ring = i / steps_per_pitch;
      if (next.distance > 0.5 * step || (next.position - at.position).norm() < 0.5 * step)
        throw InvalidInput({"sensor.taxels", std::to_string(rings) + " rings",
                            "ring " + std::to_string(ring + 1) +
                                " lies beyond the surface that may touch, which ends " +
                                to_text(1e3 * i * step) + " mm from the pole",
                            "ask for fewer rings, or for a smaller sensor.pitch"});
      Taxel& taxel = taxels[std::size_t(ring * per_ring + j)];
      if (i % steps_per_pitch == steps_per_pitch / 2)
        taxel.place = at.position, taxel.normal = at.normal;
      taxel.area += middle.position.head<2>().norm() * angle * step;
      at = next;
    }
  }
  return taxels;
}

std::vector<TaxelReading> taxel_readings(std::span<const ContactPoint> points,
                                         const TaxelSkin& skin, const Matrix3d& axes) {
  const double footprint = 0.5 * skin.footprint;
  std::vector<TaxelReading> readings;
  for (const Taxel& taxel : skin.taxels) {
    const Matrix3d own = axes * turn(Vector3::UnitZ(), taxel.normal);
    const Vector3 place = axes * taxel.place, normal = axes * taxel.normal;
    Vector3 stress = Vector3::Zero();  // along u, v and into the finger
    for (const ContactPoint& point : points) {
      const double radius = std::max(std::sqrt(point.area / pi), point.reach);
      const Vector3 chord = own.transpose() * (place - point.rest);
      const double distance = chord.norm();
      if (skin.depth == 0.0 && distance >= footprint + radius) continue;
      Vector3 load = (turn(normal, -point.normal) * own).transpose() * point.force();
      load.z() *= -1.0;
      if (skin.depth == 0.0) {
        stress += shared_area(distance, footprint, radius) /
                  (pi * footprint * footprint * pi * radius * radius) * load;
        continue;
      }
      Vector3 to = Vector3::Zero();
      if (const double seen = chord.head<2>().norm(); seen > 0.0)
        to.head<2>() = distance / seen * chord.head<2>();
      else
        to.x() = distance;  // through the finger
      to.z() = skin.depth;
      stress += conducted(load, to, std::hypot(footprint, radius));
    }
    readings.push_back({stress.z(), stress.x(), stress.y()});
  }
  return readings;
}

double felt_force(std::span<const TaxelRow> sample) {
  double force = 0.0;
  for (const TaxelRow& row : sample) force += row.area * row.normal_stress;
  return force;
}

std::vector<TaxelRow> taxel_rows(std::span<const ContactPoint> field, const TaxelSkin& skin,
                                 const Matrix3d& axes) {
  std::vector<TaxelRow> rows;
  for (const auto& sample : samples_of(field)) {
    const std::vector<TaxelReading> readings = taxel_readings(sample, skin, axes);
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const TaxelReading& reading = readings[i];
      rows.push_back({sample[0].sample, sample[0].indentation, int(i + 1), skin.taxels[i].place,
                      skin.taxels[i].area, reading.normal_stress, reading.shear_u,
                      reading.shear_v});
    }
  }
  return rows;
}

}  // namespace fingertip::meshes::inline press
