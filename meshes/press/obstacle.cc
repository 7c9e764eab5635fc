#include "meshes/press/obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline press {

namespace {

/// A place seen from an obstacle that is tilted against the finger: along t1, t2 and against n.
Vector3 seen(const Vector3& w, double tilt) {
  const double s = std::sin(tilt), c = std::cos(tilt);
  return {c * w.x() - s * w.z(), w.y(), s * w.x() + c * w.z()};
}

/// Where a surface first meets the obstacle, and how far the plane of its top is then from the
/// origin.
HighestPlace first_place(const Shape& finger, ProfileSurface surface, double tilt,
                         const Obstacle& obstacle) {
  const auto top = [&](const Vector3& w) {
    const Vector3 at = seen(w, tilt);
    return at.z() + height(obstacle, at);
  };
  return finger.highest(surface, {top, tilt == 0.0 && obstacle.on_axis()});
}

}  // namespace

ObstacleForm Obstacle::form() const {
  if (is_plane()) return {};
  const bool sphere = shape == ObstacleShape::sphere;
  return {.flat = false,
          .edge = shape == ObstacleShape::edge,
          .radius = radius,
          .offset_x = offset,
          .across_x = along_x() ? 0.0 : 1.0,
          .across_y = sphere || along_x() ? 1.0 : 0.0};
}

ObstacleHit<double> hit(const Obstacle& obstacle, const Vector3& place) {
  return obstacle_hit(obstacle.form(), place.x(), place.y(), place.z());
}

Eigen::Matrix3d curvature(const Obstacle& obstacle, const Vector3& place) {
  const ObstacleForm form = obstacle.form();
  const ObstacleHit<double> found = obstacle_hit(form, place.x(), place.y(), place.z());
  const Vector3 normal(found.normal);
  const Vector3 bends(form.across_x, form.across_y, 1.0);
  const Vector3 from_centre(form.across_x * (place.x() - form.offset_x), form.across_y * place.y(),
                            place.z() + form.radius);
  const bool on_face = form.edge && std::abs(from_centre.x() + from_centre.y()) > from_centre.z();
  if (form.flat || on_face) return Eigen::Matrix3d::Zero();
  return (Eigen::Matrix3d(bends.asDiagonal()) - normal * normal.transpose()) / from_centre.norm();
}

double height(const Obstacle& obstacle, const Vector3& place) {
  return obstacle_height(obstacle.form(), place.x(), place.y());
}

ObstacleMesh obstacle_mesh(const Obstacle& obstacle, double half) {
  // Rows of points, each joined to the next.
  const bool sphere = obstacle.shape == ObstacleShape::sphere;
  const double offset = obstacle.along_x() ? 0.0 : obstacle.offset;
  const double reach = obstacle.is_plane() ? half : std::min(half, obstacle.radius);
  const std::size_t rows = obstacle.is_plane() ? 1 : 12, columns = sphere ? 32 : 1;
  ObstacleMesh mesh;
  for (std::size_t row = 0; row <= rows; ++row) {
    const double share = double(row) / double(rows);
    for (std::size_t column = 0; column <= columns; ++column) {
      const double turn = double(column) / double(columns);
      if (sphere) {
        const double down = share * std::asin(reach / obstacle.radius), r = obstacle.radius;
        const double angle = 2.0 * std::numbers::pi * turn;
        mesh.points.emplace_back(offset + r * std::sin(down) * std::cos(angle),
                                 r * std::sin(down) * std::sin(angle), r * (std::cos(down) - 1.0));
        continue;
      }
      // Denser where a cylinder is steep; an edge goes on to the end of the picture.
      const double wide = obstacle.shape == ObstacleShape::edge ? half : reach;
      const double across = wide * std::sin(std::numbers::pi * (share - 0.5));
      Vector3 place(offset + across, half * (2.0 * turn - 1.0), 0.0);
      if (obstacle.along_x()) std::swap(place.x(), place.y());
      place.z() = height(obstacle, place);
      mesh.points.push_back(place);
    }
  }
  const std::size_t width = columns + 1;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t first = row * width + column;
      mesh.quadrangles.push_back({first, first + 1, first + width + 1, first + width});
    }
  return mesh;
}

double relative_radius(const Shape& shape, const Obstacle& obstacle) {
  const double own = shape.pole_radius();
  if (obstacle.is_plane()) return own;
  const double across = own * obstacle.radius / (own + obstacle.radius);
  return obstacle.shape == ObstacleShape::sphere ? across : std::sqrt(across * own);
}

double first_touch(const Geometry& geometry, double tilt, const Obstacle& obstacle) {
  if (obstacle.is_plane()) return geometry.reach(tilt);
  return first_place(*shape_of(geometry), ProfileSurface::contact, tilt, obstacle).height;
}

Vector3 touched_first(const Geometry& geometry, double tilt, const Obstacle& obstacle) {
  return first_place(*shape_of(geometry), ProfileSurface::contact, tilt, obstacle).place;
}

std::vector<Violation> Obstacle::violations(const Geometry& geometry, double tilt) const {
  if (is_plane()) return {};
  std::vector<Violation> found;
  if (!(std::isfinite(radius) && radius > 0.0))
    found.push_back({"obstacle.radius", to_text(radius) + " m",
                     "the radius must be finite and positive", "give that of the obstacle"});
  if (!std::isfinite(offset))
    found.push_back({"obstacle.offset", to_text(offset) + " m", "the offset must be finite",
                     "give the place of the obstacle's top along t1"});
  if (!found.empty() || !geometry.violations().empty()) return found;
  const std::shared_ptr<const Shape> finger = shape_of(geometry);
  // Beside a ball or a cylinder there is none.
  const auto touch_of = [&](ProfileSurface surface) {
    const HighestPlace touch = first_place(*finger, surface, tilt, *this);
    const bool misses =
        shape != ObstacleShape::edge && !(meshes::height(*this, seen(touch.place, tilt)) > -radius);
    return misses ? -std::numeric_limits<double>::infinity() : touch.height;
  };
  const double touch = touch_of(ProfileSurface::contact);
  for (const ProfileSurface surface : {ProfileSurface::bond, ProfileSurface::free}) {
    // Where both meet they are touched together.
    if (!(touch_of(surface) > touch + 1e-9 * geometry.tip_radius)) continue;
    found.push_back({"obstacle.offset", to_text(offset) + " m",
                     "the obstacle starts inside the finger: it meets the surface \"" +
                         std::string(meshes::name(surface)) + "\" before what may touch",
                     "move the obstacle, or mark that surface \"contact\""});
    return found;
  }
  if (!std::isfinite(touch))
    found.push_back({"obstacle.offset", to_text(offset) + " m", "the obstacle misses the finger",
                     "bring it nearer to the axis, or make it larger"});
  return found;
}

}  // namespace fingertip::meshes::inline press
