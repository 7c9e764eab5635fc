/// fingertip-fem RUN_FOLDER: carries out the reference job in RUN_FOLDER/job.json.
#include <deal.II/base/mpi.h>

#include <csignal>
#include <cstring>
#include <exception>
#include <iostream>

#include "fem_reference/run.h"
#include "meshes/errors.h"

namespace {

enum ExitCode { ok = 0, failure = 1, bad_input = 2, not_converged = 3, interrupted = 130 };

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_flag = 0;

extern "C" void request_stop(int) {
  stop_flag = 1;
}

int carry_out(const char* folder) {
  using fingertip::fem_reference::RunOutcome;
  try {
    const RunOutcome outcome =
        fingertip::fem_reference::run_job(folder, std::cout, [] { return stop_flag != 0; });
    if (!outcome.message.empty()) std::cerr << outcome.message << '\n';
    switch (outcome.status) {
      case RunOutcome::Status::ok: return ok;
      case RunOutcome::Status::interrupted: return interrupted;
      case RunOutcome::Status::not_converged: return not_converged;
    }
  } catch (const fingertip::meshes::InvalidInput& error) {
    for (const auto& violation : error.violations()) std::cerr << to_string(violation) << '\n';
    return bad_input;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return failure;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || std::strcmp(argv[1], "--help") == 0) {
    std::cerr
        << "usage: fingertip-fem RUN_FOLDER\n"
           "Presses the continuum as RUN_FOLDER/job.json says and writes the results beside it.\n";
    return argc == 2 ? ok : bad_input;
  }
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  return carry_out(argv[1]);
}
