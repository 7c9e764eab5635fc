// The verification as a run: its parts one after the other, the table written after each.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "fem_reference/job/processes.h"
#include "fem_reference/verification/verification.h"
#include "meshes/base/errors.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::fem_reference::inline verification {
namespace {

using enum Volumetric;
namespace fs = std::filesystem;

constexpr double paper_ratio = 3.0 / 7.0, nearly_incompressible = 0.4999;
const std::vector<double> swept_ratios{0.0, 0.25, 0.4, paper_ratio, 0.45, 0.49, 0.499, 0.4999};
constexpr std::array element_types{ElementType{1, pointwise}, ElementType{1, mean_dilatation},
                                   ElementType{2, pointwise}, ElementType{2, mean_dilatation},
                                   ElementType{3, pointwise}, ElementType{3, mean_dilatation}};
/// Divisions that show the order and stay cheap, by degree.
const std::array<std::vector<int>, 4> block_divisions{{{}, {4, 8, 16}, {2, 4, 8}, {1, 2, 4}}};
const std::array<std::vector<int>, 4> ring_divisions{{{}, {8, 16, 32}, {4, 8, 16}, {4, 8, 16}}};
const std::array<std::vector<int>, 4> sphere_divisions{{{}, {2, 4, 8}, {2, 4, 8}, {1, 2, 4}}};
const std::array<std::vector<int>, 4> cylinder_divisions{{{}, {4, 8, 16}, {4, 8, 16}, {2, 4, 8}}};
const std::array<std::vector<int>, 4> plate_divisions{{{}, {2, 4, 8}, {2, 4, 8}, {}}};

using Tables = VerificationFile;

template <class T>
void append(std::vector<T>& table, std::vector<T> more) {
  std::ranges::move(more, std::back_inserter(table));
}

struct Part {
  std::string name;
  std::function<void(Tables&, const fs::path& folder)> compute;
};

void add_convergence(std::vector<Part>& parts) {
  for (const ElementType& element : element_types) {
    const auto degree = std::size_t(element.degree);
    parts.push_back({"manufactured solutions, " + name(element), [=](Tables& t, const fs::path&) {
                       for (const ManufacturedCase& problem :
                            {ManufacturedCase{true, false, paper_ratio},
                             ManufacturedCase{false, false, paper_ratio},
                             ManufacturedCase{true, true, nearly_incompressible}})
                         t.studies.push_back(
                             study_manufactured(problem, element, block_divisions[degree]));
                       for (const bool bent : {true, false})
                         t.studies.push_back(
                             study_manufactured_meridian(bent, element, ring_divisions[degree]));
                     }});
  }
  for (int degree = 1; degree <= 3; ++degree)
    parts.push_back(
        {"sphere, cylinder, cantilever, degree " + std::to_string(degree),
         [=](Tables& t, const fs::path&) {
           const ElementType element{degree, mean_dilatation};
           const auto d = std::size_t(degree);
           for (const Meshed meshed : {Meshed::solid, Meshed::meridian}) {
             t.studies.push_back(study_sphere(element, paper_ratio, sphere_divisions[d], meshed));
             t.studies.push_back(
                 study_cylinder(element, paper_ratio, cylinder_divisions[d], meshed));
           }
           if (!plate_divisions[d].empty())
             t.studies.push_back(study_cantilever(element, paper_ratio, plate_divisions[d]));
           append(t.checks, check_fields(element, 4));
         }});
}

std::vector<Part> all_parts() {
  std::vector<Part> parts;
  parts.push_back({"patch tests and rigid modes", [](Tables& t, const fs::path&) {
                     for (const ElementType& element : element_types) {
                       append(t.checks, check_patch(element));
                       append(t.checks, check_rigid_modes(element));
                     }
                   }});
  add_convergence(parts);
  parts.push_back(
      {"bonded disc", [](Tables& t, const fs::path&) {
         for (const double thickness : {0.005, 0.01})
           for (const double nu : {paper_ratio, 0.25})
             for (const Meshed meshed : {Meshed::solid, Meshed::meridian})
               append(t.checks, check_disc(thickness, nu, {2, mean_dilatation}, 2, meshed));
       }});
  parts.push_back({"symmetry and balance of the press", [](Tables& t, const fs::path& folder) {
                     append(t.checks, check_press(folder));
                   }});
  parts.push_back({"Hertz", [](Tables& t, const fs::path& folder) {
                     for (const double rod : {0.1, 0.3})
                       append(t.checks, check_hertz(press_towards_hertz(
                                            rod, {1e-6, 2e-6, 4e-6, 8e-6}, 3, folder)));
                   }});
  parts.push_back({"locking of the cantilever", [](Tables& t, const fs::path&) {
                     append(t.locking, lock_cantilever(swept_ratios));
                   }});
  parts.push_back({"locking of the disc",
                   [](Tables& t, const fs::path&) { append(t.locking, lock_disc(swept_ratios)); }});
  parts.push_back({"locking of the press", [](Tables& t, const fs::path& folder) {
                     append(t.locking, lock_press(swept_ratios, folder));
                   }});
  return parts;
}

class VerificationRun : Run {
 public:
  using Run::Run;

  RunOutcome carry_out() {
    const std::vector<Part> parts = all_parts();
    const RunOutcome outcome = outcome_of([&] {
      for (std::size_t i = 0; i < parts.size(); ++i) {
        stop_if_asked(stop_requested_);
        progress_.report("verify", i, parts.size(), parts[i].name);
        parts[i].compute(tables_, folder_);
        write({RunOutcome::Status::interrupted, ""});
      }
      progress_.report("verify", parts.size(), parts.size(),
                       std::to_string(tables_.checks.size() - failed()) + " of " +
                           std::to_string(tables_.checks.size()) + " checks passed");
    });
    write(outcome);
    if (first_process()) fs::remove(folder_ / verification_mesh);
    return outcome;
  }

 private:
  std::size_t failed() const {
    return std::size_t(
        std::ranges::count_if(tables_.checks, [](const Check& check) { return !check.passed; }));
  }

  void write(const RunOutcome& outcome) const {
    if (!first_process()) return;
    meshes::write_json_file(tables_, folder_ / "verification.json");
    RunSummary summary = summary_head(outcome, job_);
    summary.checks = tables_.checks.size();
    summary.failed_checks = failed();
    write_summary(std::move(summary), progress_, folder_);
  }

  Tables tables_;
};

}  // namespace

RunOutcome run_verification(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
                            const std::function<bool()>& stop_requested) {
  return VerificationRun(folder, job, progress, stop_requested).carry_out();
}

}  // namespace fingertip::fem_reference::inline verification
