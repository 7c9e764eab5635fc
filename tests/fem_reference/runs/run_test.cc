/// The program fingertip-fem on whole jobs.
#include "fem_reference/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "meshes/press/markers.h"
#include "meshes/tables/table_rows.h"
#include "tests/fem_reference/runs/fem_program.h"
#include "tests/fem_reference/runs/run_results.h"

using namespace fingertip;
using fem_reference::LinearSolver;
using fem_reference::ReferenceJob;
using meshes::ContactMode;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Three coarse meshes, two samples.
ReferenceJob small_job() {
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.press_to({5e-4, 1e-3});
  job.refinement = 0.3;
  job.tolerance = 0.5;
  return job;
}

std::size_t count_lines(const fs::path& file) {
  const std::string text = read_text(file);
  return std::size_t(std::ranges::count(text, '\n'));
}

std::size_t count_files(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), {}));
}

struct TableRow {
  double indentation, force, force_error, radius, pressure;  // cm, gf
};

std::vector<TableRow> reference_table() {
  std::istringstream in(read_text(fs::path(TEST_DATA) / "press_linear_frictionless.csv"));
  std::vector<TableRow> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || !std::isdigit(line[0])) continue;
    std::ranges::replace(line, ',', ' ');
    TableRow row{};
    std::istringstream(line) >> row.indentation >> row.force >> row.force_error >> row.radius >>
        row.pressure;
    rows.push_back(row);
  }
  return rows;
}

/// The default tolerance against two independent axisymmetric programs: the forces, their estimated
/// errors, which must cover the true ones without being idle, contact radius and pressure.
TEST(ReferenceRun, AgreesWithTheReferenceTable) {
  constexpr double gram_force = 9.80665e-3, centimetre = 1e-2;
  const std::vector<TableRow> table = reference_table();
  ASSERT_EQ(table.size(), 10u);
  const TemporaryFolder parent;
  ReferenceJob job;
  job.symmetry = fingertip::fem_reference::Symmetry::none;
  job.protocol.contact = ContactMode::frictionless;
  job.write_fields = false;
  for (const TableRow& row : table) job.protocol.samples.push_back(row.indentation * centimetre);
  const fs::path folder = run_folder(parent, "table", job);
  ASSERT_EQ(carry_out(folder), 0);
  const auto samples = samples_of(folder);
  ASSERT_EQ(samples.size(), table.size());
  std::vector<double> idleness;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const TableRow& row = table[i];
    const meshes::PressSample& sample = samples[i];
    SCOPED_TRACE(row.indentation);
    const double force = sample.normal_force / gram_force;
    const double estimate = sample.force_error / gram_force, error = std::abs(force - row.force);
    EXPECT_LE(error / row.force, row.indentation < 0.05 ? 0.005 : 0.002);
    EXPECT_LE(error, estimate + row.force_error);
    EXPECT_LE(estimate, job.tolerance * force);
    idleness.push_back(estimate / error);
    EXPECT_NEAR(sample.contact_radius / centimetre, row.radius, 0.002);
    const double pressure = sample.max_pressure / gram_force * centimetre * centimetre;
    EXPECT_NEAR(pressure / row.pressure, 1.0, 0.01);
  }
  std::ranges::sort(idleness);
  EXPECT_LE((idleness[4] + idleness[5]) / 2, 10.0);
}

/// A flat-ended cylinder, without friction, at large strain: three meshes are enough.
TEST(ReferenceRun, PressesAFlatPad) {
  using enum meshes::ProfileSurface;
  const TemporaryFolder parent;
  ReferenceJob job;
  job.geometry = meshes::Geometry::of_profile({{0.0, 0.01, contact},
                                               {0.01, 0.01, meshes::ProfileSurface::free},
                                               {0.01, 0.0, bond},
                                               {0.0, 0.0, axis}});
  job.strain = fem_reference::Strain::finite;
  job.protocol.contact = ContactMode::frictionless;
  job.press_to({1e-4, 5e-4, 1e-3});
  job.tolerance = 0.03;
  job.write_fields = false;
  const fs::path folder = run_folder(parent, "pad", job);
  ASSERT_EQ(carry_out(folder), 0);
  EXPECT_EQ(summary_of(folder).at("meshes").size(), 3u);
  const auto samples = samples_of(folder);
  ASSERT_EQ(samples.size(), 3u);
  for (const auto& sample : samples) {
    EXPECT_GT(sample.force_error, 0.0);
    EXPECT_LT(sample.force_error, job.tolerance * sample.normal_force);
    EXPECT_LT(sample.contact_radius_error, job.tolerance * sample.contact_radius);
    EXPECT_LT(sample.max_pressure_error, job.tolerance * sample.max_pressure);
  }
}

