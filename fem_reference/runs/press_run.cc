#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <string>
#include <utility>

#include "fem_reference/job/processes.h"
#include "fem_reference/press/mesh_history.h"
#include "fem_reference/press/press.h"
#include "fem_reference/press/press_course.h"
#include "fem_reference/runs/run_files.h"
#include "fem_reference/runs/runs.h"
#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/tip/job_mesh.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::fem_reference::inline runs {
namespace {

using meshes::to_text;
using nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

/// Meshes before the error of the finest can be told.
constexpr std::size_t fewest_meshes = 3;
/// The cells that carry this share of the squared error indicators are refined.
constexpr double refined_share = 0.5;
/// Of a meridian's error bars. Three forces agree by chance more often where many of a mesh's
/// elements lie at the contact's edge; with it 98 % of 480 bars reach forces of finer meshes
/// (MEASUREMENTS.md).
constexpr double meridian_safety = 1.2;
/// Element counts of the first mesh over those that a single mesh would have. A meridian's more: on
/// fewer the first meshes are too coarse for the error estimate, and cost as many steps as any. A
/// solid's fewer at large strain, where the way along the first saves steps on all others.
constexpr double meridian_counts = 2.0, finite_solid_counts = 0.5;
/// Of the largest force of a program: smaller ones need not be known better than one of that size.
constexpr double min_share = 0.1;
/// Refining every element multiplies the unknowns by at most this.
constexpr double max_growth = 8.0;
/// A checkpoint is written when the last one is older than this [s].
constexpr double checkpoint_interval = 10.0;
/// So are the tables [s].
constexpr double table_interval = 0.2;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// The first process's text, on all.
std::string from_first_process(std::string text) {
  unsigned long size = text.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, MPI_COMM_WORLD);
  text.resize(size);
  MPI_Bcast(text.data(), int(size), MPI_CHAR, 0, MPI_COMM_WORLD);
  return text;
}

std::string percent(double fraction) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g %%", 100 * fraction);
  return text;
}

class PressRun : Run {
 public:
  PressRun(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
           const std::function<bool()>& stop_requested)
      : Run(folder, job, progress, stop_requested),
        course_(job.protocol, job.in_time()),
        places_(course_.samples()),
        work_(job, places_.size(), fewest_meshes),
        history_(empty_history()) {}

  /// Before anything but the mesh is made.
  PressCost cost() {
    const double unknowns = begin();
    return {unknowns, work_.expected(0.0, places_.size())};
  }

  RunOutcome carry_out() {
    const RunOutcome outcome = outcome_of([&] { compute(); });
    write_tables(outcome);
    if (outcome.status == RunOutcome::Status::ok && first_process()) {
      fs::remove_all(folder_ / "checkpoint");
      fs::remove_all(folder_ / "checkpoint.next");
    }
    return outcome;
  }

 private:
  /// Every mesh in turn, until one is good enough.
  void compute() {
    begin();
    report("assemble", 0, 1, "assembling the first mesh");
    const auto made = ContinuumPress::on(job_, folder_ / "tip.msh", stop_requested_);
    ContinuumPress& press = *made;
    if (!resume(press)) start_mesh(press);
    for (;;) {
      try {
        press_on(press);
        if (!job_.rubber.relaxation.empty() && job_.estimate_error &&
            history_.step_errors().empty())
          estimate_step_errors();
      } catch (const meshes::Interrupted&) {
        save(press, true);
        throw;
      } catch (const meshes::NotConverged&) {
        write_pictures(press);
        // Where stress has no bound, at the corner of a bond, small elements turn over.
        const double known = history_.worst_relative_error();
        if (!(known > job_.tolerance)) throw;
        give_up(known, "the last of them finds no equilibrium",
                "allow a larger reference.tolerance");
      }
      const double worst = history_.worst_relative_error();
      if (!job_.estimate_error ||
          (history_.meshes().size() >= fewest_meshes && worst <= job_.tolerance))
        return write_pictures(press);
      work_.refine();
      report("refine", history_.meshes().size(), history_.meshes().size() + 1,
             std::isnan(worst) ? "refining the mesh"
                               : "refining the mesh: the force may be off by " + percent(worst));
      const std::size_t cells = press.mesh().cells;
      if (max_growth * double(press.mesh().unknowns) > job_.max_unknowns) write_pictures(press);
      // To what is known well enough no finer mesh is pressed.
      std::erase_if(unwritten_, [until = wanted(history_.meshes().size() + 1)](const auto& each) {
        return each.first < until;
      });
      write_pictures(press);
      if (!press.refine(refined_share, samples_to_improve()))
        give_up(worst,
                "a finer one would exceed reference.max_unknowns = " + to_text(job_.max_unknowns),
                "allow more unknowns or a larger reference.tolerance");
      if (press.mesh().cells == cells)
        throw meshes::NotConverged(
            "the error estimate asks for no finer element; the force error is " + percent(worst));
      start_mesh(press);
    }
  }

