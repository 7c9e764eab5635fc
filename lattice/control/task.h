/// What a controller is asked to do.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "lattice/control/controller.h"

namespace fingertip::lattice::inline control {

/// What a controller knows before its first measurement: the robot, and the task of the paper's
/// section III, an approach along a straight way into the plane.
struct ControlTask {
  double period = 1.0e-3;  ///< sampling period [s]
  Eigen::Matrix<double, 6, 6> inertia =
      Eigen::Matrix<double, 6, 6>::Identity();         ///< of the rod at
                                                       ///< its endpoint [kg, kg m, kg m²]
  double force_limit = 20.0;                           ///< of the actuator, per axis [N]
  double torque_limit = 1.0;                           ///< [N m]
  meshes::Vector3 normal = -meshes::Vector3::UnitZ();  ///< of the plane, toward the rod
  double clearance = 0.5e-3;                           ///< between pole and plane at the start [m]
  double depth = 3.0e-3;                               ///< wanted indentation [m]
  double speed = 0.01;                                 ///< of the approach [m/s]
  std::vector<meshes::Taxel> taxels;                   ///< of Measurement::taxels
  /// The approach at that speed, started smoothly, in the rod's starting orientation.
  std::function<Target(double time)> path;
  /// Lets a controller try the robot from its start, through the same hardware, until `done` or for
  /// `longest` [s]; afterwards all is as before. For identification; empty where there is no such
  /// chance.
  std::function<void(Controller& trial, const std::function<bool()>& done, double longest)>
      identify;
};

/// Makes the controller of a press. May throw ControllerFailed.
using ControllerFactory = std::function<std::unique_ptr<Controller>(const ControlTask& task)>;

}  // namespace fingertip::lattice::inline control
