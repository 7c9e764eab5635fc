#include "lattice/grasp/block.h"

#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline grasp {

using meshes::Vector3;

std::vector<meshes::Violation> BlockSettings::violations() const {
  std::vector<meshes::Violation> found;
  const auto require = [&](double value, const char* key, const char* unit, const char* rule) {
    if (std::isfinite(value) && value > 0.0) return;
    found.push_back({key, meshes::to_text(value) + unit, rule, "give a positive value"});
  };
  require(mass, "grasp.block_mass", " kg", "the block's mass must be finite and positive");
  require(width, "grasp.block_width", " m", "the block's width must be finite and positive");
  require(height, "grasp.block_height", " m", "the block's height must be finite and positive");
  const Vector3 half = 0.5 * Vector3(width, height, height);
  if (!((eccentricity.cwiseAbs() - half).maxCoeff() < 0.0)) {
    found.push_back({"grasp.eccentricity", meshes::to_text(eccentricity.norm()) + " m",
                     "the centre of mass must lie inside the block", "choose it smaller"});
  }
  return found;
}

RodBody block_body(const BlockSettings& settings) {
  const double w = settings.width * settings.width, h = settings.height * settings.height;
  RodBody body;
  body.mass = settings.mass;
  body.centre = settings.eccentricity;
  body.inertia = settings.mass / 12.0 * Vector3(h + h, w + h, w + h).asDiagonal();
  return body;
}

Plane face_plane(const BlockSettings& settings, const RodState& block, double side,
                 const Pose& base) {
  const Eigen::Quaterniond into = base.orientation.conjugate();
  const Vector3 point = block.pose() * Vector3(0.5 * side * settings.width, 0.0, 0.0);
  Plane plane;
  plane.point = into * (point - base.position);
  plane.normal = into * face_normal(block, side);
  plane.velocity = into * block.velocity_at(point);
  plane.angular_velocity = into * block.angular_velocity();
  plane.turned = into * block.pose().orientation * base.orientation;
  return plane;
}

}  // namespace fingertip::lattice::inline grasp