  /// Of those on the mesh at hand; empty, for all, until every sample has an estimate.
  std::vector<char> samples_to_improve() const {
    if (history_.meshes().size() < fewest_meshes) return {};
    std::vector<char> flags = history_.beyond(job_.tolerance);
    flags.resize(history_.meshes().back().states.size());
    return flags;
  }

  MeshHistory empty_history() const {
    MeshHistory history(job_.axisymmetric() ? meridian_safety : 1.0,
                        job_.protocol.program.empty() ? 0.0 : min_share,
                        job_.protocol.contact == meshes::ContactMode::stick);
    const double error = ContinuumPress::step_error(job_);
    if (error > 0.0) history.set_step_errors(std::vector<double>(places_.size(), error));
    return history;
  }

  /// How far doubled steps in time are off on the first mesh: more than the usual ones are.
  void estimate_step_errors() {
    const auto press = ContinuumPress::on(job_, folder_ / "tip.msh", stop_requested_);
    press->set_relaxing_step(2.0 * ContinuumPress::usual_relaxing_step);
    std::vector<double> errors;
    for (const PressState& state : history_.meshes().front().states) {
      const double usual = state.normal_force,
                   doubled = press->advance(places_[errors.size()]).normal_force;
      errors.push_back(usual > 0.0 ? std::abs(doubled / usual - 1.0) : 0.0);
      progress_.report("error", errors.size(), places_.size(),
                       "doubled steps: F = " + to_text(doubled) + " N");
    }
    history_.set_step_errors(std::move(errors));
  }

  /// Makes the first mesh; its unknowns, roughly.
  double begin() {
    progress_.report("mesh", 0, 1, "meshing the tip");
    make_mesh();
    const double unknowns =
        expected_unknowns(job_, double(mesh_quality_.hexahedra), double(mesh_quality_.nodes));
    work_.begin(unknowns);
    return unknowns;
  }

  void make_mesh() {
    double counts = 1.0;
    if (job_.axisymmetric())
      counts = meridian_counts;
    else if (job_.estimate_error && job_.strain == Strain::finite)
      counts = finite_solid_counts;
    mesh_quality_ = write_mesh_once(job_.geometry, mesh_options(job_, counts * job_.refinement),
                                    folder_ / "tip.msh");
  }

  void start_mesh(const ContinuumPress& press) {
    history_.start_mesh(press.mesh());
    const MeshSummary mesh = press.mesh();
    work_.assembled(double(mesh.unknowns));
    report("assemble", 1, 1,
           "mesh " + std::to_string(history_.meshes().size()) + ": " +
               std::to_string(mesh.unknowns) + " unknowns, " +
               std::string(fem_reference::name(mesh.solver)) + " solver");
  }

  void report(const char* stage, std::size_t done, std::size_t total, const std::string& message) {
    progress_.report(stage, done, total, message, work_.expected(progress_.wall_time(), wanted()));
  }

