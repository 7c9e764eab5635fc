#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "calculix.h"
#include "comparison.h"
#include "fem_program.h"
#include "meshes/volume_mesh.h"
#include "tests/temporary_folder.h"

namespace {

using namespace fingertip::benchmarks;
using fingertip::meshes::Geometry;
using fingertip::meshes::Vector3;

SolidMesh tip_mesh(double refinement, const TemporaryFolder& folder) {
  fingertip::meshes::write_tip_mesh(
      Geometry{}, fingertip::meshes::TipMeshOptions{}.refined(refinement), folder / "tip.msh");
  return read_solid_mesh(folder / "tip.msh");
}

TEST(SolidMeshTest, MidsideNodesLieOnTheRoundSurfaces) {
  const TemporaryFolder folder;
  const Geometry geometry;
  const SolidMesh linear = tip_mesh(0.5, folder), mesh = with_midside_nodes(linear);
  // A boundary node is one of an outer face; a flat midpoint would miss R by h²/8R, about 1e-3 R.
  std::size_t middles_outside = 0;
  for (std::size_t i = linear.nodes.size(); i < mesh.nodes.size(); ++i) {
    const double radius = Geometry::radial_distance(mesh.nodes[i]);
    EXPECT_GT(radius, geometry.rod_radius * (1.0 - 1e-12));
    EXPECT_LT(radius, geometry.tip_radius * (1.0 + 1e-12));
    if (std::abs(radius - geometry.tip_radius) < 1e-12) ++middles_outside;
  }
  // Faces over the whole outer surface form a disk: V - E + F = 1, and V + E is what lies on it.
  const auto faces = outer_faces(linear, geometry, -1.0);
  const auto corners = linear.nodes_where([&](const Vector3& w) {
    return std::abs(Geometry::radial_distance(w) - geometry.tip_radius) < 1e-12;
  });
  EXPECT_EQ(middles_outside, corners.size() + faces.size() - 1);
}

TEST(SolidMeshTest, ElementsAreRightHandedAndFillTheTip) {
  const TemporaryFolder folder;
  const SolidMesh mesh = tip_mesh(1.0, folder);
  double volume = 0.0;  // of the straight-sided elements, by tetrahedra to their centres
  static constexpr int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                      {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  for (const auto& element : mesh.elements) {
    Vector3 centre = Vector3::Zero();
    for (std::size_t i = 0; i < 8; ++i) centre += mesh.nodes[element[i]] / 8.0;
    for (const auto& face : faces)
      for (const int k : {1, 2}) {
        const Vector3 a = mesh.nodes[element[std::size_t(face[0])]] - centre;
        const Vector3 b = mesh.nodes[element[std::size_t(face[k])]] - centre;
        const Vector3 c = mesh.nodes[element[std::size_t(face[k + 1])]] - centre;
        EXPECT_GT(a.dot(b.cross(c)), 0.0);
        volume += a.dot(b.cross(c)) / 6.0;
      }
  }
  const double expected = Geometry{}.tip_volume() / 4.0;
  EXPECT_NEAR(volume, expected, 0.01 * expected);
}

TEST(SolidMeshTest, OtherFilesAreRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_solid_mesh(folder / "absent.msh"), std::runtime_error);
  write_text(folder / "old.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  EXPECT_THROW(read_solid_mesh(folder / "old.msh"), std::runtime_error);
  write_text(folder / "cut.msh",
             "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n");
  EXPECT_THROW(read_solid_mesh(folder / "cut.msh"), std::runtime_error);
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
  write_text(folder / "a.dat", "\n" + entry + "  1.0E+00 -2.0E+00  3.5E-01\n\n" + entry +
                                   "  1.0E+00 -2.0E+00  7.0E-01\n");
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
  std::vector<double> errors(const DeckOptions& options, double refinement) {
    const auto folder = folder_ / std::string(name(options.contact));
    const CalculixRun run =
        run_calculix(ccx_, refinement, truth_.depths, options, 1, 120.0, folder);
    EXPECT_TRUE(run.cost.finished) << read_text(folder / "log.txt");
    return relative_errors(run.forces, truth_);
  }

  const std::string ccx_ = "/usr/bin/ccx";
  const Truth truth_ = read_truth(FINGERTIP_TRUTH);
  TemporaryFolder folder_;
};

TEST_F(Programs, TwoContactsOfCalculixAndOurProgramPressAlike) {
  // Three per cent at the deeper half is what so coarse a mesh allows; a wrong unit, a lost
  // symmetry plane or large strain would show as 8 % and more.
  const auto surface =
      errors({Element::c3d20r, Contact::surface, Solver::iterative_scaling, 2e5, 0.02}, 0.5);
  const auto gap = errors({Element::c3d20, Contact::gap, Solver::spooles, 10.0, 0.0}, 0.5);
  const FemRun fem =
      run_fem(FINGERTIP_FEM_PROGRAM, 1.2e4, truth_.depths, 1, 120.0, folder_ / "fem");
  const auto own = relative_errors(fem.forces, truth_);
  EXPECT_GT(fem.unknowns, 1000u);
  ASSERT_EQ(surface.size(), truth_.depths.size());
  ASSERT_EQ(gap.size(), truth_.depths.size());
  ASSERT_EQ(own.size(), truth_.depths.size());
  for (std::size_t i = 5; i < truth_.depths.size(); ++i)
    for (const double error : {surface[i], gap[i], own[i]})
      EXPECT_LT(std::abs(error), 0.03) << truth_.depths[i];
}

}  // namespace
