/// summary.json of a press, SI.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// The finger [m].
struct GeometryEntry {
  double tip_radius = meshes::unknown, rod_radius = meshes::unknown,
         sleeve_length = meshes::unknown, rod_length = meshes::unknown;
  std::string shape;  ///< empty: the dome

  bool is_dome() const { return shape.empty(); }
};
constexpr auto fields_of(const GeometryEntry*) {
  using meshes::named;
  using Whole = GeometryEntry;
  return std::tuple_cat(named("tip_radius rod_radius sleeve_length rod_length", &Whole::tip_radius,
                              &Whole::rod_radius, &Whole::sleeve_length, &Whole::rod_length),
                        meshes::if_known(named("shape", &Whole::shape)));
}

/// What the finger was pressed against, if no plane [m].
struct ObstacleEntry {
  std::string shape;
  double radius = meshes::unknown;
  std::string along;
  double offset = meshes::unknown;
};
constexpr auto fields_of(const ObstacleEntry*) {
  using meshes::named;
  using Whole = ObstacleEntry;
  return named("shape radius along offset", &Whole::shape, &Whole::radius, &Whole::along,
               &Whole::offset);
}

/// Spring constants [N/m] and volume constant [Pa].
struct ConstantsEntry {
  double k1 = meshes::unknown, k2 = meshes::unknown, k3 = meshes::unknown, kappa = meshes::unknown;
};
constexpr auto fields_of(const ConstantsEntry*) {
  using meshes::named;
  using Whole = ConstantsEntry;
  return named("k1 k2 k3 kappa", &Whole::k1, &Whole::k2, &Whole::k3, &Whole::kappa);
}

/// Elastic constants of an infinite lattice [Pa].
struct ModuliEntry {
  double E_100 = meshes::unknown, E_110 = meshes::unknown, E_111 = meshes::unknown,
         G = meshes::unknown, nu_100 = meshes::unknown, K = meshes::unknown,
         anisotropy = meshes::unknown;
};
constexpr auto fields_of(const ModuliEntry*) {
  using meshes::named;
  using Whole = ModuliEntry;
  return named("E_100 E_110 E_111 G nu_100 K anisotropy", &Whole::E_100, &Whole::E_110,
               &Whole::E_111, &Whole::G, &Whole::nu_100, &Whole::K, &Whole::anisotropy);
}

/// summary.json of a fit to moduli.
struct ModuliSummary {
  std::string model, status;
  double spacing = meshes::unknown;
  ConstantsEntry constants;
  ModuliEntry moduli;
  long iterations = 0;
  std::string statement;
};
constexpr auto fields_of(const ModuliSummary*) {
  using meshes::named;
  using Whole = ModuliSummary;
  return named("model status spacing constants moduli iterations statement", &Whole::model,
               &Whole::status, &Whole::spacing, &Whole::constants, &Whole::moduli,
               &Whole::iterations, &Whole::statement);
}

/// Why the time step is what it is.
struct StepEntry {
  double step = meshes::unknown, smallest = meshes::unknown, omega0 = meshes::unknown,
         paper_bound = meshes::unknown, spectral_bound = meshes::unknown;
  std::string explanation;
};
constexpr auto fields_of(const StepEntry*) {
  using meshes::named;
  using Whole = StepEntry;
  return named("step smallest omega0 paper_bound spectral_bound explanation", &Whole::step,
               &Whole::smallest, &Whole::omega0, &Whole::paper_bound, &Whole::spectral_bound,
               &Whole::explanation);
}

/// How often a press stepped.
struct StepsEntry {
  long accepted = 0, rejected = 0, forced = 0, force_evaluations = 0;
};
constexpr auto fields_of(const StepsEntry*) {
  using meshes::named;
  using Whole = StepsEntry;
  return named("accepted rejected forced force_evaluations", &Whole::accepted, &Whole::rejected,
               &Whole::forced, &Whole::force_evaluations);
}

/// What a lattice in time consists of, of `sectors` mirror images of which one was computed.
struct CensusEntry {
  long sectors = 1, particles = 0;
  double expected_particles = meshes::unknown;
  long springs = 0, cells = 0, boundary_particles = 0, ligaments = 0;
  double mass = meshes::unknown, added_mass = meshes::unknown, exact_mass = meshes::unknown;
};
constexpr auto fields_of(const CensusEntry*) {
  using meshes::named;
  using Whole = CensusEntry;
  return std::tuple_cat(
      named("particles expected_particles springs cells boundary_particles ligaments mass "
            "added_mass exact_mass",
            &Whole::particles, &Whole::expected_particles, &Whole::springs, &Whole::cells,
            &Whole::boundary_particles, &Whole::ligaments, &Whole::mass, &Whole::added_mass,
            &Whole::exact_mass),
      meshes::newer(named("sectors", &Whole::sectors)));
}

/// What a lattice at rest consists of.
struct StaticCensusEntry {
  long sectors = 0, particles = 0, springs = 0, cells = 0, unknowns = 0;
  double volume = meshes::unknown, exact_volume = meshes::unknown;
};
constexpr auto fields_of(const StaticCensusEntry*) {
  using meshes::named;
  using Whole = StaticCensusEntry;
  return named("sectors particles springs cells unknowns volume exact_volume", &Whole::sectors,
               &Whole::particles, &Whole::springs, &Whole::cells, &Whole::unknowns, &Whole::volume,
               &Whole::exact_volume);
}

