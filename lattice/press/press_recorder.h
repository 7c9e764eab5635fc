/// Collects what a press yields while it runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <vector>

#include "lattice/dynamics/finger.h"
#include "lattice/press/marker_points.h"
#include "lattice/press/press_outcome.h"
#include "meshes/press/press_motion.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::lattice::inline press {

/// The finger at the start of a step, as far as the response needs it.
struct PressInstant {
  double time = 0.0;         ///< [s]
  double indentation = 0.0;  ///< negative before contact [m]
  double lateral = 0.0;      ///< displacement of the plane along t1 [m]
  Wrench bond;               ///< on the rod about its endpoint
};

/// Fills a PressOutcome: the response at the sample depths and 60 evenly spaced ones (linear in
/// indentation between steps) and one trace row per controller period. Of a program that is its
/// first stage; what follows is taken at the times of PressMotion::samples.
class PressRecorder {
 public:
  PressRecorder(const PressSetup& setup, const meshes::PressMotion& motion, const Plane& plane,
                const Finger& finger, PressOutcome& outcome);

  /// To be called after every step with the finger as it was at the step's start. Returns whether
  /// one of the samples asked for was passed.
  bool add_step(const PressInstant& start);
  /// The first time after this one at which the response is taken if the rod moves as it should
  /// [s], if there is one.
  std::optional<double> next_time(double after) const;
  /// To be called once per controller period; energies follow by set_energy().
  void add_trace(const PressInstant& now, const meshes::SetPoint& commanded, const Wrench& applied,
                 const ControllerReport& controller);
  /// Of the particles, for the last row of the trace.
  void set_energy(const Finger::Energy& energy);
  /// Brings the outcome up to date: times, momentum balance.
  void update(double wall_time);

 private:
  meshes::PressSample sample_between(const PressInstant& end, double fraction, std::size_t stage);
  void note_fields(double indentation);
  void note_markers();
  const std::vector<meshes::ContactPoint>& field();
  meshes::PressSample sample_at(const PressInstant& end, const meshes::MotionSample& wanted);
  void move(meshes::PressSample& sample,
            std::initializer_list<double meshes::PressSample::*> values, double from,
            double to) const;
  void add_work(const PressInstant& end);

  meshes::Vector3 normal_;
  bool lateral_;     ///< whether the plane is asked to move along itself
  bool prescribed_;  ///< whether the rod is where it is told to be
  bool program_;
  const Finger* finger_;
  std::vector<meshes::Vector3> marked_;  ///< places of the markers [m]
  const MarkerPoints markers_;
  PressOutcome* outcome_;
  std::vector<double> depths_;           ///< of the first loading, increasing [m]
  std::vector<std::uint8_t> is_sample_;  ///< whether the protocol asked for the depth
  std::size_t next_ = 0;
  std::vector<meshes::MotionSample> later_;  ///< of a program: its first stage's end and after
  std::size_t next_later_ = 0;
  std::vector<double> times_;  ///< of all these, increasing [s]
  PressInstant previous_;
  std::vector<meshes::ContactPoint> field_;  ///< of the last step, once one of its rows needs it
  bool has_field_ = false;
  double plane_impulse_ = 0.0;  ///< along the normal since the last trace row [N s]
  double plane_since_ = 0.0;    ///< time of the last trace row [s]
};

}  // namespace fingertip::lattice::inline press
