#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>

#include "calculix.h"
#include "comparison.h"
#include "fem_program.h"
#include "meshes/press/fields.h"
#include "meshes/tables/fields_json.h"
#include "meshes/volume_mesh/volume_mesh.h"
#include "tests/temporary_folder.h"

namespace {

using namespace fingertip::benchmarks;
using fingertip::meshes::Geometry;
using fingertip::meshes::Vector3;

fingertip::meshes::TipMeshOptions meridian(double refinement) {
  auto options = fingertip::meshes::TipMeshOptions{}.refined(refinement);
  options.sector = fingertip::meshes::Sector::meridian;
  return options;
}

MeridianMesh tip_mesh(double refinement, const TemporaryFolder& folder) {
  fingertip::meshes::write_tip_mesh(Geometry{}, meridian(refinement), folder / "tip.msh");
  return read_meridian_mesh(folder / "tip.msh");
}

TEST(MeridianMeshTest, MidsideNodesLieOnTheRoundSurfaces) {
  const TemporaryFolder folder;
  const Geometry geometry;
  const MeridianMesh linear = tip_mesh(0.5, folder), mesh = with_midside_nodes(linear);
  // A boundary node is one of an outer edge; a flat midpoint would miss R by h²/8R, about 1e-3 R.
  std::size_t middles_outside = 0;
  for (std::size_t i = linear.nodes.size(); i < mesh.nodes.size(); ++i) {
    const double radius = distance_from_core(mesh.nodes[i]);
    EXPECT_GT(radius, geometry.rod_radius * (1.0 - 1e-12));
    EXPECT_LT(radius, geometry.tip_radius * (1.0 + 1e-12));
    if (std::abs(radius - geometry.tip_radius) < 1e-12) ++middles_outside;
  }
  // Edges along the whole outer surface form one line: a corner more than edges.
  const auto edges = outer_edges(linear, geometry, -1.0);
  const auto corners = linear.nodes_where([&](const MeridianPoint& point) {
    return std::abs(distance_from_core(point) - geometry.tip_radius) < 1e-12;
  });
  EXPECT_EQ(edges.size() + 1, corners.size());
  EXPECT_EQ(middles_outside, edges.size());
  EXPECT_LT(outer_edges(linear, geometry, 0.5 * geometry.tip_radius).size(), edges.size());
}

TEST(MeridianMeshTest, ElementsAreCounterClockwiseAndSweepTheTip) {
  const TemporaryFolder folder;
  const MeridianMesh mesh = tip_mesh(1.0, folder);
  double volume = 0.0;  // of the straight-sided elements, by triangles to their first corners
  for (const auto& element : mesh.elements)
    for (const std::size_t k : {1, 2}) {
      const MeridianPoint &a = mesh.nodes[element[0]], &b = mesh.nodes[element[k]],
                          &c = mesh.nodes[element[k + 1]];
      const MeridianPoint ab = b - a, ac = c - a;
      const double area = (ab.x() * ac.y() - ab.y() * ac.x()) / 2.0;
      EXPECT_GT(area, 0.0);
      volume += area * 2.0 * std::numbers::pi * (a.x() + b.x() + c.x()) / 3.0;  // Pappus
    }
  const double expected = Geometry{}.tip_volume();
  EXPECT_NEAR(volume, expected, 0.01 * expected);
}

TEST(MeridianMeshTest, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_meridian_mesh(folder / "absent.msh"), std::runtime_error);
  write_text(folder / "old.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  EXPECT_THROW(read_meridian_mesh(folder / "old.msh"), std::runtime_error);
  write_text(folder / "cut.msh",
             "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n");
  EXPECT_THROW(read_meridian_mesh(folder / "cut.msh"), std::runtime_error);
}

TEST(TimeToError, InterpolatesAPowerLawExactly) {
  // time = 2 s (1 %/error)^1.5
  std::vector<ErrorAndTime> runs;
  for (const double error : {0.08, 0.03, 0.004})
    runs.push_back({error, 2.0 * std::pow(0.01 / error, 1.5)});
  const auto time = time_to_error(runs, 0.01);
  ASSERT_TRUE(time);
  EXPECT_NEAR(time->seconds, 2.0, 1e-12);
  EXPECT_FALSE(time->at_most);
}

TEST(TimeToError, RunsThatAnotherBeatsDoNotCount) {
  const std::vector<ErrorAndTime> clean{{0.04, 1.0}, {0.005, 8.0}};
  std::vector<ErrorAndTime> spoilt = clean;
  spoilt.push_back({0.05, 2.0});   // slower and worse than the first
  spoilt.push_back({0.005, 9.0});  // no better than the second
  EXPECT_EQ(envelope(spoilt).size(), 2u);
  EXPECT_DOUBLE_EQ(time_to_error(spoilt, 0.01)->seconds, time_to_error(clean, 0.01)->seconds);
}

TEST(TimeToError, SaysWhenItIsABoundOrUnknown) {
  const std::vector<ErrorAndTime> runs{{0.04, 1.0}, {0.005, 8.0}};
  EXPECT_FALSE(time_to_error(runs, 0.004));
  EXPECT_FALSE(time_to_error({}, 0.01));
  const auto loose = time_to_error(runs, 0.1);
  ASSERT_TRUE(loose);
  EXPECT_TRUE(loose->at_most);
  EXPECT_DOUBLE_EQ(loose->seconds, 1.0);
  EXPECT_DOUBLE_EQ(time_to_error(runs, 0.005)->seconds, 8.0);
}

TEST(Errors, NeedEveryDepth) {
  const Truth truth{{1.0, 2.0}, {10.0, 20.0}};
  const auto errors = relative_errors({11.0, 19.0}, truth);
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_NEAR(errors[0], 0.1, 1e-15);
  EXPECT_NEAR(errors[1], -0.05, 1e-15);
  EXPECT_TRUE(relative_errors({11.0}, truth).empty());
  Measurement run;
  EXPECT_FALSE(run.worst_error());
  run.errors = {0.01, -0.05};
  EXPECT_DOUBLE_EQ(*run.worst_error(), 0.05);
}

TEST(Errors, TheKnownCurveIsReadInSI) {
  const Truth truth = read_truth(FINGERTIP_TRUTH);
  ASSERT_EQ(truth.depths.size(), 10u);
  EXPECT_DOUBLE_EQ(truth.depths.back(), 0.003);
  EXPECT_NEAR(truth.forces.back(), 19.42179 * 9.80665e-3, 1e-12);
  const TemporaryFolder folder;
  write_text(folder / "other.csv", "depth,force\n1,2\n");
  EXPECT_THROW(read_truth(folder / "other.csv"), std::runtime_error);
}

TEST(ChildProcess, ReportsExitCodeCostAndOutput) {
  const TemporaryFolder folder;
  const std::string work = "i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done; pwd; echo $WORD";
  const Cost cost =
      run_child({"/bin/sh", "-c", work}, folder.path(), {"WORD=rubber"}, 60.0, folder / "log.txt");
  EXPECT_TRUE(cost.finished);
  EXPECT_GT(cost.cpu_seconds, 0.0);
  EXPECT_LE(cost.cpu_seconds, 1.1 * cost.wall_seconds + 0.02);  // one thread
  EXPECT_GT(cost.peak_memory, 100000u);
  EXPECT_EQ(read_text(folder / "log.txt"), folder.path().string() + "\nrubber\n");

  const Cost failed =
      run_child({"/bin/sh", "-c", "exit 3"}, folder.path(), {}, 60.0, folder / "log.txt");
  EXPECT_EQ(failed.exit_code, 3);
  EXPECT_FALSE(failed.finished);
  EXPECT_THROW(run_child({"/no/such/program"}, folder.path(), {}, 60.0, folder / "log.txt"),
               std::runtime_error);
}

TEST(ChildProcess, IsEndedAtTheLimit) {
  const TemporaryFolder folder;
  const Cost cost = run_child({"/bin/sleep", "30"}, folder.path(), {}, 0.2, folder / "log.txt");
  EXPECT_TRUE(cost.timed_out);
  EXPECT_FALSE(cost.finished);
  EXPECT_GE(cost.wall_seconds, 0.2);
  EXPECT_LT(cost.wall_seconds, 20.0);
}

TEST(CalculixOutput, ForcesAndIterationsAreRead) {
  const TemporaryFolder folder;
  const std::string entry = " total force (fx,fy,fz) for set BOND and time  0.1000000E+01\n\n";
  write_text(folder / "a.dat", "\n" + entry + "  1.0E+00  3.5E-01 -2.0E+00\n\n" + entry +
                                   "  1.0E+00  7.0E-01 -2.0E+00\n");
  EXPECT_EQ(read_total_forces(folder / "a.dat"), (std::vector{0.35, 0.7}));
  write_text(folder / "cut.dat", entry + "  1.0E+00");
  EXPECT_THROW(read_total_forces(folder / "cut.dat"), std::runtime_error);
  write_text(folder / "a.sta",
             "SUMMARY OF JOB INFORMATION\n  STEP INC ATT ITRS TOT TIME\n"
             " 1 1 1U 10 0.0 0.0 1.0\n 1 1 2 4 0.5 0.5 0.5\n");
  EXPECT_EQ(read_iterations(folder / "a.sta"), 14);
}

/// The programs themselves, where CalculiX is installed.
class Programs : public testing::Test {
 protected:
  void SetUp() override {
    if (::access(ccx_.c_str(), X_OK) != 0)
      GTEST_SKIP() << ccx_ << " is not installed (Debian package calculix-ccx)";
  }
  /// Both programs against the known curve or, at large strain, each other.
  void press_alike(Problem problem, double tolerance = 0.005) {
    const FemRun fem = run_fem(FINGERTIP_FEM_PROGRAM, problem, {.tolerance = 1e-3}, truth_.depths,
                               120.0, folder_ / "fem");
    ASSERT_EQ(fem.forces.size(), truth_.depths.size());
    EXPECT_GT(fem.unknowns, 1000u);
    if (problem != Problem::small_strain) truth_.forces = fem.forces;
    // A moderate mesh; thinner elements at the surface may diverge at large strain.
    auto mesh = meridian(2.0);
    mesh.radial_elements = mesh.sleeve_elements = 4;
    mesh.cap_grading = 4.0;
    const CalculixRun run = run_calculix(ccx_, problem, mesh, truth_.depths,
                                         {Element::cax8r, Contact::node, Solver::spooles, 1e7, 0.0},
                                         240.0, folder_ / "calculix");
    ASSERT_TRUE(run.cost.finished) << read_text(folder_ / "calculix/log.txt");
    EXPECT_GT(run.iterations, 10);
    for (const auto& forces : {fem.forces, run.forces}) {
      const auto errors = relative_errors(forces, truth_);
      ASSERT_EQ(errors.size(), truth_.depths.size());
      for (std::size_t i = 0; i < errors.size(); ++i)
        EXPECT_LT(std::abs(errors[i]), tolerance) << truth_.depths[i];
    }
  }

