/// What is done to the specimen: the rod carries the tip against a rigid plane to a given depth.
#pragma once

#include <string_view>
#include <vector>

#include "meshes/errors.h"
#include "meshes/geometry.h"

namespace fingertip::meshes {

/// How the tip and the plane interact (physics: README of this folder).
enum class ContactMode {
  stick,         ///< infinite friction: a surface point is anchored where it first touched
  frictionless,  ///< only the normal gap is held, compressive only
  coulomb,       ///< sticks until the shear force exceeds friction times the push, then slides
};

/// What moves the rod.
enum class DriveMode {
  pid,           ///< dynamics under a feedback controller that holds speed and orientation
  quasi_static,  ///< dynamics with the rod's motion prescribed: displacement-driven
  equilibrium,   ///< no time: a path of static equilibria
};

std::string_view name(ContactMode mode);
std::string_view name(DriveMode mode);

/// The press. Indentation is geometric: the distance the rod has travelled along the plane normal
/// since the sphere |w| = R touched the plane.
struct PressProtocol {
  DriveMode mode = DriveMode::pid;
  ContactMode contact = ContactMode::stick;
  double friction = 0.5;        ///< Coulomb's coefficient, contact coulomb only, > 0
  double tilt = 0.0;            ///< of the rod against the plane's normal, about y [rad]
  double lateral = 0.0;         ///< displacement of the plane along t1 at full depth [m]
  double depth = 3.0e-3;        ///< final indentation [m], 0 < depth < R - r
  double speed = 1.0e-2;        ///< approach speed [m/s], > 0
  double clearance = 0.5e-3;    ///< initial gap between pole and plane [m], > 0; starts at rest
  std::vector<double> samples;  ///< output indentations [m], increasing, last one = depth

  std::vector<Violation> violations(const Geometry& geometry) const;
};

/// Ten output depths [m] for a press to `depth` [m] > 0: 1, 2, 3, 5, 7.5, 10, 15, 20, 25 and 30
/// thirtieths of it, denser where the force is still strongly curved.
std::vector<double> default_samples(double depth);

}  // namespace fingertip::meshes
