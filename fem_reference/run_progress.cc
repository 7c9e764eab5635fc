#include "fem_reference/run_progress.h"

#include <mpi.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::fem_reference {
namespace {

using nlohmann::ordered_json;

const char* name(RunOutcome::Status status) {
  switch (status) {
    case RunOutcome::Status::ok: return "ok";
    case RunOutcome::Status::interrupted: return "interrupted";
    case RunOutcome::Status::not_converged: return "not converged";
  }
  return "";
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kibibyte = 1024.0;
  return kibibyte * double(usage.ru_maxrss);
}

}  // namespace

bool first_process() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank == 0;
}

void RunProgress::report(const char* stage, std::size_t done, std::size_t total,
                         const std::string& message) {
  if (first_process())
    out_ << ordered_json{{"stage", stage}, {"done", done}, {"total", total}, {"message", message}}
         << std::endl;
}

double RunProgress::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

meshes::MeshQuality write_mesh_once(const meshes::Geometry& geometry,
                                    const meshes::TipMeshOptions& options,
                                    const std::filesystem::path& file) {
  meshes::MeshQuality quality;
  std::string failure;
  int failed = 0;
  if (first_process()) {
    try {
      quality = meshes::write_tip_mesh(geometry, options, file);
    } catch (const std::exception& error) {
      failure = error.what();
      failed = 1;
    }
  }
  MPI_Bcast(&failed, 1, MPI_INT, 0, MPI_COMM_WORLD);
  if (failed != 0)
    throw meshes::NotConverged(failure.empty() ? "the first process could not mesh the tip"
                                               : failure);
  return quality;
}

void stop_if_asked(const std::function<bool()>& stop_requested) {
  const int own = stop_requested && stop_requested() ? 1 : 0;
  int any = 0;
  MPI_Allreduce(&own, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (any != 0) throw meshes::Interrupted("stopped on request");
}

RunOutcome outcome_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const meshes::Interrupted& stop) {
    return {RunOutcome::Status::interrupted, stop.what()};
  } catch (const meshes::NotConverged& failure) {
    return {RunOutcome::Status::not_converged, failure.what()};
  }
  return {};
}

ordered_json summary_head(const RunOutcome& outcome, const ReferenceJob& job) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  ordered_json summary{{"program", "fingertip-fem"}, {"status", name(outcome.status)}};
  if (!outcome.message.empty()) summary["message"] = outcome.message;
  summary["analysis"] = fem_reference::name(job.analysis);
  summary["degree"] = job.degree;
  summary["volumetric"] = fem_reference::name(job.volumetric);
  summary["refinement"] = job.refinement;
  summary["tolerance"] = job.tolerance;
  summary["ranks"] = ranks;
  return summary;
}

ordered_json mesh_summary(const MeshSummary& mesh, double wall_time) {
  return {{"cells", mesh.cells}, {"dofs", mesh.unknowns}, {"wall_time", wall_time}};
}

void write_summary(ordered_json summary, const RunProgress& progress,
                   const std::filesystem::path& folder) {
  if (!first_process()) return;
  summary["wall_time"] = progress.wall_time();
  summary["peak_memory"] = peak_memory();
  meshes::write_atomically(folder / "summary.json",
                           [&](std::ostream& out) { out << summary.dump(2) << '\n'; });
}

ordered_json known(double value) {
  return std::isnan(value) ? ordered_json() : ordered_json(value);
}

}  // namespace fingertip::fem_reference
