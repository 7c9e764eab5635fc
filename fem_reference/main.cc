/// fingertip-fem RUN_FOLDER: carries out the reference job in RUN_FOLDER/job.json.
/// fingertip-fem --triangles CAD STL UP: the surface of a CAD solid.
#include <deal.II/base/mpi.h>

#include <malloc.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "fem_reference/run.h"
#include "meshes/base/blas.h"
#include "meshes/base/errors.h"
#include "meshes/volume_mesh/cad_surface.h"

namespace {

enum ExitCode { ok = 0, failure = 1, bad_input = 2, not_converged = 3, interrupted = 130 };

// The only state a signal handler may touch.
volatile std::sig_atomic_t stop_flag = 0;

extern "C" void request_stop(int) {
  stop_flag = 1;
}

/// Runs on every process; the first one speaks for all.
int carry_out(const char* folder, bool only_cost) {
  using fingertip::fem_reference::RunOutcome;
  const bool first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  std::ostringstream words;
  int code = failure;
  try {
    const RunOutcome outcome = only_cost ? fingertip::fem_reference::tell_cost(folder, std::cout)
                                         : fingertip::fem_reference::run_job(
                                               folder, std::cout, [] { return stop_flag != 0; });
    if (!outcome.message.empty()) words << outcome.message << '\n';
    code = outcome.status == RunOutcome::Status::ok            ? ok
           : outcome.status == RunOutcome::Status::interrupted ? interrupted
                                                               : not_converged;
  } catch (const fingertip::meshes::InvalidInput& error) {
    for (const auto& violation : error.violations()) words << to_string(violation) << '\n';
    code = bad_input;
  } catch (const std::exception& error) {
    words << error.what() << '\n';
    // Unlike the others this one may have struck one process alone, and the rest would wait for
    // ever.
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) {
      std::cerr << words.str() << std::flush;
      MPI_Abort(MPI_COMM_WORLD, failure);
    }
  }
  if (first) std::cerr << words.str();
  // All wait for one another, because mpirun ends the rest as soon as one has left with an error.
  MPI_Barrier(MPI_COMM_WORLD);
  return code;
}

}  // namespace

/// Without the continuum: what a configuration's geometry.file is, seen as triangles.
int write_triangles(const char* cad, const char* stl, const char* up) {
  try {
    fingertip::meshes::write_cad_surface(cad, stl, up);
    return ok;
  } catch (const fingertip::meshes::InvalidInput& error) {
    std::cerr << error.what() << '\n';
    return bad_input;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return failure;
  }
}

/// Matrices come and go in every Newton iteration; giving their pages back to the system and taking
/// them again cost a third of the time.
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

/// An archive brings Open MPI's components along; its libraries look for them where Debian has
/// them.
void use_own_components() {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() /
                      "lib/fingertip/openmpi";
  const int keep = 0;
  if (std::filesystem::exists(folder))
    setenv("OMPI_MCA_mca_base_component_path", folder.c_str(), keep);
}

/// A process that no launcher has started is alone: Open MPI's search for networks and its helper
/// daemon are then 0.3 s of start-up for nothing, and it has no folder for the shared file pointers
/// that checkpoints do not use. Nor has it a session folder, which one process would remove while
/// another, started at the same time, makes its own in it. Other MPIs do not read these variables.
void start_without_network() {
  for (const char* launched : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
    if (std::getenv(launched)) return;
  const int keep = 0;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", keep);
  setenv("OMPI_MCA_orte_create_session_dirs", "0", keep);
  setenv("OMPI_MCA_pml", "ob1", keep);
  setenv("OMPI_MCA_btl", "self", keep);
  setenv("OMPI_MCA_sharedfp", "^sm", keep);
}

int main(int argc, char** argv) {
  keep_freed_memory();
  fingertip::meshes::leave_oldest_blas_kernels();
  use_own_components();
  start_without_network();
  if (argc == 5 && std::strcmp(argv[1], "--triangles") == 0)
    return write_triangles(argv[2], argv[3], argv[4]);
  const bool only_cost = argc == 3 && std::strcmp(argv[1], "--cost") == 0;
  if ((argc != 2 && !only_cost) || std::strcmp(argv[1], "--help") == 0) {
    std::cerr
        << "usage: fingertip-fem RUN_FOLDER\n"
           "Presses the continuum as RUN_FOLDER/job.json says and writes the results beside it.\n"
           "       fingertip-fem --cost RUN_FOLDER\n"
           "Makes its first mesh and tells the unknowns, time and memory that the press will "
           "take.\n"
           "       fingertip-fem --triangles CAD_FILE STL_FILE UP\n"
           "Writes the surface of a solid in a STEP or BREP file as triangles; UP (\"+z\", \"-y\", "
           "...) points to what touches first.\n";
    return argc == 2 ? ok : bad_input;
  }
  // Elements are integrated by all the processors, or a process' share of them.
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv);
  if (!only_cost) {  // a mesh is not stopped on the way
    std::signal(SIGINT, request_stop);
    std::signal(SIGTERM, request_stop);
  }
  return carry_out(argv[argc - 1], only_cost);
}
