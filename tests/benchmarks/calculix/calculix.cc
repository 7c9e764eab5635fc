#include "calculix.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "meshes/volume_mesh.h"

namespace fingertip::benchmarks {
namespace {

constexpr double quarters = 4.0;  ///< in the tip

}  // namespace

std::vector<double> read_total_forces(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::vector<double> forces;
  for (std::string line; std::getline(in, line);) {
    if (line.find("total force") == std::string::npos) continue;
    double fx = 0.0, fy = 0.0, fz = 0.0;
    if (!(in >> fx >> fy >> fz)) throw std::runtime_error(file.string() + " ends within an entry");
    forces.push_back(fz);
  }
  return forces;
}

int read_iterations(const std::filesystem::path& file) {
  // Columns: step, increment, attempt (with a U when it failed), iterations, times.
  std::ifstream in(file);
  int total = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    int step = 0, increment = 0, iterations = 0;
    std::string attempt;
    if (cells >> step >> increment >> attempt >> iterations) total += iterations;
  }
  return total;
}

CalculixRun run_calculix(const std::string& ccx, double refinement,
                         const std::vector<double>& depths, const DeckOptions& options, int threads,
                         double limit, const std::filesystem::path& folder) {
  const meshes::Geometry geometry;
  std::filesystem::create_directories(folder);
  meshes::write_tip_mesh(geometry, meshes::TipMeshOptions{}.refined(refinement),
                         folder / "tip.msh");
  SolidMesh mesh = read_solid_mesh(folder / "tip.msh");
  if (is_quadratic(options.element)) mesh = with_midside_nodes(mesh);
  write_deck(mesh, geometry, meshes::Rubber{}, depths, options, folder / "press.inp");

  CalculixRun run;
  run.unknowns = 3 * mesh.nodes.size();
  const std::string count = std::to_string(threads);
  run.cost = run_child({ccx, "-i", "press"}, folder,
                       {"OMP_NUM_THREADS=" + count, "OPENBLAS_NUM_THREADS=" + count}, limit,
                       folder / "log.txt");
  run.iterations = read_iterations(folder / "press.sta");
  if (!std::filesystem::exists(folder / "press.dat")) return run;
  for (const double force : read_total_forces(folder / "press.dat"))
    run.forces.push_back(quarters * std::abs(force) / millinewtons);
  return run;
}

}  // namespace fingertip::benchmarks
