/// The grasp: two soft fingers squeeze a rigid block, lift it under gravity and hold it.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "lattice/grasp/grip.h"
#include "lattice/grasp/hand.h"

namespace fingertip::lattice {

/// The complete order. The rods' motion is prescribed: `hand.finger.prescribed` does not matter.
struct GraspSetup {
  HandSetup hand;
  GripSettings grip;

  /// Every broken rule of block, grip and what a grasp asks of the lattice.
  std::vector<meshes::Violation> violations() const;
  /// The least normal force per finger [N] that carries the block with Coulomb's friction mu, two
  /// contacts each up to mu N: m (g + a)/(2 mu). `acceleration` [m/s²] upward. Stick: 0,
  /// frictionless: infinite.
  double least_force(double acceleration) const;
};

/// One row of grasp.csv, once per period. World axes; forces are means over the last step.
struct GraspRow {
  double time = 0.0;  ///< [s]
  GripPhase phase = GripPhase::squeeze;
  double height = 0.0;         ///< of the box's centre above its start [m]
  double velocity = 0.0;       ///< upward [m/s]
  double tilt = 0.0;           ///< rotation of the block since the start [rad]
  double finger_height = 0.0;  ///< travel of the rods upward [m]
  double indentation = 0.0;    ///< travel of each rod toward the block since first touch [m]
  double support_force = 0.0;  ///< [N]
  /// Per finger: normal and tangential force on the block [N], points that touch and of these that
  /// slide.
  std::array<double, 2> normal{}, tangential{};
  std::array<int, 2> touching{}, sliding{};
  /// Per finger, at its points: sum of the magnitudes of their tangential forces, mu times `normal`
  /// where all slide, and of their parts on the tip toward the contact's centre [N].
  std::array<double, 2> point_friction{}, inward_friction{};
  double load = 0.0;  ///< upward force of both fingers on the block [N]
  double slip = 0.0;  ///< of the block down along the fingers since it left its support [m]
};

enum class GraspFate {
  unfinished,
  held,        ///< to the end of hold_time
  dropped,     ///< slid by more than the slip limit
  not_lifted,  ///< never left its support
};
std::string_view name(GraspFate fate);

struct GraspOutcome {
  std::vector<GraspRow> rows;
  GraspFate fate = GraspFate::unfinished;
  double least_force = 0.0;                ///< with the lift's largest acceleration [N]
  double lift_off_time = meshes::unknown;  ///< [s]
  /// Means over hold_time, where the block was held: normal force per finger [N], load over weight,
  /// tangential over normal force.
  double held_force = meshes::unknown, held_load = meshes::unknown, held_ratio = meshes::unknown;
  double held_slip = meshes::unknown;  ///< at the end of hold_time [m]
  /// At the moment from which every touching point of both fingers slides until the end: mean
  /// normal force per finger [N], tangential over normal force.
  double slip_force = meshes::unknown, slip_ratio = meshes::unknown;
  double sliding_ratio = meshes::unknown;  ///< the latter at the end, if all points slide there
  /// Largest difference between what the momentum of tips and block is and what rods, gravity and
  /// support have given, over the largest impulse of a finger within a period.
  double momentum_defect = 0.0;
  double coupling = 0.0;                         ///< Hand::coupling()
  double step = 0.0;                             ///< of the communication [s]
  double simulated_time = 0.0, wall_time = 0.0;  ///< [s]
};

/// Called about ten times a second of wall time. Returning false ends the run with Interrupted
/// after the observer has seen the outcome so far.
using GraspObserver = std::function<bool(const GraspOutcome& so_far, double fraction_done)>;

/// Throws InvalidInput for a setup that breaks a rule, NotConverged when the grip force is not
/// reached before the rubber is crushed (the observer has seen what was finished), Interrupted when
/// the observer asks.
GraspOutcome run_grasp(const GraspSetup& setup, const GraspObserver& observer = {});

/// grasp.csv: a row per period, first line with names and units.
void write_grasp_csv(const std::vector<GraspRow>& rows, const std::filesystem::path& file);

}  // namespace fingertip::lattice