  /// How many samples a mesh is pressed through, the first being 1: all, until each has an
  /// estimate; then, where every sample costs many factors, up to the last that is not known well
  /// enough. Of the others a coarser mesh tells.
  std::size_t wanted(std::size_t mesh) const {
    const bool costly = job_.strain == Strain::finite && !job_.axisymmetric();
    if (!job_.estimate_error || mesh <= fewest_meshes || !costly) return places_.size();
    const std::vector<char> beyond = history_.beyond(job_.tolerance);
    return std::size_t(beyond.rend() - std::find(beyond.rbegin(), beyond.rend(), 1));
  }
  std::size_t wanted() const { return wanted(history_.meshes().size()); }

  void press_on(ContinuumPress& press) {
    for (std::size_t i = history_.finest().states.size(); i < wanted(); ++i) {
      PressState state = press.advance(places_[i]);
      state.stage = course_.stage(i);
      history_.add(std::move(state));
      keep_sample(press, i);
      work_.pressed();
      report("press", i + 1, wanted(),
             "mesh " + std::to_string(history_.meshes().size()) + ": " +
                 sample_text(history_.finest().states[i]));
    }
  }

  [[noreturn]] void give_up(double worst, const std::string& rule,
                            const std::string& remedy) const {
    const std::string error = std::isnan(worst)
                                  ? "the force error cannot be estimated"
                                  : "the force error of " + percent(worst) +
                                        " is above the tolerance of " + percent(job_.tolerance);
    throw meshes::NotConverged(error + " after " + std::to_string(history_.meshes().size()) +
                               " meshes, and " + rule + "; " + remedy);
  }