TEST(ReferenceRun, LeavesACompleteFolder) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.protocol.markers = {{0.0, -3e-3, 8e-3}, {0.0, 0.0, 10e-3}};
  const fs::path folder = run_folder(parent, "run", job);
  FemProgram program(folder, {folder.string()});
  ASSERT_EQ(program.wait(), 0);
  EXPECT_EQ(program.errors(), "");

  const auto samples = samples_of(folder);
  ASSERT_EQ(samples.size(), 2u);
  for (const auto& sample : samples) {
    EXPECT_GT(sample.normal_force, 0.0);
    EXPECT_GT(sample.contact_radius, 0.0);
    EXPECT_GT(sample.max_pressure, 0.0);
    EXPECT_GT(sample.force_error, 0.0);
    EXPECT_LT(sample.force_error, 0.5 * sample.normal_force);
    EXPECT_EQ(sample.lateral_force_x, 0.0);
    EXPECT_TRUE(std::isnan(sample.time));
  }
  const json summary = summary_of(folder);
  EXPECT_EQ(summary.at("status"), "ok");
  EXPECT_EQ(summary.at("contact"), "stick");
  EXPECT_EQ(summary.at("samples").size(), 2u);
  EXPECT_EQ(summary.at("meshes").size(), 3u);
  EXPECT_EQ(summary.at("ranks"), 1);
  EXPECT_LE(summary.at("worst_relative_error"), 0.5);
  EXPECT_GT(summary.at("mesh").at("min_jacobian"), 0.0);
  EXPECT_GT(summary.at("peak_memory"), 1e6);
  EXPECT_EQ(summary.at("samples")[1].at("normal_force"), samples[1].normal_force);
  for (const char* file :
       {"tip.msh", "fields/press_0001.vtu", "fields/press_0002.vtu", "fields/press.pvd"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  EXPECT_GT(count_lines(folder / "section.csv"), 50u);
  EXPECT_GT(count_lines(folder / "contact_field.csv"), 10u);
  EXPECT_EQ(count_lines(folder / "convergence.csv"), 1u + 3 * 2);
  EXPECT_FALSE(fs::exists(folder / "checkpoint"));
  const auto markers = meshes::read_rows<meshes::MarkerRow>(folder / "markers.csv");
  ASSERT_EQ(markers.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(markers[i].sample, int(i / 2 + 1));
    EXPECT_EQ(markers[i].marker, int(i % 2 + 1));
    EXPECT_EQ(markers[i].indentation, samples[i / 2].indentation);
    EXPECT_GT(markers[i].error, 0.0);
    EXPECT_LT(markers[i].error, 0.2 * markers[i].indentation);
  }
  // The rubber is pushed aside by the plane with which the pole goes.
  EXPECT_LT(markers[2].displacement.y(), 0.0);
  EXPECT_NEAR(markers[3].displacement.z(), -1e-3, 1e-6);

  std::istringstream progress(program.output());
  std::vector<json> lines;
  for (std::string line; std::getline(progress, line);) lines.push_back(json::parse(line));
  EXPECT_GT(lines.size(), 8u);
  for (const json& entry : lines) {
    EXPECT_LE(entry.at("done"), entry.at("total"));
    EXPECT_TRUE(entry.contains("stage") && entry.contains("message"));
  }
  // What it will take is told before the first mesh is assembled, and nothing is left at the end.
  EXPECT_EQ(lines[1].at("stage"), "assemble");
  EXPECT_GT(lines[1].at("left"), 0.0);
  const double told = lines[1].at("memory"), taken = summary.at("peak_memory");
  EXPECT_LT(std::max(told / taken, taken / told), 2.0) << told << " told, taken " << taken;
  const auto press = std::ranges::find(lines.rbegin(), lines.rend(), "press",
                                       [](const json& entry) { return entry.at("stage"); });
  EXPECT_EQ(press->at("left"), 0.0);
}

/// What `fingertip check` tells.
TEST(ReferenceRun, TellsItsCostFromItsFirstMesh) {
  const TemporaryFolder parent;
  const fs::path folder = run_folder(parent, "cost", small_job());
  FemProgram teller(folder, {"--cost", folder.string()});
  ASSERT_EQ(teller.wait(), 0);
  EXPECT_EQ(teller.errors(), "");
  const json told = json::parse(teller.output());
  EXPECT_EQ(count_files(folder), 2u);  // the job and its mesh
  ASSERT_EQ(carry_out(folder), 0);
  const json summary = summary_of(folder);
  EXPECT_NEAR(double(told.at("unknowns")) / double(summary.at("meshes")[0].at("dofs")), 1.0, 0.15);
  EXPECT_NEAR(std::log2(double(told.at("memory")) / double(summary.at("peak_memory"))), 0.0, 1.0);
  EXPECT_GT(told.at("time"), 0.0);
}

TEST(ReferenceRun, TellsNoCostOfAnotherAnalysis) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.analysis = fem_reference::Analysis::modes;
  const fs::path folder = run_folder(parent, "modes", job);
  FemProgram teller(folder, {"--cost", folder.string()});
  EXPECT_EQ(teller.wait(), 2);
  EXPECT_NE(teller.errors().find("static"), std::string::npos) << teller.errors();
  EXPECT_EQ(count_files(folder), 1u);
}

