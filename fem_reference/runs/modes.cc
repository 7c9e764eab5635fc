#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fem_reference/job/processes.h"
#include "fem_reference/job/run_tables.h"
#include "fem_reference/motion/tip_modes.h"
#include "fem_reference/press/force_error.h"
#include "fem_reference/runs/run_files.h"
#include "fem_reference/runs/runs.h"
#include "fem_reference/tip/job_mesh.h"
#include "meshes/base/errors.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::fem_reference::inline runs {
namespace {

namespace fs = std::filesystem;
using meshes::to_text;

/// Meshes before the error of the finest can be told. Frequencies are free of the noise of contact,
/// for which a press takes three.
constexpr std::size_t fewest_mode_meshes = 2;
/// From mesh to mesh the element counts grow by about this factor, the unknowns by its cube.
constexpr double growth = std::numbers::sqrt2;

/// Element counts are whole numbers. A direction in which two meshes are alike would hide its error
/// from their difference, so that every count must grow.
double next_refinement(double refinement) {
  const auto counts = [](double factor) {
    const meshes::TipMeshOptions o = meshes::TipMeshOptions{}.refined(factor);
    return std::array{o.cap_elements, o.ring_elements, o.sleeve_elements, o.radial_elements};
  };
  const auto before = counts(refinement);
  for (double next = refinement * growth;; next *= growth) {
    const auto after = counts(next);
    bool all_grow = true;
    for (std::size_t i = 0; i < after.size(); ++i) all_grow = all_grow && after[i] > before[i];
    if (all_grow) return next;
  }
}

struct ModesOnMesh {
  MeshSummary mesh;
  std::array<std::vector<NaturalMode>, 4> classes;
  double wall_time = 0.0;
};

class ModesRun : Run {
 public:
  using Run::Run;

  RunOutcome carry_out() {
    const RunOutcome outcome = outcome_of([&] { compute(); });
    write_tables(outcome);
    return outcome;
  }

 private:
  /// Meshes ever finer, until one is good enough or the next would be too large.
  void compute() {
    for (double refinement = job_.refinement;; refinement = next_refinement(refinement)) {
      solve_on(refinement);
      const bool estimable = meshes_.size() >= fewest_mode_meshes;
      const double worst = worst_relative_error();
      if (!job_.estimate_error || (estimable && worst <= job_.tolerance)) return;
      const double next = std::pow(next_refinement(refinement) / refinement, 3) *
                          double(meshes_.back().mesh.unknowns);
      if (next > job_.max_unknowns) refuse(worst, next);
    }
  }

  [[noreturn]] void refuse(double worst, double unknowns) const {
    const std::string error =
        std::isnan(worst) ? "one mesh does not tell how far a natural frequency is off"
                          : "a natural frequency may be off by " + to_text(worst) +
                                " of itself, more than the tolerance of " + to_text(job_.tolerance);
    throw meshes::NotConverged(error + ", and a finer mesh would have about " +
                               to_text(std::round(unknowns)) +
                               " unknowns; allow more unknowns or a larger tolerance");
  }

  void solve_on(double refinement) {
    const double start = progress_.wall_time();
    const std::size_t number = meshes_.size() + 1;
    progress_.report("mesh", number - 1, number, "meshing the tip");
    write_mesh_once(job_.geometry, mesh_options(job_, refinement), folder_ / "tip.msh");
    TipModes tip(job_, folder_ / "tip.msh");
    ModesOnMesh found;
    found.mesh = tip.mesh();
    for (std::size_t i = 0; i < classes(); ++i) {
      stop_if_asked(stop_requested_);
      progress_.report("modes", i, classes(),
                       "mesh " + std::to_string(number) + ": " +
                           std::to_string(found.mesh.unknowns) + " unknowns, symmetry " +
                           symmetry(symmetry_classes[i]));
      found.classes[i] = tip.solve(symmetry_classes[i], job_.modes);
    }
    found.wall_time = progress_.wall_time() - start;
    meshes_.push_back(std::move(found));
    progress_.report("modes", classes(), classes(),
                     "mesh " + std::to_string(number) + ": lowest frequency " +
                         to_text(lowest().front().frequency) + " Hz");
    write_tables({RunOutcome::Status::interrupted, ""});
    if (job_.write_fields && (!job_.estimate_error || meshes_.size() >= fewest_mode_meshes))
      write_fields(tip);
  }