  /// Most meshes are refined at once; only what may stay is written, and not more often than it
  /// would be missed.
  void keep_sample(const ContinuumPress& press, std::size_t index) {
    unwritten_.emplace_back(index, press.snapshot());
    int due = seconds_since(last_tables_) > table_interval;
    MPI_Bcast(&due, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (due) write_tables({RunOutcome::Status::interrupted, ""});
    save(press);
  }

  void write_pictures(const ContinuumPress& press) {
    if (unwritten_.empty()) return;
    const bool may_be_last = !job_.estimate_error || history_.meshes().size() >= fewest_meshes;
    const std::size_t last = unwritten_.back().first;
    const bool deepest = last >= last_pictured_;
    last_pictured_ = std::max(last, last_pictured_);
    if (job_.write_fields && may_be_last) {
      const fs::path fields = make_folder("fields");
      for (const auto& [index, state] : unwritten_) {
        press.write_fields(*state, fields / field_name(index));
        progress_.report("fields", index + 1, places_.size(), field_name(index));
      }
      if (first_process()) write_field_series(shown_until(last_pictured_), folder_);
    }
    if (deepest) {
      const std::vector<SectionRow> section = press.section(*unwritten_.back().second);
      if (first_process()) meshes::write_rows(section, folder_ / "section.csv");
    }
    unwritten_.clear();
  }

  /// What the fields of the samples are shown over: places, or times of a rubber that relaxes.
  std::vector<double> shown_until(std::size_t last) const {
    std::vector<double> shown;
    for (std::size_t i = 0; i <= last; ++i)
      shown.push_back(job_.in_time() ? course_.time(places_[i]) : places_[i]);
    return shown;
  }

  /// The folder is complete at any time: a new checkpoint replaces the old one by renaming.
  void save(const ContinuumPress& press, bool always = false) {
    int due = always || seconds_since(last_checkpoint_) > checkpoint_interval;
    MPI_Bcast(&due, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (!due) return;
    write_pictures(press);
    const fs::path place = folder_ / "checkpoint";
    if (first_process()) fs::remove_all(folder_ / "checkpoint.next");
    const fs::path next = make_folder("checkpoint.next");
    press.save(next);
    MPI_Barrier(MPI_COMM_WORLD);
    if (first_process()) {
      meshes::write_atomically(next / "run.json", [&](std::ostream& out) {
        out << ordered_json{{"job", text_of(folder_ / "job.json")},
                            {"mesh_history", history_.to_json()},
                            {"step_errors", history_.step_errors()}};
      });
      fs::remove_all(place);
      fs::rename(next, place);
    }
    last_checkpoint_ = Clock::now();
  }

  bool resume(ContinuumPress& press) {
    // The first process decides: file systems of other nodes may lag behind. `checkpoint` is
    // missing for an instant while a new one takes its place.
    std::string place, text;
    if (first_process())
      for (const char* candidate : {"checkpoint", "checkpoint.next"}) {
        const auto json =
            ordered_json::parse(text_of(folder_ / candidate / "run.json"), nullptr, false);
        if (!json.is_object() || !json.contains("mesh_history") ||
            json.value("job", "") != text_of(folder_ / "job.json"))
          continue;
        place = candidate;
        text = json.dump();
        break;
      }
    place = from_first_process(place);
    if (place.empty()) return false;
    const auto json = ordered_json::parse(from_first_process(text));
    press.load(folder_ / place);
    history_ = MeshHistory::from_json(json.at("mesh_history"), empty_history());
    history_.set_step_errors(json.value("step_errors", std::vector<double>()));
    if (history_.meshes().size() > fewest_meshes) last_pictured_ = places_.size() - 1;
    work_.resume(double(press.mesh().unknowns), history_.meshes().size(),
                 history_.finest().states.size());
    report("press", history_.finest().states.size(), places_.size(),
           "resumed on mesh " + std::to_string(history_.meshes().size()) + " after " +
               std::to_string(history_.finest().states.size()) + " samples");
    return true;
  }

  void write_tables(const RunOutcome& outcome) {
    if (!first_process()) return;
    last_tables_ = Clock::now();
    const std::vector<PressState> best = history_.best();
    write_samples(best, job_, folder_);
    write_convergence(history_, folder_);
    write_summary(summarise(best, outcome), progress_, folder_);
  }

  RunSummary summarise(const std::vector<PressState>& best, const RunOutcome& outcome) const {
    RunSummary summary = summary_head(outcome, job_);
    summary.contact = meshes::name(job_.protocol.contact);
    summary.strain = fem_reference::name(job_.strain);
    if (job_.strain == Strain::finite) summary.law = meshes::describe(job_.rubber.energy);
    summary.worst_relative_error = history_.worst_relative_error();
    if (!history_.meshes().empty()) add_finest(history_.meshes().back().mesh, summary);
    summary.mesh = mesh_quality_;
    for (const MeshRecord& record : history_.meshes())
      summary.meshes.push_back(mesh_entry(record.mesh, record.wall_time, record.states.size()));
    if (!best.empty()) summary.contact_node_spacing = best.back().node_spacing;
    summary.samples = best;
    return summary;
  }

  const PressCourse course_;
  const std::vector<double> places_;  ///< of the samples on the course [m]
  PressWork work_;
  Clock::time_point last_checkpoint_ = Clock::now(), last_tables_;
  std::vector<std::pair<std::size_t, std::shared_ptr<const PressSnapshot>>> unwritten_;
  std::size_t last_pictured_ = 0;  ///< the deepest sample that fields and section show
  meshes::MeshQuality mesh_quality_;
  MeshHistory history_;
};

}  // namespace

PressCost press_cost(const fs::path& folder, const ReferenceJob& job) {
  std::ostringstream unread;
  const std::function<bool()> never = [] { return false; };
  return PressRun(folder, job, unread, never).cost();
}

RunOutcome run_press(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
                     const std::function<bool()>& stop_requested) {
  return PressRun(folder, job, progress, stop_requested).carry_out();
}

}  // namespace fingertip::fem_reference::inline runs
