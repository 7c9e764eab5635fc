#include "meshes/press/taxels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/press/footprint_mean.h"

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

namespace {

/// What a taxel reads, and how well the points tell it.
struct Told {
  TaxelReading reading;
  double error = 0.0, spacing = 0.0;  ///< FootprintMean
};

Vector3 conducted_to(std::span<const ContactPoint> points, const Vector3& place,
                     const Matrix3d& own, double depth, double footprint) {
  Vector3 stress = Vector3::Zero();  // along u, v and into the finger
  for (const ContactPoint& point : points) {
    const double radius = std::max(std::sqrt(point.area / pi), point.reach);
    const Vector3 chord = own.transpose() * (place - point.rest);
    Vector3 load = (turn(own.col(2), -point.normal) * own).transpose() * point.force();
    load.z() *= -1.0;
    Vector3 to = Vector3::Zero();
    if (const double seen = chord.head<2>().norm(); seen > 0.0)
      to.head<2>() = chord.norm() / seen * chord.head<2>();
    else
      to.x() = chord.norm();  // through the finger
    to.z() = depth;
    stress += conducted(load, to, std::hypot(footprint, radius));
  }
  return stress;
}

std::vector<Told> told(std::span<const ContactPoint> points, const TaxelSkin& skin,
                       const Matrix3d& axes) {
  const double footprint = 0.5 * skin.footprint;
  const FootprintMeans field(skin.depth > 0.0 ? std::span<const ContactPoint>() : points, axes);
  std::vector<Told> all;
  for (const Taxel& taxel : skin.taxels) {
    const Matrix3d own = axes * turn(Vector3::UnitZ(), taxel.normal);
    const Vector3 place = axes * taxel.place;
    if (skin.depth > 0.0) {
      const Vector3 stress = conducted_to(points, place, own, skin.depth, footprint);
      all.push_back({{stress.z(), stress.x(), stress.y()}, unknown, unknown});
      continue;
    }
    const FootprintMean mean = field.over(place, own, footprint);
    all.push_back({{mean.pressure, mean.shear.x(), mean.shear.y()}, mean.error, mean.spacing});
  }
  return all;
}

}  // namespace

std::vector<TaxelReading> taxel_readings(std::span<const ContactPoint> points,
                                         const TaxelSkin& skin, const Matrix3d& axes) {
  std::vector<TaxelReading> readings;
  for (const Told& taxel : told(points, skin, axes)) readings.push_back(taxel.reading);
  return readings;
}

double felt_force(std::span<const TaxelRow> sample) {
  double force = 0.0;
  for (const TaxelRow& row : sample) force += row.area * row.normal_stress;
  return force;
}

std::vector<TaxelRow> taxel_rows(std::span<const ContactPoint> field, const TaxelSkin& skin,
                                 const Matrix3d& axes, const FieldQuality& quality) {
  std::vector<TaxelRow> rows;
  for (const auto& sample : samples_of(field)) {
    const auto row = std::size_t(sample[0].sample);
    const double known =
        row <= quality.pressure_errors.size() ? quality.pressure_errors[row - 1] : unknown;
    const std::vector<Told> taxels = told(sample, skin, axes);
    for (std::size_t i = 0; i < taxels.size(); ++i) {
      const Taxel& taxel = skin.taxels[i];
      TaxelRow& felt = rows.emplace_back(
          TaxelRow{sample[0].sample, sample[0].indentation, int(i + 1), taxel.place, taxel.area});
      felt.normal_stress = taxels[i].reading.normal_stress;
      felt.shear_u = taxels[i].reading.shear_u;
      felt.shear_v = taxels[i].reading.shear_v;
      const bool touches = taxels[i].spacing > 0.0;
      felt.error =
          touches && std::isfinite(known) ? std::hypot(known, taxels[i].error) : taxels[i].error;
      felt.spacing = touches ? std::max(taxels[i].spacing, quality.spacing) : taxels[i].spacing;
    }
  }
  return rows;
}

double coarsest_spacing(std::span<const TaxelRow> sample) {
  double most = 0.0;
  for (const TaxelRow& row : sample)
    if (row.spacing > most) most = row.spacing;
  return most;
}

}  // namespace fingertip::meshes::inline press
