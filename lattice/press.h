/// The press: rod, tip and plane in time, under a controller or with prescribed motion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lattice/settings.h"
#include "meshes/press_response.h"

namespace fingertip::lattice {

/// One row of trace.csv, taken once per controller period. SI; vectors in the rod's starting axes.
struct TraceRow {
  double time = 0.0;             ///< [s]
  double indentation = 0.0;      ///< negative before contact [m]
  double commanded_speed = 0.0;  ///< set-point of the approach speed [m/s]
  double speed = 0.0;            ///< approach speed of the rod's endpoint [m/s]
  double tilt = 0.0;             ///< angle between the rod's axis and its start [rad]
  double normal_force = 0.0;     ///< bond force on the rod along the plane normal [N]
  double lateral_force = 0.0;    ///< magnitude of the bond force in the plane [N]
  double torque = 0.0;           ///< magnitude of the bond torque about the endpoint [N m]
  double command_force = 0.0;    ///< controller's force along the approach direction [N]
  double plane_force = 0.0;      ///< reaction of the plane along its normal [N]
  int anchored = 0;             ///< boundary particles, or points of the true surface, on the plane
  double kinetic_energy = 0.0;  ///< of the particles [J]
  double elastic_energy = 0.0;  ///< of springs, cells, bond and contact [J]
};

/// How the time step was chosen; `explanation` says which bound rules.
struct StepReport {
  double step = 0.0;            ///< at rest [s]
  double smallest = 0.0;        ///< used [s]; smaller where compression stiffened the cells
  double omega0 = 0.0;          ///< the paper's estimate sqrt(2k/m) [rad/s]
  double paper_bound = 0.0;     ///< 1/omega0 [s]
  double spectral_bound = 0.0;  ///< largest stable step by the computed stiffness and damping [s]
  std::string explanation;
};

/// What the lattice consists of, for reports and pictures.
struct LatticeCensus {
  std::size_t particles = 0, cells = 0, boundary_particles = 0;
  std::size_t springs = 0;          ///< and fibres
  std::size_t ligaments = 0;        ///< or points of the bond
  double expected_particles = 0.0;  ///< V/a³
  double mass = 0.0;                ///< sum of the particles' masses [kg]
  double exact_mass = 0.0;          ///< rho V [kg]
  double added_mass = 0.0;          ///< what light particles at cut cells were given [kg]
};

struct PressOutcome {
  meshes::PressResponse response;  ///< at the sample depths and evenly in between
  std::vector<TraceRow> trace;
  StepReport step;
  LatticeCensus census;
  double simulated_time = 0.0;                ///< [s]
  double wall_time = 0.0;                     ///< of the step loop alone [s]
  double first_touch_time = meshes::unknown;  ///< [s]
  /// Largest defect of the momentum balance of rod, tip and plane over a step, relative to the
  /// largest impulse exchanged.
  double momentum_defect = 0.0;
  /// Boundary particles, or the points of the true surface that stand for them, at rest [m] ...
  std::vector<meshes::Vector3> boundary_rest;
  std::vector<meshes::Vector3> boundary_deformed;    ///< ... and at the end [m]
  std::vector<std::array<int, 2>> boundary_springs;  ///< pairs of them joined by axis springs
  std::vector<std::uint8_t> boundary_anchored;       ///< 1 where held by the plane

  /// Simulated over wall time.
  double real_time_factor() const { return wall_time > 0.0 ? simulated_time / wall_time : 0.0; }
};

/// Called about ten times a second of wall time and at every sample. Returning false ends the run
/// with Interrupted after the observer has seen the outcome so far.
using PressObserver = std::function<bool(const PressOutcome& so_far, double fraction_done)>;

/// Runs the press. Throws InvalidInput for a setup that breaks a rule or a time step above the
/// stability bound (with the reason), NotConverged when the lattice blows up (the observer has
/// seen what was finished), Interrupted when the observer asks.
PressOutcome run_press(const PressSetup& setup, const PressObserver& observer = {});

/// trace.csv: one row per controller period, first line with names and units.
void write_trace_csv(const std::vector<TraceRow>& trace, const std::filesystem::path& file);

}  // namespace fingertip::lattice