/// What an equilibrium cost.
struct EffortEntry {
  long steps = 0, newton_iterations = 0, factorisations = 0;
};
constexpr auto fields_of(const EffortEntry*) {
  using meshes::named;
  using Whole = EffortEntry;
  return named("steps newton_iterations factorisations", &Whole::steps, &Whole::newton_iterations,
               &Whole::factorisations);
}

/// What scaled masses are expected to change of the force.
struct ForceDeviationEntry {
  double indentation = meshes::unknown, relative = meshes::unknown;
};
constexpr auto fields_of(const ForceDeviationEntry*) {
  using meshes::named;
  using Whole = ForceDeviationEntry;
  return named("indentation relative", &Whole::indentation, &Whole::relative);
}

/// Masses scaled or not.
struct ScalingEntry {
  bool scaled = false;
  std::vector<ForceDeviationEntry> estimated_force_deviation;
};
constexpr auto fields_of(const ScalingEntry*) {
  using meshes::named;
  using Whole = ScalingEntry;
  return named("scaled estimated_force_deviation", &Whole::scaled,
               &Whole::estimated_force_deviation);
}

/// How a controller did: studies/presses/tracking.h.
struct TrackingEntry {
  double speed_deviation = meshes::unknown, speed_deviation_at_touch = meshes::unknown,
         tilt_deg = meshes::unknown, wanted_force = meshes::unknown, held_force = meshes::unknown,
         force_deviation = meshes::unknown;
  bool follows_path = false;
};
constexpr auto fields_of(const TrackingEntry*) {
  using meshes::named, meshes::newer;
  using Whole = TrackingEntry;
  return std::tuple_cat(
      named("speed_deviation speed_deviation_at_touch tilt_deg", &Whole::speed_deviation,
            &Whole::speed_deviation_at_touch, &Whole::tilt_deg),
      newer(named("wanted_force held_force force_deviation follows_path", &Whole::wanted_force,
                  &Whole::held_force, &Whole::force_deviation, &Whole::follows_path)));
}

/// Where a press ended.
struct EndEntry {
  double time = meshes::unknown, indentation = meshes::unknown, normal_force = meshes::unknown;
};
constexpr auto fields_of(const EndEntry*) {
  using meshes::named;
  using Whole = EndEntry;
  return named("time indentation normal_force", &Whole::time, &Whole::indentation,
               &Whole::normal_force);
}

/// A stage of a press's program. Times since the start [s], unknown without time; forces [N],
/// unknown where the press did not get.
struct StageEntry {
  std::string kind;  ///< "move" or "hold"
  double indentation = meshes::unknown, speed = meshes::unknown, begin = meshes::unknown,
         end = meshes::unknown, begin_force = meshes::unknown, end_force = meshes::unknown,
         relaxation = meshes::unknown;  ///< of a hold: the part of the force that went
  bool moves() const { return kind != "hold"; }
  bool holds() const { return !moves(); }
};
constexpr auto fields_of(const StageEntry*) {
  using meshes::if_known, meshes::named, meshes::only;
  using Whole = StageEntry;
  return std::tuple_cat(named("kind indentation", &Whole::kind, &Whole::indentation),
                        if_known(named("speed", &Whole::speed)),
                        named("begin end begin_force end_force", &Whole::begin, &Whole::end,
                              &Whole::begin_force, &Whole::end_force),
                        only(&Whole::holds, named("relaxation", &Whole::relaxation)));
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

  bool empty() const { return model.empty(); }
  bool rests() const { return mode == "static"; }
  bool moves() const { return !rests(); }
  bool controlled() const { return mode == "pid"; }
};
constexpr auto fields_of(const PressSummary*) {
  using meshes::if_known, meshes::named, meshes::newer, meshes::only;
  using Whole = PressSummary;
  return std::tuple_cat(
      named("model kinematics mode contact status spacing constants", &Whole::model,
            &Whole::kinematics, &Whole::mode, &Whole::contact, &Whole::status, &Whole::spacing,
            &Whole::constants),
      if_known(named("obstacle", &Whole::obstacle)),
      only(&Whole::moves, named("geometry moduli step census steps", &Whole::geometry,
                                &Whole::moduli, &Whole::step, &Whole::census, &Whole::steps)),
      only(&Whole::rests, newer(named("geometry", &Whole::geometry))),
      only(&Whole::rests, named("census effort smallest_jacobian", &Whole::static_census,
                                &Whole::effort, &Whole::smallest_jacobian)),
      only(&Whole::moves, named("simulated_time", &Whole::simulated_time)),
      named("wall_time", &Whole::wall_time),
      only(&Whole::moves, named("real_time_factor threads first_touch_time momentum_defect",
                                &Whole::real_time_factor, &Whole::threads, &Whole::first_touch_time,
                                &Whole::momentum_defect)),
      if_known(named("slowest_real_time_factor", &Whole::slowest_real_time_factor)),
      if_known(named("scaling warnings program work_in loop_area", &Whole::scaling,
                     &Whole::warnings, &Whole::program, &Whole::work_in, &Whole::loop_area)),
      only(&Whole::controlled, named("tracking end", &Whole::tracking, &Whole::end)));
}

}  // namespace fingertip::studies::inline files
