#include "meshes/obstacle.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/files.h"
#include "meshes/meridian.h"

namespace fingertip::meshes {

namespace {

/// A place seen from an obstacle that is tilted against the finger: along t1, t2 and against n.
Vector3 seen(const Vector3& w, double tilt) {
  const double s = std::sin(tilt), c = std::cos(tilt);
  return {c * w.x() - s * w.z(), w.y(), s * w.x() + c * w.z()};
}

/// Where a surface first meets the obstacle, and how far the plane of its top is then from the
/// origin.
HighestPlace first_place(const Meridian& meridian, ProfileSurface surface, double tilt,
                         const Obstacle& obstacle) {
  return meridian.highest(surface, tilt == 0.0 && obstacle.on_axis(), [&](const Vector3& w) {
    const Vector3 at = seen(w, tilt);
    return at.z() + height(obstacle, at);
  });
}

}  // namespace

std::string_view name(ObstacleShape shape) {
  switch (shape) {
    case ObstacleShape::plane: return "plane";
    case ObstacleShape::sphere: return "sphere";
    case ObstacleShape::cylinder: return "cylinder";
    case ObstacleShape::edge: return "edge";
  }
  return "";
}

std::string_view name(ObstacleAxis axis) {
  return axis == ObstacleAxis::x ? "x" : "y";
}

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
  const bool on_face =
      form.edge && std::abs(from_centre.x() + from_centre.y()) > from_centre.z();
  if (form.flat || on_face) return Eigen::Matrix3d::Zero();
  return (Eigen::Matrix3d(bends.asDiagonal()) - normal * normal.transpose()) / from_centre.norm();
}

double height(const Obstacle& obstacle, const Vector3& place) {
  return obstacle_height(obstacle.form(), place.x(), place.y());
}

double first_touch(const Geometry& geometry, double tilt, const Obstacle& obstacle) {
  if (obstacle.is_plane()) return geometry.reach(tilt);
  return first_place(Meridian(geometry), ProfileSurface::contact, tilt, obstacle).height;
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
  const Meridian meridian(geometry);
  const HighestPlace touch = first_place(meridian, ProfileSurface::contact, tilt, *this);
  if (shape != ObstacleShape::edge && !(height(*this, seen(touch.place, tilt)) > -radius)) {
    found.push_back({"obstacle.offset", to_text(offset) + " m", "the obstacle misses the finger",
                     "bring it nearer to the axis, or make it larger"});
    return found;
  }
  for (const ProfileSurface surface : {ProfileSurface::bond, ProfileSurface::free}) {
    // Where both meet they are touched together.
    const double other = first_place(meridian, surface, tilt, *this).height;
    if (!(other > touch.height + 1e-9 * geometry.tip_radius)) continue;
    found.push_back({"obstacle.offset", to_text(offset) + " m",
                     "the obstacle starts inside the finger: when it comes to what may touch, it "
                     "lies " +
                         to_text(other - touch.height) + " m deep in its surface \"" +
                         std::string(name(surface)) + "\"",
                     "move the obstacle, or mark that surface \"contact\""});
    break;
  }
  return found;
}

}  // namespace fingertip::meshes
