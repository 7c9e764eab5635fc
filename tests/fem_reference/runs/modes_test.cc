#include "fem_reference/runs/runs.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "fem_reference/motion/tip_modes.h"
#include "fem_reference/solvers/eigen_solver.h"
#include "fem_reference/tip/tip_body.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using namespace fingertip::fem_reference;

namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> frequencies(const std::vector<Eigenpair>& pairs) {
  std::vector<double> result;
  for (const Eigenpair& pair : pairs) result.push_back(std::sqrt(pair.eigenvalue) / (2 * pi));
  return result;
}

std::vector<Eigenpair> solve(const Body<3>& body, const meshes::Rubber& rubber,
                             Volumetric volumetric, int count) {
  HookeKernel<3> stiffness(rubber, volumetric);
  MassKernel<3> mass(rubber.density);
  return lowest_eigenpairs(body, stiffness, mass, count);
}

/// Largest relative difference, in order.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = a.size() == b.size() ? 0.0 : 1.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    worst = std::max(worst, std::abs(a[i] / b[i] - 1.0));
  return worst;
}

// --- A box between six smooth walls: every plane standing wave fits in exactly. ---

const std::array<double, 3> box_edges{0.010, 0.012, 0.0155};

/// Of the waves u_x = A sin(l pi x/a) cos(m pi y/b) cos(n pi z/c) and so on: one longitudinal for
/// any (l, m, n) but zero; transverse ones as many as the numbers that are not zero, less one.
std::vector<double> standing_waves(const meshes::Rubber& rubber, std::size_t count) {
  std::vector<double> result;
  for (int l = 0; l < 6; ++l)
    for (int m = 0; m < 6; ++m)
      for (int n = 0; n < 6; ++n) {
        const int nonzero = (l > 0) + (m > 0) + (n > 0);
        if (nonzero == 0) continue;
        const double k = pi * std::hypot(l / box_edges[0], m / box_edges[1], n / box_edges[2]);
        result.push_back(rubber.longitudinal_wave_speed() * k / (2 * pi));
        for (int i = 1; i < nonzero; ++i)
          result.push_back(rubber.shear_wave_speed() * k / (2 * pi));
      }
  std::ranges::sort(result);
  result.resize(count);
  return result;
}

/// Of the `count` lowest frequencies, the largest relative error.
double box_error(int degree, unsigned elements, Volumetric volumetric, int count) {
  const meshes::Rubber rubber;
  Body<3> body(MPI_COMM_WORLD, degree);
  dealii::GridGenerator::subdivided_hyper_rectangle(
      body.triangulation, {elements, elements, elements}, dealii::Point<3>(),
      dealii::Point<3>(box_edges[0], box_edges[1], box_edges[2]), true);
  std::vector<FixedComponent> walls;
  for (int face = 0; face < 6; ++face) walls.push_back({unsigned(face), face / 2});
  body.number(walls);
  return difference(frequencies(solve(body, rubber, volumetric, count)),
                    standing_waves(rubber, std::size_t(count)));
}

TEST(Eigenpairs, AreTheStandingWavesOfABoxAtTheElementsOrder) {
  // Order 2 p. The projected dilatation is of degree p - 1, which is as good as the gradient is.
  for (const Volumetric volumetric : {Volumetric::pointwise, Volumetric::mean_dilatation}) {
    const double coarse = box_error(2, 3, volumetric, 8), fine = box_error(2, 6, volumetric, 8);
    SCOPED_TRACE(name(volumetric));
    RecordProperty(std::string(name(volumetric)), std::to_string(fine));
    EXPECT_LT(fine, 2e-3);
    EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.4) << coarse << " " << fine;
  }
  const double coarse = box_error(1, 5, Volumetric::pointwise, 3);
  const double fine = box_error(1, 10, Volumetric::pointwise, 3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.2) << coarse << " " << fine;
}

// --- A tube bonded inside, in torsion. ---

/// u_phi = A J1(k r) + B Y1(k r) vanishes at the bond and is free of shear outside,
/// r d/dr(u_phi/r) = -k (A J2 + B Y2) = 0 at R: independent of z, so the free ends change nothing.
double torsion_frequency(const meshes::Geometry& geometry, const meshes::Rubber& rubber) {
  const auto mismatch = [&](double k) {
    const double bond = k * geometry.rod_radius, outer = k * geometry.tip_radius;
    return std::cyl_bessel_j(1, bond) * std::cyl_neumann(2, outer) -
           std::cyl_neumann(1, bond) * std::cyl_bessel_j(2, outer);
  };
  double low = 0.1 / geometry.tip_radius, high = low;
  while (mismatch(low) * mismatch(high) > 0.0) high *= 1.1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (mismatch(low) * mismatch(middle) > 0.0 ? low : high) = middle;
  }
  return rubber.shear_wave_speed() * low / (2 * pi);
}

