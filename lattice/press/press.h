/// The press: rod, tip and plane in time, under a controller or with prescribed motion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "lattice/dynamics/integrators/stepper.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/press/boundary_view.h"
#include "lattice/press/press_setup.h"
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
  double contact_stiffness = meshes::unknown;  ///< as the controller takes it to be [N/m]
  double wanted_force = meshes::unknown;       ///< contact force the controller wants [N]
  bool force_mode = false;                     ///< whether it controls the contact force
  int anchored = 0;             ///< boundary particles, or points of the true surface, on the plane
  int sliding = 0;              ///< of these (contact coulomb)
  double kinetic_energy = 0.0;  ///< of the particles [J]
  double rod_kinetic_energy = 0.0;  ///< [J]
  double elastic_energy = 0.0;      ///< of springs, cells, bond and contact [J]
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

/// What a press had taken when a row of its trace was written [s]. Another run takes another time:
/// no part of trace.csv.
struct ElapsedTime {
  double wall = 0.0;
  double processor = 0.0;  ///< of the thread that presses; with one thread all there is
};

struct PressOutcome {
  meshes::PressResponse response;  ///< at the sample depths and evenly in between
  std::vector<TraceRow> trace;
  std::vector<ElapsedTime> elapsed;  ///< one per row of `trace`
  StepReport step;
  StepCount steps;
  long force_evaluations = 0;  ///< of springs and cells
  LatticeCensus census;
  double simulated_time = 0.0;                ///< [s]
  double wall_time = 0.0;                     ///< of the step loop alone [s]
  double first_touch_time = meshes::unknown;  ///< [s]
  /// Largest defect of the momentum balance of rod, tip and plane over a step, relative to the
  /// largest impulse exchanged.
  double momentum_defect = 0.0;
  /// What a BoundaryView shows, at rest [m] ...
  std::vector<meshes::Vector3> boundary_rest;
  std::vector<meshes::Vector3> boundary_deformed;    ///< ... and at the end [m]
  std::vector<std::array<int, 2>> boundary_springs;  ///< pairs of them joined by axis springs
  std::vector<std::uint8_t> boundary_anchored;       ///< Finger::held
  /// Up to four: halfway to the plane, at first touch, at half depth, at the end.
  std::vector<FingerPicture> snapshots;

  /// Simulated over wall time.
  double real_time_factor() const { return wall_time > 0.0 ? simulated_time / wall_time : 0.0; }
};

/// Called about ten times a second of wall time and at every sample. Returning false ends the run
/// with Interrupted after the observer has seen the outcome so far.
using PressObserver = std::function<bool(const PressOutcome& so_far, double fraction_done)>;

/// Pictures of a press, evenly spaced in time from the start to the end.
struct PressFilm {
  /// How many, 2 or more, when the press takes as long as planned; 0: none.
  int pictures = 0;
  std::function<void(const BoundaryView& view, const FingerPicture& picture)> show;
};

/// Runs the press. Throws InvalidInput for a setup that breaks a rule or a time step above the
/// stability bound (with the reason), NotConverged when the lattice blows up (the observer has
/// seen what was finished), ControllerFailed likewise, Interrupted when the observer asks.
PressOutcome run_press(const PressSetup& setup, const PressObserver& observer = {},
                       const PressFilm& film = {});

/// trace.csv: one row per controller period, first line with names and units (README: trace).
void write_trace_csv(const std::vector<TraceRow>& trace, const std::filesystem::path& file);

}  // namespace fingertip::lattice
