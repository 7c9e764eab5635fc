#include "fem_program.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "meshes/files.h"
#include "meshes/press_response.h"

namespace fingertip::benchmarks {

FemRun run_fem(const std::string& program, double refinement, const std::vector<double>& depths,
               int threads, double limit, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  // One mesh and no error estimate: CalculiX gives none either.
  const nlohmann::json job{{"contact", "frictionless"},
                           {"samples", depths},
                           {"refinement", refinement},
                           {"estimate_error", false},
                           {"write_fields", false}};
  meshes::write_atomically(folder / "job.json", [&](std::ostream& out) { out << job.dump(2); });
  const std::string count = std::to_string(threads);
  FemRun run;
  run.cost = run_child(
      {program, folder.string()}, folder,
      {"OMP_NUM_THREADS=" + count, "OPENBLAS_NUM_THREADS=" + count, "DEAL_II_NUM_THREADS=" + count},
      limit, folder / "output.txt");
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
