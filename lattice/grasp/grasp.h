/// The grasp: two soft fingers squeeze a rigid block, lift it under gravity and hold it.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "lattice/grasp/grasp_table.h"
#include "lattice/grasp/grip.h"
#include "lattice/grasp/hand.h"

namespace fingertip::lattice::inline grasp {

/// All that a grasp needs. The rods' motion is prescribed: `hand.finger.prescribed` does not
/// matter.
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

enum class GraspFate {
  unfinished,
  held,        ///< to the end of hold_time
  dropped,     ///< slid by more than the slip limit
  not_lifted,  ///< never left its support
};
constexpr auto names_of(GraspFate) {
  using enum GraspFate;
  return meshes::names<GraspFate>({{unfinished, "unfinished"},
                                   {held, "held"},
                                   {dropped, "dropped"},
                                   {not_lifted, "not lifted"}});
}

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

}  // namespace fingertip::lattice::inline grasp
