#include "studies/live/live_view.h"

#include <fmt/format.h>

#include <cstdio>

#include "studies/cli/run_verb.h"
#include "studies/cli/verbs.h"
#include "studies/run/asked_units.h"
#include "studies/run/interrupt.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

int run_live(const CommandLine& line) {
  const LoadedConfig loaded = load_checked(line);
  const lattice::PressSetup setup = press_setup(loaded);
  const ShowIn units(asked_units(loaded));
  watch_for_interrupts();
  LiveOptions options;
  options.port = line.port;
  options.reference = line.reference;
  options.paused = !line.running;
  options.rate = line.rate;
  options.exit_after = line.exit_after;
  options.interrupted = interrupted;
  run_live_view(setup, options, [&line](const std::string& url, const std::string& remark) {
    if (!remark.empty()) fmt::print(stderr, "fingertip: note: {}\n", remark);
    if (!line.quiet) fmt::print("open this address in a browser on this machine; Ctrl-C ends:\n");
    fmt::print("{}\n", url);
    if (!line.quiet && !line.running) fmt::print("it waits paused: Run or Space starts it\n");
    std::fflush(stdout);
  });
  return 0;
}

}  // namespace fingertip::studies
