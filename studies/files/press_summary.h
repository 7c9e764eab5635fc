/// summary.json of a press, SI.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// The finger [m].
struct GeometryEntry {
  double tip_radius = meshes::unknown, rod_radius = meshes::unknown,
         sleeve_length = meshes::unknown, rod_length = meshes::unknown;
  std::string shape;  ///< empty: the dome

  bool is_dome() const { return shape.empty(); }
};
consteval auto fields_of(const GeometryEntry*) {
  return FINGERTIP_ALL_MEMBERS(GeometryEntry, tip_radius, rod_radius, sleeve_length, rod_length,
                               shape)
      .if_known("shape");
}

/// What the finger was pressed against, if no plane [m].
struct ObstacleEntry {
  std::string shape;
  double radius = meshes::unknown;
  std::string along;
  double offset = meshes::unknown;
};
FINGERTIP_FIELDS(ObstacleEntry, shape, radius, along, offset);

/// Spring constants [N/m] and volume constant [Pa].
struct ConstantsEntry {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown;
};
FINGERTIP_FIELDS(ConstantsEntry, k1, k2, k3, kappa);

/// Elastic constants of an infinite lattice [Pa].
struct ModuliEntry {
  double E_100 = meshes::unknown, E_110 = meshes::unknown, E_111 = meshes::unknown,
         G = meshes::unknown, nu_100 = meshes::unknown, K = meshes::unknown,
         anisotropy = meshes::unknown;
};
FINGERTIP_FIELDS(ModuliEntry, E_100, E_110, E_111, G, nu_100, K, anisotropy);

/// summary.json of a fit to moduli.
struct ModuliSummary {
  std::string model, status;
  double spacing = meshes::unknown;
  ConstantsEntry constants;
  ModuliEntry moduli;
  long iterations = 0;
  std::string statement;
};
FINGERTIP_FIELDS(ModuliSummary, model, status, spacing, constants, moduli, iterations, statement);

/// Why the time step is what it is.
struct StepEntry {
  double step = meshes::unknown, smallest = meshes::unknown, omega0 = meshes::unknown,
         paper_bound = meshes::unknown, spectral_bound = meshes::unknown;
  std::string explanation;
};
FINGERTIP_FIELDS(StepEntry, step, smallest, omega0, paper_bound, spectral_bound, explanation);

/// How often a press stepped.
struct StepsEntry {
  long accepted = 0, rejected = 0, forced = 0, force_evaluations = 0;
};
FINGERTIP_FIELDS(StepsEntry, accepted, rejected, forced, force_evaluations);

/// What a lattice in time consists of, of `sectors` mirror images of which one was computed.
struct CensusEntry {
  long sectors = 1, particles = 0;
  double expected_particles = meshes::unknown;
  long springs = 0, cells = 0, boundary_particles = 0, ligaments = 0;
  double mass = meshes::unknown, added_mass = meshes::unknown, exact_mass = meshes::unknown;
};
consteval auto fields_of(const CensusEntry*) {
  return FINGERTIP_ALL_MEMBERS(CensusEntry, particles, expected_particles, springs, cells,
                               boundary_particles, ligaments, mass, added_mass, exact_mass, sectors)
      .newer("sectors");
}

/// What a lattice at rest consists of.
struct StaticCensusEntry {
  long sectors = 0, particles = 0, springs = 0, cells = 0, unknowns = 0;
  double volume = meshes::unknown, exact_volume = meshes::unknown;
};
FINGERTIP_FIELDS(StaticCensusEntry, sectors, particles, springs, cells, unknowns, volume,
                 exact_volume);

/// What an equilibrium cost.
struct EffortEntry {
  long steps = 0, newton_iterations = 0, factorisations = 0, gradients = 0;
};
FINGERTIP_FIELDS(EffortEntry, steps, newton_iterations, factorisations, gradients);

/// What scaled masses are expected to change of the force.
struct ForceDeviationEntry {
  double indentation = meshes::unknown, relative = meshes::unknown;
};
FINGERTIP_FIELDS(ForceDeviationEntry, indentation, relative);

/// Masses scaled or not.
struct ScalingEntry {
  bool scaled = false;
  std::vector<ForceDeviationEntry> estimated_force_deviation;
};
FINGERTIP_FIELDS(ScalingEntry, scaled, estimated_force_deviation);

