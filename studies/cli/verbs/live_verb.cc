#include "studies/live/live_view.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "studies/cli/command_line/real_time.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/asked_units.h"
#include "studies/config/finger_defaults.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/force_error.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

/// Slowest half second, as told by run_live_view.
double serve(const CommandLine& line, const lattice::PressSetup& setup) {
  LiveOptions options;
  options.port = line.port;
  options.reference = line.reference;
  options.paused = !line.running;
  options.rate = line.rate;
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

/// In a run folder, which keeps what was chosen.
int serve_in_real_time(const CommandLine& line) {
  RealTimeRun run = real_time_run(line);
  LoadedConfig loaded = with_material(run.loaded, LatticeUse::press);
  loaded.notes.push_back(run.note());
  const lattice::PressSetup setup = press_setup(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const std::filesystem::path& folder = session.folder().path();
    run.estimate_force_error(setup);
    run.write(folder);
    if (!line.quiet) {
      fmt::print("{}", run.text());
      if (run.record.force_error) fmt::print("{}\n", error_words(*run.record.force_error));
      fmt::print("run folder: {}\n", folder.string());
    }
    run.record.slowest_factor = serve(line, setup);
    run.write(folder);
    if (!line.quiet && !std::isnan(run.record.slowest_factor))
      fmt::print("real-time factor in the slowest half second: {:.3g}\n",
                 run.record.slowest_factor);
    return 0;
  });
}

}  // namespace

int run_live(const CommandLine& line) {
  if (line.real_time) return serve_in_real_time(line);
  const LoadedConfig loaded = at_pace(load_checked(line));
  const lattice::PressSetup setup = press_setup(loaded);
  const ShowIn units(asked_units(loaded));
  if (const std::string note = spacing_note(loaded); !note.empty())
    fmt::print(stderr, "fingertip: note: {}\n", note);
  watch_for_interrupts();
  serve(line, setup);
  return 0;
}

}  // namespace fingertip::studies::inline cli::inline verbs