  /// A solid has no symmetry: its modes are of one class.
  std::size_t classes() const { return job_.geometry.solid ? 1 : symmetry_classes.size(); }
  std::string symmetry(SymmetryClass of) const { return job_.geometry.solid ? "none" : name(of); }

  /// Of all classes on the finest mesh.
  std::vector<NaturalMode> lowest() const {
    std::vector<NaturalMode> all;
    for (const auto& of_class : meshes_.back().classes)
      all.insert(all.end(), of_class.begin(), of_class.end());
    std::ranges::stable_sort(all, {}, &NaturalMode::frequency);
    all.resize(std::size_t(job_.modes));
    return all;
  }

  /// [Hz]. The k-th frequency of a class on one mesh belongs to the k-th on another.
  double error(const NaturalMode& mode) const {
    const auto place =
        std::size_t(std::ranges::find(symmetry_classes, mode.symmetry) - symmetry_classes.begin());
    std::vector<MeshForce> sequence;
    for (const ModesOnMesh& mesh : meshes_)
      sequence.push_back(
          {double(mesh.mesh.unknowns), mesh.classes[place].at(mode.number).frequency});
    return estimate_force_error(sequence).value;
  }

  double worst_relative_error() const {
    double worst = 0.0;
    for (const NaturalMode& mode : lowest()) {
      const double relative = error(mode) / mode.frequency;
      if (std::isnan(relative)) return relative;
      worst = std::max(worst, relative);
    }
    return worst;
  }

  void write_fields(const TipModes& tip) {
    const std::vector<NaturalMode> modes = lowest();
    const fs::path fields = make_folder("fields");
    std::vector<std::pair<std::string, std::string>> series;
    for (std::size_t i = 0; i < modes.size(); ++i) {
      stop_if_asked(stop_requested_);
      series.emplace_back(std::to_string(i + 1), field_name(i, "mode"));
      tip.write_fields(modes[i], fields / series.back().second);
      progress_.report("fields", i + 1, modes.size(), series.back().second);
    }
    if (first_process()) write_series(fields / "modes.pvd", series);
  }

  void write_tables(const RunOutcome& outcome) const {
    if (!first_process()) return;
    RunSummary summary = summary_head(outcome, job_);
    for (const ModesOnMesh& mesh : meshes_)
      summary.meshes.push_back(mesh_entry(mesh.mesh, mesh.wall_time));
    if (!meshes_.empty()) {
      summary.cells = meshes_.back().mesh.cells;
      summary.dofs = meshes_.back().mesh.unknowns;
      summary.worst_relative_error = worst_relative_error();
      write_modes(lowest());
    }
    write_summary(std::move(summary), progress_, folder_);
  }

  void write_modes(const std::vector<NaturalMode>& modes) const {
    std::vector<ModeRow> rows;
    for (const NaturalMode& mode : modes)
      rows.push_back({int(rows.size()) + 1, mode.frequency, error(mode), symmetry(mode.symmetry),
                      mode.multiplicity});
    meshes::write_rows(rows, folder_ / "modes.csv");
  }

  std::vector<ModesOnMesh> meshes_;  ///< coarse to fine
};

}  // namespace

RunOutcome run_modes(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
                     const std::function<bool()>& stop_requested) {
  return ModesRun(folder, job, progress, stop_requested).carry_out();
}

}  // namespace fingertip::fem_reference::inline runs