TEST(Eigenpairs, IncludeTheTorsionOfABondedTube) {
  const meshes::Geometry geometry;
  const meshes::Rubber rubber;
  Body<3> body(MPI_COMM_WORLD, 2);
  dealii::GridGenerator::subdivided_hyper_rectangle(
      body.triangulation, {6, 8, 2}, dealii::Point<3>(geometry.rod_radius, 0.0, 0.0),
      dealii::Point<3>(geometry.tip_radius, pi / 2, 0.004), true);
  dealii::GridTools::transform(
      [](const dealii::Point<3>& p) {
        return dealii::Point<3>(p[0] * std::cos(p[1]), p[0] * std::sin(p[1]), p[2]);
      },
      body.triangulation);
  body.triangulation.set_all_manifold_ids(0);
  body.triangulation.set_manifold(0, dealii::CylindricalManifold<3>(2));
  // Faces 0: r, 2: y = 0, 3: x = 0. Torsion crosses both planes at right angles.
  body.number({{0, 0}, {0, 1}, {0, 2}, {2, 0}, {2, 2}, {3, 1}, {3, 2}});
  const double exact = torsion_frequency(geometry, rubber);
  double nearest = 1.0;
  for (const double f : frequencies(solve(body, rubber, Volumetric::mean_dilatation, 4)))
    nearest = std::min(nearest, std::abs(f / exact - 1.0));
  RecordProperty("relative_error", std::to_string(nearest));
  EXPECT_LT(nearest, 2e-5);
}

// --- The tip. ---

struct Tip {
  explicit Tip(double refinement, meshes::Sector sector = meshes::Sector::quarter)
      : mesh(refinement, sector) {
    job.analysis = Analysis::modes;
  }
  SharedMesh mesh;
  ReferenceJob job;
};

std::vector<NaturalMode> lowest_of_all_classes(TipModes& tip, int count) {
  std::vector<NaturalMode> modes;
  for (const SymmetryClass symmetry : symmetry_classes)
    for (const NaturalMode& mode : tip.solve(symmetry, count)) modes.push_back(mode);
  std::ranges::stable_sort(modes, {}, &NaturalMode::frequency);
  modes.resize(std::size_t(count));
  return modes;
}

std::vector<double> frequencies(const std::vector<NaturalMode>& modes) {
  std::vector<double> result;
  for (const NaturalMode& mode : modes) result.push_back(mode.frequency);
  return result;
}

TEST(Eigenpairs, AreOrthonormalAndSatisfyRayleigh) {
  const Tip tip(0.25);
  const auto body = read_tip<3>(MPI_COMM_WORLD, tip.mesh.file(), 2, 0.0);
  body->number(tip_supports<3>());
  const auto pairs = solve(*body, tip.job.rubber, tip.job.volumetric, 8);
  LinearSystem stiffness(*body, false), mass(*body, false);
  HookeKernel<3> hooke(tip.job.rubber, tip.job.volumetric);
  MassKernel<3> inertia(tip.job.rubber.density);
  assemble(*body, hooke, body->fine.vector(), stiffness);
  assemble(*body, inertia, body->fine.vector(), mass);
  Vector force = body->fine.vector();
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      mass.matrix.vmult(force, pairs[j].shape);
      EXPECT_NEAR(force * pairs[i].shape, i == j ? 1.0 : 0.0, 1e-8) << i << " " << j;
      stiffness.matrix.vmult(force, pairs[j].shape);
      EXPECT_NEAR((force * pairs[i].shape) / pairs[i].eigenvalue, i == j ? 1.0 : 0.0, 1e-8)
          << i << " " << j;
    }
}

TEST(TipModes, OfFourSymmetryClassesAreThoseOfTheWholeTip) {
  constexpr int count = 12;
  const Tip quarter(0.25), whole(0.25, meshes::Sector::full);
  TipModes modes(quarter.job, quarter.mesh.file());
  const auto body = read_tip<3>(MPI_COMM_WORLD, whole.mesh.file(), 2, 0.0);
  body->number(tip_supports<3>());
  const auto merged = frequencies(lowest_of_all_classes(modes, count));
  EXPECT_LT(
      difference(merged, frequencies(solve(*body, whole.job.rubber, whole.job.volumetric, count))),
      1e-8);
}