TEST(ReferenceRun, OneMeshIsEnoughWhenNoErrorIsWanted) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.estimate_error = false;
  job.write_fields = false;
  const fs::path folder = run_folder(parent, "run", job);
  ASSERT_EQ(carry_out(folder), 0);
  EXPECT_FALSE(fs::exists(folder / "fields"));
  EXPECT_EQ(summary_of(folder).at("meshes").size(), 1u);
  EXPECT_TRUE(std::isnan(samples_of(folder)[0].force_error));
}

/// Every combination of contact, strain and symmetry goes through the program.
TEST(ReferenceRun, CarriesOutTiltFrictionAndLargeStrain) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.estimate_error = false;
  job.write_fields = false;
  job.protocol.contact = ContactMode::coulomb;
  job.protocol.tilt = 0.2;
  job.protocol.lateral = 1e-4;
  job.strain = fem_reference::Strain::finite;
  job.refinement = 0.25;
  job.press_to({1e-4, 2e-4});
  const fs::path folder = run_folder(parent, "run", job);
  ASSERT_EQ(carry_out(folder), 0);
  const meshes::PressSample sample = samples_of(folder)[1];
  EXPECT_GT(sample.lateral_force_x, 0.0);
  EXPECT_LE(sample.lateral_force_x, job.protocol.friction * sample.normal_force);
  EXPECT_EQ(sample.lateral_force_y, 0.0);
  EXPECT_NE(sample.torque_y, 0.0);
  const json summary = summary_of(folder);
  EXPECT_EQ(summary.at("law"), "neo-hookean, logarithmic");
  EXPECT_LT(summary.at("samples")[1].at("min_jacobian"), 1.0);
}

/// At large strain a solid's samples cost most of the time: once a deep one is known well enough
/// finer meshes are pressed to those before it alone, and its fields stay.
TEST(ReferenceRun, PressesASolidNoDeeperThanItMust) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.protocol.contact = ContactMode::stick;
  job.strain = fem_reference::Strain::finite;
  job.tolerance = 0.04;
  job.press_to({5e-5, 1e-3});
  const fs::path folder = run_folder(parent, "run", job);
  ASSERT_EQ(carry_out(folder), 0);
  const json meshes = summary_of(folder).at("meshes");
  ASSERT_GT(meshes.size(), 3u);
  EXPECT_EQ(meshes[2].at("samples"), 2);
  EXPECT_EQ(meshes.back().at("samples"), 1);
  const auto samples = samples_of(folder);
  ASSERT_EQ(samples.size(), 2u);
  for (const meshes::PressSample& sample : samples)
    EXPECT_LE(sample.force_error, job.tolerance * sample.normal_force);
  EXPECT_EQ(count_files(folder / "fields"), 3u);  // and their series
}