  /// A cylinder, 50 mm wide and 30 mm high, between plates that hold its ends, to 14 % of its
  /// height. Its rims are singular: elements of displacements alone are too stiff there, by half as
  /// much with every halving towards them.
  void press_cylinders_alike(Problem problem) {
    using enum fingertip::meshes::ProfileSurface;
    const double radius = 0.025, height = 0.03;
    const std::vector<double> depths = {0.0006, 0.0012, 0.0018, 0.0024, 0.003, 0.0036, 0.0042};
    const auto rubber = rubber_of(problem);
    const auto cylinder = Geometry::of_profile(
        {{radius, 0.0, free}, {radius, height, contact}, {0.0, height, axis}, {0.0, 0.0, bond}});
    const nlohmann::json job{
        {"geometry", fingertip::meshes::json_of<nlohmann::json>(cylinder)},
        {"protocol", {{"contact", "stick"}, {"depth", depths.back()}, {"samples", depths}}},
        {"strain", "finite"},
        {"rubber", fingertip::meshes::json_of<nlohmann::json>(rubber)},
        {"symmetry", "axisymmetric"},
        {"tolerance", 1e-3},
        {"write_fields", false}};
    const FemRun fem = run_fem_job(FINGERTIP_FEM_PROGRAM, job, 300.0, folder_ / "fem");
    ASSERT_EQ(fem.forces.size(), depths.size()) << read_text(folder_ / "fem/output.txt");
    std::filesystem::create_directories(folder_ / "calculix");
    write_cylinder_deck(cylinder_mesh(radius, height, 12, 14, 4), height, rubber, problem, depths,
                        {Element::cax8}, folder_ / "calculix/press.inp");
    const CalculixRun run = run_deck(ccx_, 300.0, folder_ / "calculix");
    ASSERT_EQ(run.forces.size(), depths.size()) << read_text(folder_ / "calculix/log.txt");
    for (std::size_t i = 0; i < depths.size(); ++i)
      EXPECT_NEAR(fem.forces[i] / run.forces[i], 1.0, 0.003) << depths[i];
  }