TEST(TipModes, ComeInPairsExceptTheAxisymmetricOnes) {
  const Tip tip(0.35);
  TipModes modes(tip.job, tip.mesh.file());
  constexpr double mesh_splitting = 5e-3;
  const auto all = lowest_of_all_classes(modes, 16);
  int single = 0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (all[i].multiplicity == 1) {
      ++single;
      EXPECT_EQ(all[i].symmetry.x, all[i].symmetry.y) << i;
      continue;
    }
    const SymmetryClass partner{all[i].symmetry.y, all[i].symmetry.x};
    const bool even = all[i].symmetry.x == all[i].symmetry.y;
    const auto matches = [&](const NaturalMode& other) {
      return other.multiplicity == 2 &&
             (even ? other.symmetry != all[i].symmetry && other.symmetry.x == other.symmetry.y
                   : other.symmetry == partner) &&
             std::abs(other.frequency / all[i].frequency - 1.0) < (even ? mesh_splitting : 1e-6);
    };
    EXPECT_GE(std::ranges::count_if(all, matches), 1)
        << all[i].frequency << " " << name(all[i].symmetry);
  }
  EXPECT_GE(single, 3);  // torsion, stretching, torsion with a node
  EXPECT_LT(single, 8);
}

TEST(TipModes, ScaleWithStiffnessAndDensityAndSize) {
  const Tip tip(0.25);
  TipModes modes(tip.job, tip.mesh.file());
  const auto before = frequencies(modes.solve({}, 4));

  ReferenceJob other = tip.job;
  other.rubber.youngs_modulus *= 3.0, other.rubber.shear_modulus *= 3.0;
  other.rubber.density *= 0.5;
  TipModes stiffer(other, tip.mesh.file());
  for (const double f : before) ASSERT_GT(f, 0.0);
  auto after = frequencies(stiffer.solve({}, 4));
  for (double& f : after) f /= std::sqrt(6.0);
  EXPECT_LT(difference(before, after), 1e-8);

  meshes::Geometry twice;
  for (double* length :
       {&twice.tip_radius, &twice.rod_radius, &twice.sleeve_length, &twice.rod_length})
    *length *= 2.0;
  const SharedMesh large(0.25, meshes::Sector::quarter, twice);
  TipModes larger(tip.job, large.file());
  after = frequencies(larger.solve({}, 4));
  for (double& f : after) f *= 2.0;
  EXPECT_LT(difference(before, after), 1e-8);
}

struct Row {
  double frequency, error;
  std::string symmetry;
  int multiplicity;
};

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "mode,frequency [Hz],frequency_error [Hz],symmetry,multiplicity");
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::array<std::string, 5> cell;
    for (std::string& text : cell) std::getline(cells, text, ',');
    EXPECT_EQ(std::stoul(cell[0]), rows.size() + 1);
    rows.push_back({std::stod(cell[1]), std::stod(cell[2]), cell[3], std::stoi(cell[4])});
  }
  return rows;
}

TEST(ModesRun, WritesFrequenciesWithErrorsThatHold) {
  const SharedFolder folder;
  ReferenceJob job;
  job.analysis = Analysis::modes;
  job.modes = 8;
  job.refinement = 0.25;
  job.tolerance = 0.05;
  std::ostringstream progress;
  const RunOutcome outcome = run_modes(folder.path(), job, progress, [] { return false; });
  ASSERT_EQ(outcome.status, RunOutcome::Status::ok) << outcome.message;
  MPI_Barrier(MPI_COMM_WORLD);
  const std::vector<Row> rows = read_rows(folder / "modes.csv");
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fields" / "modes.pvd"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fields" / "mode_0008.vtu"));

  const SharedMesh fine(0.7);
  TipModes better(job, fine.file());
  const auto truth = lowest_of_all_classes(better, job.modes);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_LE(rows[i].error, 0.05 * rows[i].frequency) << i;
    EXPECT_LE(std::abs(rows[i].frequency - truth[i].frequency), rows[i].error) << i;
    EXPECT_EQ(rows[i].multiplicity, truth[i].multiplicity) << i;
  }
}

TEST(ModesRun, SaysWhenTheToleranceIsOutOfReach) {
  const SharedFolder folder;
  ReferenceJob job;
  job.analysis = Analysis::modes;
  job.modes = 2;
  job.refinement = 0.25;
  job.tolerance = 1e-5;
  job.max_unknowns = 25e3;
  job.write_fields = false;
  std::ostringstream progress;
  const RunOutcome outcome = run_modes(folder.path(), job, progress, [] { return false; });
  EXPECT_EQ(outcome.status, RunOutcome::Status::not_converged);
  MPI_Barrier(MPI_COMM_WORLD);
  EXPECT_EQ(read_rows(folder / "modes.csv").size(), 2U);  // what there is, is kept
}

}  // namespace
