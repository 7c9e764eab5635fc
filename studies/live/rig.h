/// The finger, its controller and the hand behind the live view: no threads, no network.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "lattice/control/control_loop.h"
#include "lattice/press/marker_points.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/press_task.h"
#include "lattice/press/whole_tip.h"
#include "meshes/tables/file_fields.h"
#include "studies/live/live_controller.h"
#include "studies/live/moving_set_point.h"

namespace fingertip::studies::inline live {

/// What sliders set. SI.
struct LiveSettings {
  double speed = 0.01;              ///< of the approach [m/s]
  double depth = 0.003;             ///< wanted indentation, negative above the plane [m]
  double natural_frequency = 60.0;  ///< [Hz]
  double derivative_filter = 10.0;
  double bond_compensation = 1.0;
  bool controller = true;      ///< whether the controller acts
  double contact_force = 0.0;  ///< that a controller of force holds [N]; 0 with any other one
};

/// Least and largest value of a slider.
struct Span {
  double least = 0.0, most = 0.0;
};

struct LiveLimits {
  Span speed{1.0e-3, 0.2};
  Span depth;
  Span natural_frequency{5.0, 120.0};
  Span derivative_filter{2.0, 50.0};
  Span bond_compensation{0.0, 1.0};
  std::optional<Span> contact_force;  ///< where the controller holds one
  double reach = 0.0;  ///< of the hand, each coordinate from the endpoint's start [m]
};

/// The sliders that every press has, by their names in messages.
struct Slider {
  const char* name;
  double LiveSettings::*value;
  Span LiveLimits::*limits;
};
inline constexpr Slider sliders[] = {
    {"speed", &LiveSettings::speed, &LiveLimits::speed},
    {"depth", &LiveSettings::depth, &LiveLimits::depth},
    {"natural_frequency", &LiveSettings::natural_frequency, &LiveLimits::natural_frequency},
    {"derivative_filter", &LiveSettings::derivative_filter, &LiveLimits::derivative_filter},
    {"bond_compensation", &LiveSettings::bond_compensation, &LiveLimits::bond_compensation}};

/// One line of the plots, once per controller period. SI.
struct LiveRow {
  double time = 0.0, indentation = 0.0, normal_force = 0.0, speed = 0.0, commanded_speed = 0.0,
         tilt = 0.0;
};

/// Everything a picture needs. SI, world axes.
struct LivePicture {
  LiveRow row;
  lattice::Measurement measured;         ///< as a perfect sensor would
  lattice::Wrench commanded;             ///< by controller and hand, before the actuators' limits
  lattice::Wrench hand;                  ///< of the hand alone
  double force_error = meshes::unknown;  ///< estimated for a press at the slider's speed [N]
  std::optional<meshes::Vector3> hand_place;
  lattice::FingerPicture finger;
  std::vector<meshes::Vector3> markers;  ///< where the press's markers are [m]
};

/// The same press with another spacing [m]; throws InvalidInput for one that it does not allow.
using SetupAt = std::function<lattice::PressSetup(double spacing)>;

/// Where mirror images let it, a quarter or half of the tip moves, and the whole from the moment on
/// when the hand takes the rod.
class LiveRig {
 public:
  /// A press under its controller, whatever the protocol's mode. Throws InvalidInput.
  explicit LiveRig(const lattice::PressSetup& setup);
  LiveRig(const LiveRig&) = delete;
  LiveRig& operator=(const LiveRig&) = delete;

  /// Advances by one controller period. Throws NotConverged when the lattice gives way,
  /// ControllerFailed.
  void advance();
  /// As in the beginning, but for the settings; of a part of the tip again.
  void reset();

  const LiveSettings& settings() const { return settings_; }
  /// Takes effect with the next period; values outside of limits() are put to their ends.
  void set(const LiveSettings& settings);
  const LiveLimits& limits() const { return limits_; }

  /// Goes on where it is with the lattice of `setup`, the same press with another spacing; see
  /// VirtualFinger::take_over.
  void go_on_with(const lattice::PressSetup& setup) { go_on_with(setup, sectors()); }
  /// With the whole tip, until the next reset.
  void go_on_whole(const lattice::PressSetup& setup);
  int sectors() const { return finger_->setup().sectors; }  ///< 4, 2 or 1; one part moves
  int lattices() const { return lattices_; }                ///< so far

  /// The hand takes the endpoint toward `place` [m], within its reach; of the whole tip.
  void hold(const meshes::Vector3& place);
  void release() { controller_->hand().release(); }

  LivePicture picture();
  LiveRow row() const;
  const lattice::PressSetup& setup() const { return setup_; }
  const lattice::BoundaryView& boundary() const { return tip_->view(); }
  double period() const { return loop_->period(); }
  double time() const { return finger_->time(); }

 private:
  void go_on_with(const lattice::PressSetup& setup, int sectors);
  double indentation() const;
  void check_sanity() const;
  double force_error(const LiveRow& row, const lattice::Measurement& measured) const;

  lattice::PressSetup setup_;
  lattice::PressWay way_;
  std::unique_ptr<lattice::VirtualFinger> finger_;
  std::unique_ptr<lattice::WholeTip> tip_;
  lattice::MarkerPoints markers_;
  int lattices_ = 1;
  struct Part {
    lattice::PressSetup setup;
    int sectors;
  };
  std::optional<Part> part_;  ///< what moved until the whole was wanted
  LiveLimits limits_;
  LiveSettings settings_;
  MovingSetPoint set_point_;
  std::unique_ptr<LiveController> controller_;
  std::unique_ptr<lattice::ControlLoop> loop_;
  lattice::ForceEstimator estimator_;  ///< at the slider's speed
};

}  // namespace fingertip::studies::inline live
