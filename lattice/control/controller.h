/// The virtual control interface (paper, section III and Fig. 3): a controller sees measurements
/// at the rod's endpoint and answers with a wrench there, or with where the endpoint should be. It
/// cannot tell the model from hardware.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>
#include <variant>
#include <vector>

#include "lattice/model/rod.h"
#include "meshes/press/taxels.h"

namespace fingertip::lattice::inline control {

/// What a tactile sensor on the tip would tell.
struct ContactState {
  int touching = 0;     ///< points on the plane
  double radius = 0.0;  ///< of the contact patch [m]
  Wrench on_tip;        ///< of the plane, about the rod's endpoint [N, N m]
};

/// What the robot feels at the rod's endpoint (0, 0, -l), world axes = the rod's starting axes.
struct Measurement {
  double time = 0.0;  ///< when it was taken [s]
  Pose pose;          ///< position of the endpoint [m], orientation since the start
  Twist twist;        ///< of the endpoint
  Wrench wrench;      ///< of the tip on the rod, about the endpoint [N, N m]
  std::optional<ContactState> contact;         ///< where a tactile sensor is configured
  std::vector<meshes::TaxelReading> taxels{};  ///< of the skin, in its order; empty without one
};

/// A set point for the built-in servo: where the endpoint should be and how it should move.
struct Target {
  Pose pose;           ///< position of the endpoint [m], orientation since the start
  Twist twist;         ///< of the endpoint
  Twist acceleration;  ///< of the endpoint [m/s², rad/s²]
};

/// A wrench at the endpoint [N, N m], or a set point that the built-in servo turns into one.
using Command = std::variant<Wrench, Target>;

/// Whether every component is a finite number.
bool finite(const Wrench& wrench);
bool finite(const Target& target);

/// Thrown when a controller died, hangs, or commands what is no number. What was computed so far is
/// kept.
class ControllerFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a controller is about, for the record.
enum class ControlMode {
  position,  ///< on a way
  force,     ///< at a contact force
};

/// What a controller may tell of itself; NaN where it has nothing to tell.
struct ControllerReport {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  ControlMode mode = ControlMode::position;
  double stiffness = unknown;  ///< of the contact, as it takes it to be [N/m]
  double force = unknown;      ///< contact force it wants [N]
};

/// Computes the command that is held until the next sample (zero-order hold).
class Controller {
 public:
  virtual ~Controller() = default;
  /// Called once per sampling period, with increasing times. May throw ControllerFailed.
  virtual Command command(const Measurement& measurement) = 0;
  /// Forgets everything it has seen, as before the first command.
  virtual void reset() = 0;
  /// Of the last command.
  virtual ControllerReport report() const { return {}; }
};

}  // namespace fingertip::lattice::inline control
