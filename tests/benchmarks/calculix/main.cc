// The same press by CalculiX and by fingertip-fem: error against the known curve, time, memory.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "calculix.h"
#include "fem_program.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "report.h"

namespace {

namespace benchmarks = fingertip::benchmarks;
using benchmarks::Contact;
using benchmarks::Element;
using benchmarks::Measurement;
using benchmarks::Problem;
using benchmarks::Solver;

struct Settings {
  std::string ccx = "/usr/bin/ccx";
  std::string fem = FINGERTIP_FEM_PROGRAM;
  std::string json, folder;
  Problem problem = Problem::small_strain;
  std::vector<double> ccx_meshes{1.0, 1.5, 2.0, 2.5, 3.0, 4.0};
  std::vector<double> fem_tolerances{1e-2, 3e-3, 1e-3, 3e-4};
  std::vector<double> targets{1e-3, 1e-2};
  double limit = 900.0;
  int repeat = 1;
  /// Of CalculiX' meshes: through the rubber (0: refined like the dome), and the largest over the
  /// smallest along the dome.
  int radial = 4;
  double grading = 4.0;
  /// What served CalculiX best among all that was tried (README).
  benchmarks::DeckOptions deck{Element::cax8r, Contact::node, Solver::spooles, 1e7, 0.0};
};

const std::map<std::string, Problem> problems{{"small-strain", Problem::small_strain},
                                              {"law-a", Problem::law_a},
                                              {"law-c", Problem::law_c},
                                              {"neo-hooke", Problem::neo_hooke},
                                              {"yeoh", Problem::yeoh},
                                              {"mooney-rivlin", Problem::mooney_rivlin},
                                              {"ogden", Problem::ogden}};
const std::map<std::string, Element> elements{{"CAX4", Element::cax4},
                                              {"CAX4R", Element::cax4r},
                                              {"CAX8", Element::cax8},
                                              {"CAX8R", Element::cax8r}};
const std::map<std::string, Contact> contacts{{"node", Contact::node},
                                              {"surface", Contact::surface}};
const std::map<std::string, Solver> solvers{{"spooles", Solver::spooles},
                                            {"iterative-scaling", Solver::iterative_scaling},
                                            {"iterative-cholesky", Solver::iterative_cholesky}};

void declare(CLI::App& app, Settings& settings) {
  app.add_option("--problem", settings.problem)->transform(CLI::CheckedTransformer(problems));
  app.add_option("--json", settings.json, "write all figures to this file");
  app.add_option("--ccx-meshes", settings.ccx_meshes, "refinements along the dome for CalculiX")
      ->delimiter(',');
  app.add_option("--fem-tolerances", settings.fem_tolerances, "asked of fingertip-fem")
      ->delimiter(',');
  app.add_option("--timeout", settings.limit, "seconds per run")->check(CLI::PositiveNumber);
  app.add_option("--targets", settings.targets, "worst relative errors to reach")
      ->delimiter(',')
      ->check(CLI::Range(1e-6, 1.0));
  app.add_option("--repeat", settings.repeat, "runs per mesh; the least processor time counts")
      ->check(CLI::Range(1, 100));
  app.add_option("--ccx", settings.ccx, "CalculiX");
  app.add_option("--fem", settings.fem, "fingertip-fem")->check(CLI::ExistingFile);
  app.add_option("--folder", settings.folder, "keep decks and run folders here");
  app.add_option("--radial", settings.radial,
                 "elements through the rubber for CalculiX; 0: refined like the dome");
  app.add_option("--grading", settings.grading, "largest over smallest element along the dome");
  app.add_option("--element", settings.deck.element)->transform(CLI::CheckedTransformer(elements));
  app.add_option("--contact", settings.deck.contact)->transform(CLI::CheckedTransformer(contacts));
  app.add_option("--solver", settings.deck.solver)->transform(CLI::CheckedTransformer(solvers));
  app.add_option("--stiffness", settings.deck.stiffness,
                 "penalty over Young's modulus, 1/m; 0: CalculiX' own");
  app.add_option("--contact-change", settings.deck.contact_change,
                 "relative change of the touching points that counts as settled; 0: its own");
}

/// The run with the least processor time among `repeat` of one mesh.
Measurement quickest(int repeat, const std::function<Measurement()>& run) {
  Measurement best = run();
  for (int i = 1; i < repeat && best.cost.finished; ++i) {
    const Measurement again = run();
    if (again.cost.finished && again.cost.cpu_seconds < best.cost.cpu_seconds) best = again;
  }
  return best;
}

std::filesystem::path fresh_folder(const Settings& settings, const std::string& run) {
  const auto folder = std::filesystem::path(settings.folder) / run;
  std::filesystem::remove_all(folder);
  return folder;
}

Measurement measure_calculix(const Settings& settings, const benchmarks::Truth& truth,
                             double refinement) {
  auto mesh = fingertip::meshes::TipMeshOptions{}.refined(refinement);
  if (settings.radial > 0) mesh.radial_elements = mesh.sleeve_elements = settings.radial;
  mesh.cap_grading = settings.grading;
  const auto run = benchmarks::run_calculix(
      settings.ccx, settings.problem, mesh, truth.depths, settings.deck, settings.limit,
      fresh_folder(settings, "calculix_" + fingertip::meshes::to_text(refinement)));
  return {refinement, run.unknowns, run.iterations, run.cost,
          benchmarks::relative_errors(run.forces, truth)};
}

benchmarks::FemRun press(const Settings& settings, const benchmarks::FemOptions& options,
                         const std::vector<double>& depths) {
  return benchmarks::run_fem(
      settings.fem, settings.problem, options, depths, settings.limit,
      fresh_folder(settings, "fingertip-fem_" + fingertip::meshes::to_text(options.tolerance)));
}

Measurement measure_fem(const Settings& settings, const benchmarks::Truth& truth,
                        double tolerance) {
  const auto run = press(settings, {.tolerance = tolerance}, truth.depths);
  return {tolerance, run.unknowns, 0, run.cost, benchmarks::relative_errors(run.forces, truth)};
}

/// The known curve; at large strain, where none is published, that of fingertip-fem on far finer
/// meshes of another degree than those that are timed.
benchmarks::Truth truth_of(const Settings& settings) {
  benchmarks::Truth truth = benchmarks::read_truth(FINGERTIP_TRUTH);
  if (settings.problem == Problem::small_strain) return truth;
  const auto run = press(settings, {.tolerance = 1e-5, .degree = 3}, truth.depths);
  if (run.forces.size() != truth.depths.size())
    throw std::runtime_error("fingertip-fem did not finish the press that is to be the truth");
  std::cout << "truth: fingertip-fem, degree 3, tolerance 1e-5, " << run.unknowns << " unknowns, "
            << run.cost.cpu_seconds << " s of processor time\n\n";
  truth.forces = run.forces;
  return truth;
}

std::string describe(const Settings& settings) {
  using fingertip::meshes::to_text;
  const benchmarks::DeckOptions& deck = settings.deck;
  std::string text = std::string(name(settings.problem)) + ", " + std::string(name(deck.element)) +
                     ", " + std::string(name(deck.contact)) + ", " +
                     std::string(name(deck.solver)) + ", penalty/E ";
  text += deck.stiffness > 0.0 ? to_text(deck.stiffness) : "its own";
  if (deck.contact_change > 0.0) text += ", contact change " + to_text(deck.contact_change);
  if (settings.radial > 0) text += ", through the rubber " + to_text(settings.radial);
  return text + ", grading " + to_text(settings.grading);
}

void compare(const Settings& settings) {
  const benchmarks::Truth truth = truth_of(settings);
  benchmarks::ProgramRuns calculix{"CalculiX", describe(settings), {}};
  benchmarks::ProgramRuns fem{"fingertip-fem", "adaptive, mesh: tolerance of the force error", {}};
  for (const double refinement : settings.ccx_meshes)
    calculix.runs.push_back(
        quickest(settings.repeat, [&] { return measure_calculix(settings, truth, refinement); }));
  print_runs(std::cout, calculix, truth);
  for (const double tolerance : settings.fem_tolerances)
    fem.runs.push_back(
        quickest(settings.repeat, [&] { return measure_fem(settings, truth, tolerance); }));
  print_runs(std::cout, fem, truth);
  if (const auto error = calculix.runs.back().worst_error())
    std::cout << "CalculiX' last mesh agrees with the truth within " << 100.0 * *error
              << " % at every depth\n";
  print_times_to_error(std::cout, calculix, fem, settings.targets);
  if (settings.json.empty()) return;
  fingertip::meshes::write_atomically(settings.json, [&](std::ostream& out) {
    out << to_json(calculix, fem, truth, settings.targets).dump(2) << '\n';
  });
}

/// True when the run folders are to be removed.
bool choose_folder(Settings& settings) {
  if (!settings.folder.empty()) {
    settings.folder = std::filesystem::absolute(settings.folder);
    return false;
  }
  settings.folder =
      std::filesystem::temp_directory_path() / ("calculix_benchmark_" + std::to_string(::getpid()));
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The same press by CalculiX and by fingertip-fem"};
  Settings settings;
  declare(app, settings);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (!std::filesystem::exists(settings.ccx)) {
    std::cerr << settings.ccx << " is missing: install calculix-ccx or name it with --ccx\n";
    return 2;
  }
  const bool temporary = choose_folder(settings);
  int code = 0;
  try {
    compare(settings);
  } catch (const fingertip::meshes::InvalidInput& error) {
    std::cerr << error.what() << '\n';
    code = 2;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    code = 1;
  }
  if (temporary) std::filesystem::remove_all(settings.folder);
  return code;
}
