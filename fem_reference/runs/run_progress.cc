#include "fem_reference/runs/run_progress.h"

#include <mpi.h>
#include <sys/resource.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

#include "fem_reference/job/processes.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/press/no_equilibrium.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::fem_reference::inline runs {
namespace {

using meshes::to_text;
using nlohmann::ordered_json;

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  constexpr double kibibyte = 1024.0;
  return kibibyte * double(usage.ru_maxrss);
}

}  // namespace

void RunProgress::report(const char* stage, std::size_t done, std::size_t total,
                         const std::string& message, const Expected& expected) {
  if (!first_process()) return;
  ordered_json line{{"stage", stage}, {"done", done}, {"total", total}, {"message", message}};
  if (!std::isnan(expected.left)) {
    line["left"] = expected.left;
    line["memory"] = expected.memory;
  }
  out_ << line << std::endl;
}

double RunProgress::wall_time() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::filesystem::path Run::make_folder(const std::filesystem::path& name) const {
  if (first_process()) std::filesystem::create_directories(folder_ / name);
  MPI_Barrier(MPI_COMM_WORLD);
  return folder_ / name;
}

RunOutcome outcome_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const meshes::Interrupted& stop) {
    return {RunOutcome::Status::interrupted, stop.what()};
  } catch (const meshes::NoEquilibrium& failure) {
    return {RunOutcome::Status::not_converged, failure.what(), failure.indentation()};
  } catch (const meshes::NotConverged& failure) {
    return {RunOutcome::Status::not_converged, failure.what()};
  }
  return {};
}

RunSummary summary_head(const RunOutcome& outcome, const ReferenceJob& job) {
  int ranks = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  RunSummary summary;
  summary.program = "fingertip-fem";
  summary.status = name(outcome.status);
  summary.message = outcome.message;
  summary.reached = outcome.reached;
  summary.analysis = fem_reference::name(job.analysis);
  summary.degree = job.degree;
  summary.volumetric = fem_reference::name(job.volumetric);
  summary.refinement = job.refinement;
  summary.tolerance = job.tolerance;
  summary.ranks = ranks;
  return summary;
}

MeshEntry mesh_entry(const MeshSummary& mesh, double wall_time,
                     std::optional<std::size_t> samples) {
  return {mesh.cells, mesh.unknowns, samples, wall_time};
}

std::string sample_text(const meshes::PressSample& sample) {
  std::string text =
      "F = " + to_text(sample.normal_force) + " N at " + to_text(sample.indentation) + " m";
  if (!std::isnan(sample.time)) text += ", " + to_text(sample.time) + " s";
  if (sample.lateral_displacement != 0.0)
    text += ", " + to_text(sample.lateral_force_x) + " N laterally at " +
            to_text(sample.lateral_displacement) + " m";
  if (std::abs(sample.twist) > 0.0)
    text += ", " + to_text(sample.spin_torque) + " N m about the normal at " +
            to_text(sample.twist) + " rad";
  return text;
}

void add_finest(const MeshSummary& mesh, RunSummary& summary) {
  summary.solver = fem_reference::name(mesh.solver);
  summary.cells = mesh.cells;
  summary.dofs = mesh.unknowns;
  summary.contact_unknowns = mesh.contact_unknowns;
}

void write_summary(RunSummary summary, const RunProgress& progress,
                   const std::filesystem::path& folder) {
  if (!first_process()) return;
  summary.wall_time = progress.wall_time();
  summary.peak_memory = peak_memory();
  meshes::write_json_file(summary, folder / "summary.json");
}

}  // namespace fingertip::fem_reference::inline runs
