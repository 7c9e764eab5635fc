// The same press by CalculiX and by fingertip-fem: error against the known curve, time, memory.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "calculix.h"
#include "fem_program.h"
#include "meshes/errors.h"
#include "meshes/files.h"
#include "report.h"

namespace {

namespace benchmarks = fingertip::benchmarks;
using benchmarks::Contact;
using benchmarks::Element;
using benchmarks::Measurement;
using benchmarks::Solver;

struct Settings {
  std::string ccx = "/usr/bin/ccx";
  std::string fem = FINGERTIP_FEM_PROGRAM;
  std::string truth = FINGERTIP_TRUTH;
  std::string json, folder;
  std::vector<double> ccx_meshes, fem_unknowns;
  double limit = 900.0, target = 0.01;
  int repeat = 1, ccx_threads = 1, fem_threads = 1;
  bool quick = false;
  /// What served CalculiX best among all that was tried (README).
  benchmarks::DeckOptions deck{Element::c3d20r, Contact::surface, Solver::iterative_scaling, 2e5,
                               0.02};
};

const std::map<std::string, Element> elements{{"C3D8", Element::c3d8},
                                              {"C3D8I", Element::c3d8i},
                                              {"C3D20", Element::c3d20},
                                              {"C3D20R", Element::c3d20r}};
const std::map<std::string, Contact> contacts{{"gap", Contact::gap},
                                              {"node", Contact::node},
                                              {"surface", Contact::surface},
                                              {"mortar", Contact::mortar}};
const std::map<std::string, Solver> solvers{{"spooles", Solver::spooles},
                                            {"iterative-scaling", Solver::iterative_scaling},
                                            {"iterative-cholesky", Solver::iterative_cholesky}};

void declare(CLI::App& app, Settings& settings) {
  app.add_option("--json", settings.json, "write all figures to this file");
  app.add_flag("--quick", settings.quick, "two small meshes only");
  app.add_option("--ccx-meshes", settings.ccx_meshes, "refinements for CalculiX")->delimiter(',');
  app.add_option("--fem-unknowns", settings.fem_unknowns,
                 "most unknowns of the adaptive meshes of fingertip-fem")
      ->delimiter(',');
  app.add_option("--timeout", settings.limit, "seconds per run")->check(CLI::PositiveNumber);
  app.add_option("--target", settings.target, "worst relative error to reach")
      ->check(CLI::Range(1e-6, 1.0));
  app.add_option("--repeat", settings.repeat, "runs per mesh; the quickest counts")
      ->check(CLI::Range(1, 100));
  app.add_option("--ccx", settings.ccx, "CalculiX");
  app.add_option("--fem", settings.fem, "fingertip-fem")->check(CLI::ExistingFile);
  app.add_option("--truth", settings.truth, "the known curve")->check(CLI::ExistingFile);
  app.add_option("--folder", settings.folder, "keep decks and run folders here");
  app.add_option("--ccx-threads", settings.ccx_threads)->check(CLI::Range(1, 1024));
  app.add_option("--fem-threads", settings.fem_threads)->check(CLI::Range(1, 1024));
  app.add_option("--element", settings.deck.element)->transform(CLI::CheckedTransformer(elements));
  app.add_option("--contact", settings.deck.contact)->transform(CLI::CheckedTransformer(contacts));
  app.add_option("--solver", settings.deck.solver)->transform(CLI::CheckedTransformer(solvers));
  app.add_option("--stiffness", settings.deck.stiffness,
                 "penalty over Young's modulus, 1/m (gap: m); 0: CalculiX' own");
  app.add_option("--contact-change", settings.deck.contact_change,
                 "relative change of the touching points that counts as settled; 0: its own");
}

/// The quickest of `repeat` runs of one mesh.
Measurement quickest(int repeat, const std::function<Measurement()>& run) {
  Measurement best = run();
  for (int i = 1; i < repeat && best.cost.finished; ++i) {
    const Measurement again = run();
    if (again.cost.finished && again.cost.wall_seconds < best.cost.wall_seconds) best = again;
  }
  return best;
}

std::filesystem::path fresh_folder(const Settings& settings, const std::string& program,
                                   double mesh) {
  const auto folder =
      std::filesystem::path(settings.folder) / (program + "_" + fingertip::meshes::to_text(mesh));
  std::filesystem::remove_all(folder);
  return folder;
}

Measurement measure_calculix(const Settings& settings, const benchmarks::Truth& truth,
                             double refinement) {
  const auto run = benchmarks::run_calculix(settings.ccx, refinement, truth.depths, settings.deck,
                                            settings.ccx_threads, settings.limit,
                                            fresh_folder(settings, "calculix", refinement));
  return {refinement, run.unknowns, run.iterations, run.cost,
          benchmarks::relative_errors(run.forces, truth)};
}

Measurement measure_fem(const Settings& settings, const benchmarks::Truth& truth,
                        double max_unknowns) {
  const auto run =
      benchmarks::run_fem(settings.fem, max_unknowns, truth.depths, settings.fem_threads,
                          settings.limit, fresh_folder(settings, "fingertip-fem", max_unknowns));
  return {max_unknowns, run.unknowns, 0, run.cost, benchmarks::relative_errors(run.forces, truth)};
}

std::string describe(const benchmarks::DeckOptions& deck) {
  std::string text = std::string(name(deck.element)) + ", " + std::string(name(deck.contact)) +
                     ", " + std::string(name(deck.solver));
  if (deck.contact != Contact::mortar) {
    text += ", penalty/E ";
    text += deck.stiffness > 0.0 ? fingertip::meshes::to_text(deck.stiffness) : "its own";
  }
  if (deck.contact_change > 0.0)
    text += ", contact change " + fingertip::meshes::to_text(deck.contact_change);
  return text;
}

void compare(const Settings& settings) {
  const benchmarks::Truth truth = benchmarks::read_truth(settings.truth);
  benchmarks::ProgramRuns calculix{"CalculiX", describe(settings.deck), settings.ccx_threads, {}};
  benchmarks::ProgramRuns fem{
      "fingertip-fem", "adaptive, from its default first mesh", settings.fem_threads, {}};
  for (const double refinement : settings.ccx_meshes)
    calculix.runs.push_back(
        quickest(settings.repeat, [&] { return measure_calculix(settings, truth, refinement); }));
  print_runs(std::cout, calculix, truth);
  for (const double max_unknowns : settings.fem_unknowns)
    fem.runs.push_back(
        quickest(settings.repeat, [&] { return measure_fem(settings, truth, max_unknowns); }));
  print_runs(std::cout, fem, truth);
  print_times_to_error(std::cout, calculix, fem, settings.target);
  if (settings.json.empty()) return;
  fingertip::meshes::write_atomically(settings.json, [&](std::ostream& out) {
    out << to_json(calculix, fem, truth, settings.target).dump(2) << '\n';
  });
}

/// Fills in what the command line left open. True when the run folders are to be removed.
bool complete(Settings& settings) {
  // Each program gets meshes on both sides of one per cent; they are not the same ones.
  const auto choose = [&](std::vector<double>& meshes, std::vector<double> usual) {
    if (!meshes.empty()) return;
    if (settings.quick) usual.resize(2);
    meshes = usual;
  };
  choose(settings.ccx_meshes, {0.25, 0.35, 0.42, 0.5, 0.7});
  choose(settings.fem_unknowns, {1.2e4, 2.2e4, 4e4, 8e4});
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
  const bool temporary = complete(settings);
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
