#include "studies/jobs/interrupt.h"

#include <csignal>
#include <optional>

namespace fingertip::studies::inline jobs {

namespace {

// A signal handler can reach nothing but a global; it is written here and only here.
volatile std::sig_atomic_t stop_requested = 0;

/// What the signals meant before; empty while nobody watches.
struct Before {
  struct sigaction interrupt {
  }, terminate{};
};
std::optional<Before> before;

extern "C" void request_stop(int signal) {
  stop_requested = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};
  action.sa_handler = request_stop;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  Before found;
  sigaction(SIGINT, &action, &found.interrupt);
  sigaction(SIGTERM, &action, &found.terminate);
  if (!before) before = found;
}

void stop_watching() {
  if (!before) return;
  sigaction(SIGINT, &before->interrupt, nullptr);
  sigaction(SIGTERM, &before->terminate, nullptr);
  before.reset();
  stop_requested = 0;
}

bool interrupted() {
  return stop_requested != 0;
}

}  // namespace fingertip::studies::inline jobs