/// How a controller did: studies/presses/tracking.h.
struct TrackingEntry {
  double speed_deviation = meshes::unknown, speed_deviation_at_touch = meshes::unknown,
         tilt_deg = meshes::unknown, wanted_force = meshes::unknown, held_force = meshes::unknown,
         force_deviation = meshes::unknown;
  bool follows_path = false;
};
consteval auto fields_of(const TrackingEntry*) {
  return FINGERTIP_ALL_MEMBERS(TrackingEntry, speed_deviation, speed_deviation_at_touch, tilt_deg,
                               wanted_force, held_force, force_deviation, follows_path)
      .newer("wanted_force held_force force_deviation follows_path");
}

/// Where a press ended.
struct EndEntry {
  double time = meshes::unknown, indentation = meshes::unknown, normal_force = meshes::unknown;
};
FINGERTIP_FIELDS(EndEntry, time, indentation, normal_force);

/// A stage of a press's program. Times since the start [s], unknown without time; forces [N],
/// unknown where the press did not get.
struct StageEntry {
  std::string kind;  ///< "move", "hold", "lateral" or "twist"
  double indentation = meshes::unknown, speed = meshes::unknown, begin = meshes::unknown,
         end = meshes::unknown, begin_force = meshes::unknown, end_force = meshes::unknown,
         relaxation = meshes::unknown;  ///< of a hold: the part of the force that went
  double lateral = meshes::unknown,
         twist = meshes::unknown;  ///< at the end, of stages that move so
  bool moves() const { return kind != "hold"; }
  bool holds() const { return !moves(); }
};
consteval auto fields_of(const StageEntry*) {
  return FINGERTIP_ALL_MEMBERS(StageEntry, kind, indentation, speed, begin, end, begin_force,
                               end_force, relaxation, lateral, twist)
      .only(&StageEntry::holds, "relaxation")
      .if_known("speed lateral twist");
}

/// Where the error of the forces is from, or why there is none, and how large it is.
struct ForceErrorEntry {
  std::string statement;
  /// Over the force, where it is largest among the asked depths [m].
  double largest = meshes::unknown, indentation = meshes::unknown;
};
consteval auto fields_of(const ForceErrorEntry*) {
  return FINGERTIP_ALL_MEMBERS(ForceErrorEntry, statement, largest, indentation)
      .if_known("largest indentation");
}

/// summary.json of `press`.
struct PressSummary {
  std::string model, kinematics, mode, contact, status;
  double spacing = meshes::unknown;
  ConstantsEntry constants;
  GeometryEntry geometry;
  std::optional<ObstacleEntry> obstacle;
  ModuliEntry moduli;
  StepEntry step;
  CensusEntry census;
  StepsEntry steps;
  StaticCensusEntry static_census;
  EffortEntry effort;
  double smallest_jacobian = meshes::unknown, simulated_time = meshes::unknown,
         wall_time = meshes::unknown, real_time_factor = meshes::unknown,
         slowest_real_time_factor = meshes::unknown;  ///< in the slowest 10 ms from first touch on
  long threads = 0;
  double first_touch_time = meshes::unknown, momentum_defect = meshes::unknown;
  std::optional<ScalingEntry> scaling;
  std::vector<std::string> warnings;
  std::vector<StageEntry> program;  ///< empty: one press
  /// Of a program in time [J]: what the rod put into the rubber while it pushed, and, where it also
  /// went back, that less what it got back.
  double work_in = meshes::unknown, loop_area = meshes::unknown;
  TrackingEntry tracking;
  std::optional<EndEntry> end;
  std::optional<ForceErrorEntry> force_error;

  bool empty() const { return model.empty(); }
  bool rests() const { return mode == "static"; }
  bool moves() const { return !rests(); }
  bool controlled() const { return mode == "pid"; }
};
consteval auto fields_of(const PressSummary*) {
  return FINGERTIP_ALL_MEMBERS(PressSummary, model, kinematics, mode, contact, status, spacing,
                               constants, obstacle, geometry, moduli, step, census, steps,
                               static_census, effort, smallest_jacobian, simulated_time, wall_time,
                               real_time_factor, threads, first_touch_time, momentum_defect,
                               slowest_real_time_factor, scaling, warnings, program, work_in,
                               loop_area, tracking, end, force_error)
      .only(&PressSummary::moves,
            "moduli step census steps simulated_time real_time_factor threads first_touch_time "
            "momentum_defect")
      .only(&PressSummary::rests, "static_census effort smallest_jacobian")
      .only(&PressSummary::controlled, "tracking end")
      .if_known(
          "obstacle slowest_real_time_factor scaling warnings program work_in loop_area "
          "force_error")
      .called("static_census", "census");
}

}  // namespace fingertip::studies::inline files
