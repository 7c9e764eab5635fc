/// Relay auto-tuning: what the loop's gain and delay are, from an oscillation it makes itself.
#pragma once

#include <optional>
#include <vector>

#include "lattice/control/task.h"

namespace fingertip::lattice::inline control {

/// What a limit cycle tells of the loop.
struct RelayResult {
  double mass = 0.0;             ///< force over acceleration, actuator to velocity sensor [kg]
  double delay = 0.0;            ///< of the whole loop, the hold's half period included [s]
  double ultimate_gain = 0.0;    ///< Ku = 4 d/(pi A), describing function of the relay [N s/m]
  double ultimate_period = 0.0;  ///< [s]
  double level = 0.0;            ///< d of the relay [N]
  double hysteresis = 0.0;       ///< [m/s]
};

/// Force +-d along the plane's normal against the sign of the measured velocity, with hysteresis e
/// (three standard deviations of the noise it has listened to first). With M v' = u(t - L) + w the
/// velocity is a triangle between -(e + L (d - w)/M) and e + L (d + w)/M, from whose height H and
/// times of rise and fall tr, tf follow exactly, whatever constant load w < d there is,
///   M = 2 d / (H (1/tr + 1/tf)),   L = (H - 2 e) M/(2 d).
/// A relay that is asked once per period T switches T/2 late on average, just as its command, held,
/// acts T/2 late on average, so L is what a controller with that period meets (Astrom & Hagglund
/// 1984, 2006 chapter 8).
class RelayTuner final : public Controller {
 public:
  /// `share` of the measured wrench is fed forward, as it will be at work; `level` is d [N].
  RelayTuner(const ControlTask& task, double share, double level);

  Command command(const Measurement& measurement) override;
  void reset() override;
  /// Empty until the cycle has been measured.
  std::optional<RelayResult> result() const;
  /// Whether it has a result, or left three quarters of the way to the plane and cannot have one.
  bool finished() const { return lost_ || result().has_value(); }

 private:
  void listen(double velocity);
  void turn(double velocity, long sample);

  ControlTask task_;
  double share_;
  double level_;             ///< d [N]
  double hair_;              ///< off zero, where the relay turns [m/s]
  double hysteresis_ = 0.0;  ///< [m/s]
  double sign_ = 1.0;
  long sample_ = 0;
  long last_turn_ = 0;
  std::vector<double> quiet_;            ///< velocities before the relay starts [m/s]
  double highest_ = 0.0, lowest_ = 0.0;  ///< since the last turn [m/s]
  struct Half {
    double peak = 0.0;  ///< where the velocity turned [m/s]
    long samples = 0;   ///< from turn to turn
  };
  std::vector<Half> halves_;  ///< rise and fall in turn, a rise first
  std::optional<meshes::Vector3> start_;
  bool lost_ = false;
};

/// Lets relays of growing level play on the robot until one oscillates; empty when none does, or
/// when the task allows no identification.
std::optional<RelayResult> relay_experiment(const ControlTask& task, double share);

/// omega L of the triple pole -omega on the plant exp(-L s)/(M s²) at which the sensitivity's peak
/// is `sensitivity`: with sigma = s/omega the loop is (3 sigma² + 3 sigma + 1)/sigma³
/// exp(-omega L sigma), so that only omega L matters; 0.195 for 2.
double tuned_delay_angle(double sensitivity);

}  // namespace fingertip::lattice::inline control