  const std::string ccx_ = "/usr/bin/ccx";
  Truth truth_ = read_truth(FINGERTIP_TRUTH);
  TemporaryFolder folder_;
};

TEST_F(Programs, CalculixPrintsTheForceOnATwoDegreeSector) {
  // A cylinder of one element, 10 mm in radius and 20 mm high, E = 1000 kPa, 1 % shorter: E A/100.
  write_text(folder_ / "bar.inp",
             "*NODE\n1, 0, 0\n2, 10, 0\n3, 10, 20\n4, 0, 20\n5, 5, 0\n6, 10, 10\n7, 5, 20\n"
             "8, 0, 10\n*ELEMENT, TYPE=CAX8R, ELSET=BAR\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
             "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BAR, MATERIAL=M\n"
             "*NSET, NSET=FOOT\n1, 2, 5\n*NSET, NSET=HEAD\n3, 4, 7\n*NSET, NSET=AXIS\n1, 4, 8\n"
             "*BOUNDARY\nFOOT, 2\nAXIS, 1\n*STEP\n*STATIC\n*BOUNDARY\nHEAD, 2, 2, -0.2\n"
             "*NODE PRINT, NSET=FOOT, TOTALS=ONLY\nRF\n*END STEP\n");
  const Cost cost = run_child({ccx_, "-i", "bar"}, folder_.path(), {}, 60.0, folder_ / "log.txt");
  ASSERT_TRUE(cost.finished);
  const auto forces = read_total_forces(folder_ / "bar.dat");
  ASSERT_EQ(forces.size(), 1u);
  const double expected = 1000.0 * std::numbers::pi * 100.0 * 0.01;
  EXPECT_NEAR(sectors * forces[0], expected, 1e-5 * expected);
}

TEST_F(Programs, SmallStrainPressIsTheKnownOne) {
  press_alike(Problem::small_strain);
}
TEST_F(Programs, LawAPressesAlike) {
  press_alike(Problem::law_a);
}
TEST_F(Programs, LawCPressesAlike) {
  press_alike(Problem::law_c);
}
TEST_F(Programs, YeohPressesAlike) {
  press_alike(Problem::yeoh, 0.003);
}
TEST_F(Programs, MooneyAndRivlinPressAlike) {
  press_alike(Problem::mooney_rivlin, 0.003);
}
TEST_F(Programs, OgdenPressesAlike) {
  press_alike(Problem::ogden, 0.003);
}

TEST_F(Programs, YeohPressesAStuckCylinderAlike) {
  press_cylinders_alike(Problem::yeoh);
}
TEST_F(Programs, MooneyAndRivlinPressAStuckCylinderAlike) {
  press_cylinders_alike(Problem::mooney_rivlin);
}
TEST_F(Programs, OgdenPressesAStuckCylinderAlike) {
  press_cylinders_alike(Problem::ogden);
}

}  // namespace
