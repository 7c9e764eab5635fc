#include "fem_program.h"

#include "deck.h"

#include <fstream>

#include "meshes/base/files.h"
#include "meshes/press/fields.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::benchmarks {
namespace {

/// Exit code of a press all of whose samples are there, with a larger error than was asked for.
constexpr int tolerance_not_met = 3;

}  // namespace

FemRun run_fem(const std::string& program, Problem problem, const FemOptions& options,
               const std::vector<double>& depths, double limit,
               const std::filesystem::path& folder) {
  const nlohmann::json job{
      {"protocol", {{"contact", "frictionless"}, {"depth", depths.back()}, {"samples", depths}}},
      {"strain", problem == Problem::small_strain ? "linear" : "finite"},
      {"rubber", meshes::json_of<nlohmann::json>(rubber_of(problem))},
      {"symmetry", "axisymmetric"},
      {"degree", options.degree},
      {"tolerance", options.tolerance},
      {"write_fields", false}};
  return run_fem_job(program, job, limit, folder);
}

FemRun run_fem_job(const std::string& program, const nlohmann::json& job, double limit,
                   const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  meshes::write_atomically(folder / "job.json", [&](std::ostream& out) { out << job.dump(2); });
  FemRun run;
  run.cost = run_child({program, folder.string()}, folder,
                       {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "DEAL_II_NUM_THREADS=1"},
                       limit, folder / "output.txt");
  run.cost.finished = run.cost.exit_code == 0 || run.cost.exit_code == tolerance_not_met;
  if (std::filesystem::exists(folder / "response.csv")) {
    const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
    for (const meshes::PressSample& sample : response.samples())
      run.forces.push_back(sample.normal_force);
  }
  std::ifstream in(folder / "summary.json");
  const auto summary = nlohmann::json::parse(in, nullptr, false);
  if (summary.is_object()) run.unknowns = summary.value("dofs", std::size_t{0});
  return run;
}

}  // namespace fingertip::benchmarks
