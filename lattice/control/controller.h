/// The virtual control interface (paper, section III and Fig. 3): a controller sees measurements
/// at the rod's endpoint and answers with a wrench there. It cannot tell the model from hardware.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lattice/rod.h"

namespace fingertip::lattice {

/// What the robot feels at the rod's endpoint (0, 0, -l), world axes = the rod's starting axes.
struct Measurement {
  double time = 0.0;                                                ///< [s]
  meshes::Vector3 position = meshes::Vector3::Zero();               ///< of the endpoint [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< since the start
  meshes::Vector3 velocity = meshes::Vector3::Zero();               ///< [m/s]
  meshes::Vector3 angular_velocity = meshes::Vector3::Zero();       ///< [rad/s]
  Wrench bond;  ///< of the tip on the rod, about the endpoint [N, N m]
};

/// Computes the wrench applied to the rod's endpoint, held constant until the next sample.
class Controller {
 public:
  virtual ~Controller() = default;
  /// Called once per period(), with increasing times.
  virtual Wrench command(const Measurement& measurement) = 0;
  /// Sampling period [s], > 0.
  virtual double period() const = 0;
};

}  // namespace fingertip::lattice
