#include "studies/live/live_view.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "meshes/base/files.h"
#include "studies/cli/command_line/real_time.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/asked_units.h"
#include "studies/config/finger_defaults.h"
#include "studies/files/places.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/force_error.h"
#include "studies/presses/pace_trial.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

/// The continuum's press beside this one, where a lattice's errors come from it and it need not be
/// built first.
std::function<meshes::PressResponse(const std::function<bool()>& stop)> continuum_of(
    const LoadedConfig& loaded) {
  const Cache cache(cache_folder());
  const ErrorSource source = source_at_hand(loaded, cache);
  if (!source.continuum || !(std::filesystem::exists(reference_program()) ||
                             cache.keeps(reference_job(*source.continuum))))
    return {};
  return [cache, job = *source.continuum](const std::function<bool()>& stop) {
    try {
      return pressed(job, cache, stop);
    } catch (const meshes::Interrupted&) {
    } catch (const std::exception& error) {
      fmt::print(stderr, "fingertip: note: no continuum beside the press: {}\n", error.what());
    }
    return meshes::PressResponse();
  };
}

/// Slowest half second, as told by run_live_view. `loaded`: what `setup` was made of.
double serve(const CommandLine& line, const LoadedConfig& loaded, const lattice::PressSetup& setup,
             const SetupAt& coarser) {
  LiveOptions options;
  options.continuum = continuum_of(loaded);
  options.port = line.port;
  options.reference = line.reference;
  options.pace = {!line.running, line.rate, coarser};
  options.exit_after = line.exit_after;
  options.interrupted = interrupted;
  return run_live_view(setup, options, [&line](const std::string& url, const std::string& remark) {
    if (!remark.empty()) fmt::print(stderr, "fingertip: note: {}\n", remark);
    if (!line.quiet) fmt::print("open this address in a browser on this machine; Ctrl-C ends:\n");
    fmt::print("{}\n", url);
    if (!line.quiet && !line.running) fmt::print("it waits paused: Run or Space starts it\n");
    std::fflush(stdout);
  });
}

void tell_slowest(const CommandLine& line, double factor) {
  if (!line.quiet && !std::isnan(factor))
    fmt::print("real-time factor in the slowest half second: {:.3g}\n", factor);
}

/// With the finest lattice that keeps up, and with coarser ones where it does not after all. In a
/// run folder, which keeps what was chosen, if one is asked for.
int serve_in_real_time(const CommandLine& line) {
  RealTimeRun run = real_time_run(line);
  LoadedConfig loaded = with_material(run.loaded, LatticeUse::press);
  loaded.notes.push_back(run.note());
  const lattice::PressSetup setup = press_setup(loaded);
  run.estimate_force_error(setup);
  const auto coarser = [&](double spacing) {
    const LoadedConfig there =
        with_sets(run.loaded, {"lattice.spacing=" + meshes::to_text(spacing) + " m"});
    lattice::PressSetup coarser_one = press_setup(with_material(there, LatticeUse::press));
    coarser_one.rod = setup.rod;  // whatever would sway: this one is in the hand
    return coarser_one;
  };
  const auto served = [&] {
    if (!line.quiet && run.record.force_error)
      fmt::print("{}\n", error_words(*run.record.force_error));
    run.record.slowest_factor = serve(line, loaded, setup, coarser);
    tell_slowest(line, run.record.slowest_factor);
    return 0;
  };
  if (!line.real_time && line.out.empty()) {
    for (const std::string& note : loaded.notes) fmt::print(stderr, "fingertip: note: {}\n", note);
    return served();
  }
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const std::filesystem::path& folder = session.folder().path();
    run.write(folder);
    if (!line.quiet) fmt::print("run folder: {}\n", folder.string());
    served();
    run.write(folder);
    return 0;
  });
}

void tell_expected(const lattice::PressSetup& setup) {
  constexpr double trial = 0.5;  // [s]
  try {
    const double factor = measured_factor(setup, trial);
    fmt::print("expected real-time factor: {:.2g}{}\n", factor,
               factor < 1.0 ? "; without lattice.spacing and run.integrator a lattice is chosen "
                              "that keeps up"
                            : "");
  } catch (const meshes::NotConverged&) {  // at its full depth; a person may press less
    fmt::print("expected real-time factor: unknown, a trial to the full depth did not converge\n");
  }
}

/// As it was asked for, however slow.
int serve_as_asked(const CommandLine& line, const LoadedConfig& asked) {
  const LoadedConfig loaded =
      with_material(at_pace(with_sets(asked, as_a_person_presses())), LatticeUse::press);
  const lattice::PressSetup setup = press_setup(loaded);
  if (const std::string note = spacing_note(loaded); !note.empty())
    fmt::print(stderr, "fingertip: note: {}\n", note);
  if (!line.quiet) tell_expected(setup);
  tell_slowest(line, serve(line, loaded, setup, {}));
  return 0;
}

}  // namespace

int run_live(const CommandLine& line) {
  const LoadedConfig asked = load_checked(line);
  const ShowIn units(asked_units(asked));
  watch_for_interrupts();
  const auto is_given = [&](const char* key) { return asked.entries.at(key).given; };
  const bool chosen = is_given("lattice.spacing") || is_given("run.integrator");
  return chosen && !line.real_time ? serve_as_asked(line, asked) : serve_in_real_time(line);
}

}  // namespace fingertip::studies::inline cli::inline verbs