/// Error bars of every row, in the order of time, at rest and in motion; to where nothing touches.
TEST(ReferenceRun, GoesThroughAProgramOfARubberThatRelaxes) {
  const TemporaryFolder parent;
  ReferenceJob job;
  job.press_to({5e-4, 1e-3});
  job.protocol.contact = ContactMode::frictionless;
  job.protocol.speed = 0.05;
  job.protocol.program = {{1e-3, 0.05, 0.0}, {1e-3, 0.0, 0.1}, {0.0, 0.05, 0.0}};
  job.rubber.relaxation = {{{0.3, 0.01}, {0.2, 0.1}}, false};
  job.refinement = 0.3;
  job.tolerance = 0.02;
  for (const auto analysis :
       {fem_reference::Analysis::static_press, fem_reference::Analysis::transient}) {
    job.analysis = analysis;
    const fs::path folder = run_folder(parent, std::string(name(analysis)), job);
    ASSERT_EQ(carry_out(folder), 0);
    const auto samples = samples_of(folder);
    ASSERT_EQ(samples.size(), 2U + 10U + 2U);
    EXPECT_EQ(samples[1].stage, 1.0);
    EXPECT_EQ(samples[2].stage, 2.0);
    EXPECT_EQ(samples.back().stage, 3.0);
    EXPECT_LT(samples[11].normal_force, 0.9 * samples[1].normal_force);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_GE(samples[i].force_error, 0.0) << i;
      // In motion what still shakes in a hold differs where steps are doubled.
      const bool shakes = analysis == fem_reference::Analysis::transient;
      EXPECT_LT(samples[i].force_error, (shakes ? 0.2 : 0.05) * samples[1].normal_force) << i;
    }
    // Nothing touches. In motion the tip swings on its bond: -0.0224 on meshes of any fineness.
    const bool swings = analysis == fem_reference::Analysis::transient;
    EXPECT_NEAR(samples.back().normal_force / samples[1].normal_force, swings ? -0.0224 : 0.0,
                2e-3);
    EXPECT_EQ(summary_of(folder).at("status"), "ok");
  }
}

TEST(ReferenceRun, KeepsItsSamplesWhenTheToleranceIsOutOfReach) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.tolerance = 1e-5;
  job.max_unknowns = 1e4;
  const fs::path folder = run_folder(parent, "run", job);
  FemProgram program(folder, {folder.string()});
  EXPECT_EQ(program.wait(), 3);
  EXPECT_NE(program.errors().find("reference.max_unknowns"), std::string::npos);
  EXPECT_EQ(samples_of(folder).size(), 2u);
  const json summary = summary_of(folder);
  EXPECT_EQ(summary.at("status"), "not converged");
  EXPECT_NE(std::string(summary.at("message")).find("reference.tolerance"), std::string::npos);
  for (const json& mesh : summary.at("meshes")) EXPECT_LE(mesh.at("dofs"), 1e4);
}

TEST(FingertipFem, RefusesABadJobAndWritesNothing) {
  const TemporaryFolder parent;
  const auto refuses = [&](const ReferenceJob& job, const std::string& key, int ranks = 1) {
    const fs::path folder = run_folder(parent, key, job);
    FemProgram program(folder, {folder.string()}, ranks);
    EXPECT_EQ(program.wait(), 2) << key;
    EXPECT_NE(program.errors().find(key), std::string::npos) << program.errors();
    EXPECT_EQ(count_files(folder), 1u) << key;
  };
  ReferenceJob job = small_job();
  job.geometry.rod_radius = 0.02;
  refuses(job, "geometry.rod_radius");
  job = small_job();
  job.strain = fem_reference::Strain::finite;
  job.rubber.shear_modulus = 0.6 * job.rubber.youngs_modulus;  // nu < 0
  refuses(job, "rubber");
  job = small_job();
  job.solver = LinearSolver::condensed;
  refuses(job, "reference.solver", 2);
}

