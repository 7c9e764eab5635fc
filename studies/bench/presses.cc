#include "studies/bench/presses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/press/press.h"
#include "meshes/tables/fields_json.h"
#include "studies/bench/continua.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/presses/pace.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline bench {

namespace {

constexpr double enough_time = 4.0;  // for the runs of one press [s]
constexpr int max_runs = 5;

/// The fastest of several runs of one press: whatever else the machine does makes them slower.
struct Timing {
  Pace slowest;            ///< of the windows of a run
  double whole = 0.0;      ///< simulated over elapsed time of a whole press
  double processor = 0.0;  ///< [s]
  int runs = 0;

  void add(const lattice::PressOutcome& outcome) {
    const Pace pace = slowest_pace(outcome, pace_window);
    slowest.wall = std::fmax(slowest.wall, pace.wall);
    slowest.processor = std::fmax(slowest.processor, pace.processor);
    whole = std::max(whole, outcome.real_time_factor());
    const double time = outcome.elapsed.back().processor;
    processor = runs > 0 ? std::min(processor, time) : time;
    ++runs;
  }
};

/// Short presses run again: they are what a machine's other work falsifies most.
int runs_of(const lattice::PressOutcome& first) {
  return std::clamp(int(enough_time / first.wall_time), 1, max_runs);
}

void run_pace(lattice::PressSetup setup, int threads, const std::filesystem::path& folder,
              const JobContext& context) {
  setup.threads = threads;
  Timing timing;
  int runs = 1;
  const auto run = [&] {
    lattice::PressOutcome outcome =
        lattice::run_press(setup, [&](const lattice::PressOutcome&, double fraction) {
          return context.report((timing.runs + fraction) / runs, "pressing");
        });
    timing.add(outcome);
    return outcome;
  };
  const lattice::PressOutcome outcome = run();
  runs = runs_of(outcome);
  while (timing.runs < runs) run();
  outcome.response.write_csv(folder / "response.csv");
  meshes::write_json_file(
      {{"real_time_factor", meshes::json_of(timing.slowest.wall)},
       {"real_time_factor_processor",
        threads == 1 ? meshes::json_of(timing.slowest.processor) : nlohmann::ordered_json()},
       {"whole_press_factor", meshes::json_of(timing.whole)},
       {"runs", timing.runs},
       {"ns_per_mass_step", meshes::json_of(1e9 * timing.processor /
                                            (double(outcome.steps.accepted) *
                                             double(outcome.census.particles) / outcome.sectors))},
       {"step", outcome.step.step},
       {"steps", outcome.steps.accepted},
       {"particles", outcome.census.particles},
       {"parts", outcome.sectors}},
      folder / "pace.json");
}

}  // namespace

LoadedConfig press_config(const LoadedConfig& loaded, const PressedLattice& press, double depth) {
  const std::string model(lattice::name(press.model));
  std::vector<std::string> sets = {
      "press.contact=stick",
      fmt::format("press.depth=\"{:.12g} m\"", depth),
      "lattice.model=" + model,
      fmt::format("lattice.spacing=tip_radius/{}", press.per_radius),
      fmt::format("run.integrator={}", lattice::name(press.integrator)),
      fmt::format("run.symmetry={}", !press.whole)};
  if (press.time_step) sets.push_back(fmt::format("run.time_step=\"{:.12g} s\"", *press.time_step));
  return with_sets(loaded, sets);
}

Job static_job(const LoadedConfig& loaded, const PressedLattice& press,
               const std::vector<double>& depths) {
  PressedLattice still = press;
  still.integrator = lattice::Integrator::symplectic_euler;
  still.time_step.reset();
  return press_job(press_setup(with_sets(press_config(loaded, still, depths.back()),
                                         {"press.mode=static", samples_setting(depths)})));
}

Job pace_job(const LoadedConfig& loaded, const PressedLattice& press, double depth) {
  const lattice::PressSetup setup = press_setup(press_config(loaded, press, depth));
  Job job = press_job(setup);
  job.kind = "pace";
  job.inputs["threads"] = press.threads;
  job.repeatable = false;
  job.run = [setup, threads = press.threads](const std::filesystem::path& folder,
                                             const JobContext& context) {
    run_pace(setup, threads, folder, context);
  };
  return job;
}

std::string press_name(const PressedLattice& press) {
  const bool plain = press.integrator == lattice::Integrator::symplectic_euler;
  return fmt::format("{}{}{}_R{}_{}t{}", lattice::name(press.model), plain ? "" : "_",
                     plain ? "" : lattice::name(press.integrator), press.per_radius, press.threads,
                     press.whole ? "_whole" : "");
}

}  // namespace fingertip::studies::inline bench
