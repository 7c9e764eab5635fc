#include "fem_reference/run.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "fem_reference/job.h"
#include "meshes/errors.h"
#include "meshes/press_response.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::RunOutcome;
using nlohmann::json;

namespace {

fem_reference::ReferenceJob small_job() {
  fem_reference::ReferenceJob job;
  job.samples = {5e-4, 1e-3};
  job.refinement = 0.5;
  job.degree = 1;
  return job;
}

json read_json(const std::filesystem::path& file) {
  return json::parse(std::ifstream(file));
}

std::size_t count_lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::size_t lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  return lines;
}

struct TableRow {
  double indentation, force, force_error, radius, pressure;  // cm, gf
};

std::vector<TableRow> reference_table() {
  std::ifstream in(std::string(TEST_DATA) + "/press_linear_frictionless.csv");
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

/// The default mesh against two independent axisymmetric programs.
TEST(ReferenceRun, AgreesWithTheReferenceTable) {
  constexpr double gram_force = 9.80665e-3, centimetre = 1e-2;
  const std::vector<TableRow> table = reference_table();
  ASSERT_EQ(table.size(), 10u);
  const TemporaryFolder folder;
  fem_reference::ReferenceJob job;
  job.contact = meshes::ContactMode::frictionless;
  job.write_fields = false;
  for (const TableRow& row : table) job.samples.push_back(row.indentation * centimetre);
  write_job(job, folder / "job.json");
  std::stringstream progress;
  ASSERT_EQ(fem_reference::run_job(folder.path(), progress, {}).status, RunOutcome::Status::ok);

  const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
  const json summary = read_json(folder / "summary.json");
  ASSERT_EQ(response.samples().size(), table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    const TableRow& row = table[i];
    const meshes::PressSample& sample = response.samples()[i];
    SCOPED_TRACE(row.indentation);
    const double force = sample.normal_force / gram_force;
    EXPECT_NEAR(force / row.force, 1.0, row.indentation < 0.05 ? 0.03 : 0.01);
    EXPECT_LE(std::abs(force - row.force), sample.force_error / gram_force);
    const double spacing = summary.at("samples")[i].at("node_spacing");
    EXPECT_NEAR(sample.contact_radius / centimetre, row.radius, spacing / centimetre);
    EXPECT_LT(spacing, 0.25 * sample.contact_radius);
    const double pressure = sample.max_pressure / gram_force * centimetre * centimetre;
    EXPECT_NEAR(pressure / row.pressure, 1.0, 0.03);
  }
}

TEST(ReferenceRun, LeavesACompleteFolder) {
  const TemporaryFolder folder;
  write_job(small_job(), folder / "job.json");
  std::stringstream progress;
  const RunOutcome outcome = fem_reference::run_job(folder.path(), progress, {});
  EXPECT_EQ(outcome.status, RunOutcome::Status::ok);

  const auto response = meshes::PressResponse::read_csv(folder / "response.csv");
  ASSERT_EQ(response.samples().size(), 2u);
  for (const auto& sample : response.samples()) {
    EXPECT_GT(sample.normal_force, 0.0);
    EXPECT_GT(sample.contact_radius, 0.0);
    EXPECT_GT(sample.max_pressure, 0.0);
    EXPECT_GT(sample.force_error, 0.0);
    EXPECT_LT(sample.force_error, 0.2 * sample.normal_force);
    EXPECT_EQ(sample.lateral_force_x, 0.0);
    EXPECT_TRUE(std::isnan(sample.time));
  }
  const json summary = read_json(folder / "summary.json");
  EXPECT_EQ(summary.at("status"), "ok");
  EXPECT_EQ(summary.at("contact"), "stick");
  EXPECT_EQ(summary.at("samples").size(), 2u);
  EXPECT_GT(summary.at("mesh").at("min_jacobian"), 0.0);
  ASSERT_EQ(summary.at("error_meshes").size(), 2u);
  EXPECT_GT(summary.at("error_meshes")[0].at("hexahedra"), 0);
  EXPECT_GT(summary.at("peak_memory"), 1e6);
  EXPECT_TRUE(exists(folder / "tip.msh"));
  EXPECT_TRUE(exists(folder / "fields/press_0001.vtu"));
  EXPECT_TRUE(exists(folder / "fields/press_0002.vtu"));
  EXPECT_TRUE(exists(folder / "fields/press.pvd"));
  EXPECT_GT(count_lines(folder / "section.csv"), 50u);
  EXPECT_GT(count_lines(folder / "pressure.csv"), 10u);

  std::size_t lines = 0;
  for (std::string line; std::getline(progress, line); ++lines) {
    const json entry = json::parse(line);
    EXPECT_LE(entry.at("done"), entry.at("total"));
    EXPECT_TRUE(entry.contains("stage") && entry.contains("message"));
  }
  EXPECT_GT(lines, 5u);
}

TEST(ReferenceRun, KeepsWhatWasFinishedWhenStopped) {
  const TemporaryFolder folder;
  write_job(small_job(), folder / "job.json");
  std::stringstream progress;
  const auto first_sample_is_written = [&] { return exists(folder / "response.csv"); };
  const RunOutcome outcome =
      fem_reference::run_job(folder.path(), progress, first_sample_is_written);
  EXPECT_EQ(outcome.status, RunOutcome::Status::interrupted);
  EXPECT_EQ(meshes::PressResponse::read_csv(folder / "response.csv").samples().size(), 1u);
  EXPECT_EQ(read_json(folder / "summary.json").at("status"), "interrupted");
}

TEST(ReferenceRun, RefusesABadJobAndWritesNothing) {
  const TemporaryFolder folder;
  auto job = small_job();
  job.geometry.rod_radius = 0.02;
  write_job(job, folder / "job.json");
  std::stringstream progress;
  EXPECT_THROW(fem_reference::run_job(folder.path(), progress, {}), meshes::InvalidInput);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

int exit_code(const std::string& arguments) {
  const std::string command =
      std::string(FINGERTIP_FEM_PROGRAM) + " " + arguments + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(FingertipFem, TellsItsOutcomeByTheExitCode) {
  const TemporaryFolder folder;
  EXPECT_EQ(exit_code(""), 2);
  EXPECT_EQ(exit_code(folder.path().string()), 2);  // no job
  auto job = small_job();
  job.estimate_error = false;
  job.write_fields = false;
  write_job(job, folder / "job.json");
  EXPECT_EQ(exit_code(folder.path().string()), 0);
  EXPECT_FALSE(exists(folder / "fields"));
  EXPECT_FALSE(read_json(folder / "summary.json").contains("error_meshes"));
}

}  // namespace
