#include "fem_reference/job.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::LinearSolver;
using fem_reference::read_job;
using fem_reference::ReferenceJob;

namespace {

/// The violations of a job file, joined.
std::string refusal(const std::filesystem::path& file, const std::string& text) {
  write_text(file, text);
  try {
    read_job(file);
  } catch (const meshes::InvalidInput& error) {
    std::string all;
    for (const auto& violation : error.violations()) all += to_string(violation) + "\n";
    return all;
  }
  return "accepted";
}

TEST(ReferenceJob, SurvivesTheFile) {
  const TemporaryFolder folder;
  ReferenceJob job;
  job.geometry = {0.02, 0.012, 0.0, 0.05};
  job.rubber = {5000.0, 2000.0 / 3.0 * 3.1, 900.0, 1e-3};
  job.contact = meshes::ContactMode::frictionless;
  job.samples = {1e-4, 1.0 / 3000.0, 2e-3};
  job.degree = 1;
  job.refinement = 0.7;
  job.tolerance = 1e-9;
  job.solver = LinearSolver::multigrid;
  job.write_fields = false;
  job.estimate_error = false;
  write_job(job, folder / "job.json");
  const ReferenceJob read = read_job(folder / "job.json");
  EXPECT_EQ(read.geometry.tip_radius, job.geometry.tip_radius);
  EXPECT_EQ(read.geometry.rod_radius, job.geometry.rod_radius);
  EXPECT_EQ(read.geometry.sleeve_length, job.geometry.sleeve_length);
  EXPECT_EQ(read.geometry.rod_length, job.geometry.rod_length);
  EXPECT_EQ(read.rubber.youngs_modulus, job.rubber.youngs_modulus);
  EXPECT_EQ(read.rubber.shear_modulus, job.rubber.shear_modulus);
  EXPECT_EQ(read.rubber.density, job.rubber.density);
  EXPECT_EQ(read.rubber.retardation_time, job.rubber.retardation_time);
  EXPECT_EQ(read.contact, job.contact);
  EXPECT_EQ(read.samples, job.samples);  // to the last bit
  EXPECT_EQ(read.degree, job.degree);
  EXPECT_EQ(read.refinement, job.refinement);
  EXPECT_EQ(read.tolerance, job.tolerance);
  EXPECT_EQ(read.solver, job.solver);
  EXPECT_EQ(read.write_fields, job.write_fields);
  EXPECT_EQ(read.estimate_error, job.estimate_error);
}

TEST(ReferenceJob, AbsentEntriesKeepTheirDefaults) {
  const TemporaryFolder folder;
  write_text(folder / "job.json", R"({"samples": [0.001]})");
  const ReferenceJob job = read_job(folder / "job.json");
  EXPECT_EQ(job.degree, 2);
  EXPECT_EQ(job.contact, meshes::ContactMode::stick);
  EXPECT_EQ(job.geometry.tip_radius, meshes::Geometry{}.tip_radius);
}

TEST(ReferenceJob, RefusesBadFilesNamingTheEntry) {
  const TemporaryFolder folder;
  const auto file = folder / "job.json";
  EXPECT_NE(refusal(file, R"({"samples": [0.001], "degre": 2})").find("degre"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": "deep"})").find("samples"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": [0.001], "contact": "glue"})").find("frictionless"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": [0.001], "degree": 1.5})").find("integer"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": [0.001], "rubber": 7})").find("rubber"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": [0.001)").find("JSON"), std::string::npos);
  EXPECT_NE(refusal(file, "[1, 2]").find("object"), std::string::npos);
  std::filesystem::remove(file);
  EXPECT_THROW(read_job(file), meshes::InvalidInput);
}

TEST(ReferenceJob, RefusesValuesOutOfRange) {
  const auto rejects = [](auto&& spoil, const std::string& key) {
    ReferenceJob job;
    job.samples = {1e-3};
    EXPECT_TRUE(job.violations().empty());
    spoil(job);
    const auto broken = job.violations();
    EXPECT_TRUE(std::ranges::any_of(broken, [&](const auto& violation) {
      return violation.key == key;
    })) << key;
  };
  rejects([](ReferenceJob& job) { job.samples.clear(); }, "press.depth");
  rejects([](ReferenceJob& job) { job.samples = {2e-3, 1e-3}; }, "press.samples");
  rejects([](ReferenceJob& job) { job.samples = {5e-3}; }, "press.depth");
  rejects([](ReferenceJob& job) { job.degree = 3; }, "reference.degree");
  rejects([](ReferenceJob& job) { job.refinement = 0.1; }, "reference.refinement");
  rejects([](ReferenceJob& job) { job.refinement = std::nan(""); }, "reference.refinement");
  rejects([](ReferenceJob& job) { job.tolerance = 0.0; }, "reference.tolerance");
  rejects([](ReferenceJob& job) { job.geometry.rod_radius = 0.02; }, "geometry.rod_radius");
  rejects([](ReferenceJob& job) { job.rubber.shear_modulus = 1000; }, "rubber.shear_modulus");
}

}  // namespace