TEST(FingertipFem, RefusesWhatIsNoFolder) {
  const TemporaryFolder parent;
  EXPECT_EQ(FemProgram(parent / "none", {}).wait(), 2);
  EXPECT_EQ(FemProgram(parent / "two", {"a", "b"}).wait(), 2);
  FemProgram without_job(parent / "empty", {parent.path().string()});
  EXPECT_EQ(without_job.wait(), 2);
  EXPECT_NE(without_job.errors().find("job.json"), std::string::npos);
  FemProgram help(parent / "help", {"--help"});
  EXPECT_EQ(help.wait(), 0);
  EXPECT_NE(help.errors().find("usage"), std::string::npos);
}

/// Alone it keeps nothing in the folder for temporary files: starts side by side would remove what
/// the others make there. So it does not notice that this one is none.
TEST(FingertipFem, SharesNoFolderWithOthers) {
  const TemporaryFolder parent;
  const fs::path folder = run_folder(parent, "job", small_job());
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  ::setenv("TMPDIR", (folder / "job.json").c_str(), 1);
  FemProgram program(folder, {folder.string()});
  before == nullptr ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", kept.c_str(), 1);
  EXPECT_EQ(program.wait(), 0) << program.errors();
}

/// The number of processes changes who computes, not what.
TEST(FingertipFem, TwoProcessesAgreeWithOne) {
  for (const auto& [contact, refinement] :
       {std::pair{ContactMode::frictionless, 0.5}, std::pair{ContactMode::stick, 0.3}}) {
    const TemporaryFolder parent;
    ReferenceJob job = small_job();
    job.protocol.contact = contact;
    job.refinement = refinement;
    job.solver = LinearSolver::multigrid;
    job.estimate_error = false;
    job.write_fields = false;
    const fs::path serial = run_folder(parent, "one", job),
                   on_two_ranks = run_folder(parent, "two", job);
    ASSERT_EQ(carry_out(serial), 0);
    ASSERT_EQ(carry_out(on_two_ranks, 2), 0);
    EXPECT_EQ(summary_of(on_two_ranks).at("ranks"), 2);
    for (std::size_t i = 0; i < job.protocol.samples.size(); ++i) {
      const auto a = samples_of(serial)[i], b = samples_of(on_two_ranks)[i];
      EXPECT_NEAR(b.normal_force / a.normal_force, 1.0, 1e-8);
      EXPECT_NEAR(b.max_pressure / a.max_pressure, 1.0, 1e-6);
      EXPECT_NEAR(b.contact_radius / a.contact_radius, 1.0, 1e-6);
    }
  }
}

/// Refinement, fields and sections on two processes: the same within the estimated error.
TEST(FingertipFem, TwoProcessesRefineAlike) {
  const TemporaryFolder parent;
  ReferenceJob job = small_job();
  job.protocol.contact = ContactMode::frictionless;
  const fs::path serial = run_folder(parent, "one", job),
                 on_two_ranks = run_folder(parent, "two", job);
  ASSERT_EQ(carry_out(serial), 0);
  ASSERT_EQ(carry_out(on_two_ranks, 2), 0);
  for (std::size_t i = 0; i < job.protocol.samples.size(); ++i) {
    const auto a = samples_of(serial)[i], b = samples_of(on_two_ranks)[i];
    EXPECT_NEAR(b.normal_force, a.normal_force, a.force_error);
  }
  EXPECT_EQ(summary_of(on_two_ranks).at("meshes")[1].at("cells"),
            summary_of(serial).at("meshes")[1].at("cells"));
  EXPECT_EQ(count_lines(on_two_ranks / "section.csv"), count_lines(serial / "section.csv"));
  EXPECT_TRUE(fs::exists(on_two_ranks / "fields/press_0002.vtu"));
}

}  // namespace
