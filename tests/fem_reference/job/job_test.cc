#include "fem_reference/job/job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshes/tables/fields_json.h"
#include "tests/fingers.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::Analysis;
using fem_reference::LinearSolver;
using fem_reference::read_job;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using fem_reference::Volumetric;
using meshes::VolumetricLaw;
using Json = nlohmann::json;

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
  job.rubber = {5000.0,
                2000.0 / 3.0 * 3.1,
                900.0,
                1e-3,
                {meshes::RubberLaw::ogden, VolumetricLaw::quadratic, {0.75, 1.3, 0.25, 4.0}},
                {{{0.3, 0.01}, {0.2, 2.0}}, false}};
  job.protocol.contact = meshes::ContactMode::coulomb;
  job.protocol.friction = 0.3;
  job.protocol.tilt = -0.2;
  job.protocol.lateral = 1e-3;
  job.protocol.lateral_path = meshes::LateralPath::after;
  job.protocol.lateral_samples = 3;
  job.press_to({1e-4, 1.0 / 3000.0, 2e-3});
  job.protocol.speed = 0.02;
  job.protocol.mode = meshes::DriveMode::equilibrium;
  job.protocol.clearance = 1e-3;
  job.protocol.markers = {{0.001 / 3.0, -2e-3, 0.0151}, {0.0, 0.0, 0.02}};
  job.analysis = Analysis::verification;
  job.strain = Strain::finite;
  job.rubber.energy.volumetric = VolumetricLaw::isochoric_logarithmic;
  job.symmetry = fem_reference::Symmetry::none;
  job.modes = 17;
  job.degree = 3;
  job.volumetric = Volumetric::pointwise;
  job.refinement = 0.7;
  job.tolerance = 1.0 / 300.0;
  job.max_unknowns = 123456;
  job.solver = LinearSolver::multigrid;
  job.solver_tolerance = 3e-12;
  job.write_fields = false;
  job.field_sectors = 12;
  job.estimate_error = false;
  write_job(job, folder / "job.json");
  const ReferenceJob read = read_job(folder / "job.json");
  const Json written = meshes::json_of<Json>(job);
  EXPECT_EQ(meshes::json_of<Json>(read), written);  // to the last bit
  const Json usual = meshes::json_of<Json>(ReferenceJob()).flatten(), tried = written.flatten();
  for (const auto& [place, value] : tried.items())
    EXPECT_FALSE(usual.contains(place) && usual[place] == value) << place << " is not tried";
}

TEST(ReferenceJob, EveryNameSurvivesTheFile) {
  const TemporaryFolder folder;
  ReferenceJob job;
  job.press_to({1e-3});
  const auto survives = [&](auto member) {
    const auto usual = job.*member;
    for (const auto value : values(usual)) {
      job.*member = value;
      write_job(job, folder / "job.json");
      EXPECT_EQ(read_job(folder / "job.json").*member, value);
    }
    job.*member = usual;
  };
  survives(&ReferenceJob::analysis);
  survives(&ReferenceJob::strain);
  survives(&ReferenceJob::symmetry);
  survives(&ReferenceJob::solver);
  survives(&ReferenceJob::volumetric);
  for (const auto contact : values(meshes::ContactMode())) {
    job.protocol.contact = contact;
    write_job(job, folder / "job.json");
    EXPECT_EQ(read_job(folder / "job.json").protocol.contact, contact);
  }
}

TEST(ReferenceJob, AbsentEntriesKeepTheirDefaults) {
  const TemporaryFolder folder;
  write_text(folder / "job.json", R"({"protocol": {"samples": [0.001], "depth": 0.001}})");
  const ReferenceJob job = read_job(folder / "job.json");
  EXPECT_EQ(job.degree, 2);
  EXPECT_EQ(job.protocol.contact, meshes::ContactMode::stick);
  EXPECT_EQ(job.geometry.tip_radius, meshes::Geometry{}.tip_radius);
}

TEST(ReferenceJob, RefusesBadFilesNamingTheEntry) {
  const TemporaryFolder folder;
  const auto file = folder / "job.json";
  EXPECT_NE(refusal(file, R"({"protocol": {"samples": [0.001], "deph": 1}})").find("protocol.deph"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"protocol": {"samples": "deep"}})").find("samples"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"protocol": {"markers": [[0, 0.009]]}})").find("protocol.markers"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"protocol": {"contact": "glue"}})").find("frictionless"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"rubber": {"energy": {"law": "D"}}})").find("yeoh"),
            std::string::npos);
  EXPECT_NE(refusal(file, R"({"degree": 2, "analysis": "fast"})").find("modes"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"degree": 1.5})").find("integer"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"degree": 2, "rubber": 7})").find("rubber"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"samples": [0.001)").find("JSON"), std::string::npos);
  EXPECT_NE(refusal(file, "[1, 2]").find("object"), std::string::npos);
  std::filesystem::remove(file);
  EXPECT_THROW(read_job(file), meshes::InvalidInput);
}

TEST(ReferenceJob, RefusesValuesOutOfRange) {
  const auto rejects = [](auto&& spoil, const std::string& key) {
    ReferenceJob job;
    job.press_to({1e-3});
    EXPECT_TRUE(job.violations().empty());
    spoil(job);
    const auto broken = job.violations();
    EXPECT_TRUE(std::ranges::any_of(broken, [&](const auto& violation) {
      return violation.key == key;
    })) << key;
  };
  rejects([](ReferenceJob& job) { job.press_to({}); }, "press.depth");
  rejects([](ReferenceJob& job) { job.press_to({2e-3, 1e-3}); }, "press.samples");
  rejects([](ReferenceJob& job) { job.press_to({5e-3}); }, "press.depth");
  rejects([](ReferenceJob& job) { job.degree = 4; }, "reference.degree");
  rejects([](ReferenceJob& job) { job.degree = 0; }, "reference.degree");
  rejects([](ReferenceJob& job) { job.tolerance = 0.6; }, "reference.tolerance");
  rejects([](ReferenceJob& job) { job.max_unknowns = 10; }, "reference.max_unknowns");
  rejects([](ReferenceJob& job) { job.solver_tolerance = 1e-2; }, "reference.solver_tolerance");
  rejects([](ReferenceJob& job) { job.modes = 0; }, "reference.modes");
  rejects([](ReferenceJob& job) { job.protocol.speed = 0.0; }, "press.speed");
  rejects([](ReferenceJob& job) { job.protocol.tilt = 1.0; }, "press.tilt");
  rejects([](ReferenceJob& job) { job.protocol.tilt = std::nan(""); }, "press.tilt");
  rejects([](ReferenceJob& job) { job.protocol.lateral = 0.02; }, "press.lateral");
  rejects([](ReferenceJob& job) { job.protocol.lateral_samples = 0; }, "press.lateral_samples");
  rejects(
      [](ReferenceJob& job) {
        job.protocol.contact = meshes::ContactMode::coulomb;
        job.protocol.friction = 0.0;
      },
      "press.friction");
  rejects([](ReferenceJob& job) { job.refinement = 0.1; }, "reference.refinement");
  rejects([](ReferenceJob& job) { job.refinement = std::nan(""); }, "reference.refinement");
  rejects([](ReferenceJob& job) { job.tolerance = 0.0; }, "reference.tolerance");
  rejects([](ReferenceJob& job) { job.geometry.rod_radius = 0.02; }, "geometry.rod_radius");
  rejects([](ReferenceJob& job) { job.rubber.shear_modulus = 1000; }, "rubber.shear_modulus");
}

/// Laws A and B have no minimum for lambda < 0; law C and small strain do.
TEST(ReferenceJob, FiniteStrainNeedsAPositivePoissonRatio) {
  ReferenceJob job;
  job.press_to({1e-3});
  job.rubber.shear_modulus = 0.6 * job.rubber.youngs_modulus;
  EXPECT_TRUE(job.violations().empty());
  job.strain = Strain::finite;
  for (const VolumetricLaw law : {VolumetricLaw::logarithmic, VolumetricLaw::full_quadratic}) {
    job.rubber.energy.volumetric = law;
    ASSERT_EQ(job.violations().size(), 1u);
    EXPECT_NE(job.violations()[0].rule.find("nu >= 0"), std::string::npos);
  }
  job.rubber.energy.volumetric = VolumetricLaw::isochoric_logarithmic;
  EXPECT_TRUE(job.violations().empty());
  job.rubber.energy.volumetric = VolumetricLaw::logarithmic;
  job.rubber.shear_modulus = 0.5 * job.rubber.youngs_modulus;  // nu = 0 is valid
  EXPECT_TRUE(job.violations().empty());
}

TEST(ReferenceJob, TransientPressesAreUprightAndLinear) {
  const auto refused = [](auto&& spoil) {
    ReferenceJob job;
    job.press_to({1e-3});
    job.analysis = Analysis::transient;
    EXPECT_TRUE(job.violations().empty());
    spoil(job);
    return !job.violations().empty();
  };
  EXPECT_TRUE(refused([](ReferenceJob& job) { job.protocol.tilt = 0.1; }));
  EXPECT_TRUE(refused([](ReferenceJob& job) { job.protocol.lateral = 1e-4; }));
  EXPECT_TRUE(refused([](ReferenceJob& job) { job.strain = Strain::finite; }));
  EXPECT_TRUE(
      refused([](ReferenceJob& job) { job.protocol.contact = meshes::ContactMode::coulomb; }));
}

/// Modes and verification do not press: they need no samples.
/// The job tells a solid's digest, the surface stands beside it.
TEST(ReferenceJob, ASolidSurvivesWithItsSurface) {
  const TemporaryFolder folder;
  const auto file = folder / "job.json", surface = folder / "solid.json";
  ReferenceJob job;
  // Cut along the bond, where vertices come near others.
  job.geometry = meshes::Geometry::of_solid(
      std::make_shared<meshes::Solid>(fingers::dome_surface(24, 12), fingers::dome_bond()), -0.03);
  job.press_to({1e-3});
  job.protocol.tilt = 0.1;
  EXPECT_TRUE(job.violations().empty());
  write_job(job, file);
  const ReferenceJob read = read_job(file);
  EXPECT_EQ(meshes::json_of<Json>(read), meshes::json_of<Json>(job));
  ASSERT_TRUE(read.geometry.solid);
  EXPECT_EQ(read.geometry.solid->content(), job.geometry.solid->content());
  EXPECT_EQ(read.geometry.solid->volume(), job.geometry.solid->volume());

  const std::string text = read_text(file), facets = read_text(surface);
  std::string released = facets;
  released.replace(released.find("true"), 4, "false");
  write_text(surface, released);
  EXPECT_NE(refusal(file, text).find("digest"), std::string::npos);
  write_text(surface, facets.substr(0, facets.size() / 2));
  EXPECT_NE(refusal(file, text).find("solid.json"), std::string::npos);
  std::filesystem::remove(surface);
  EXPECT_NE(refusal(file, text).find("solid.json"), std::string::npos);
  EXPECT_NE(refusal(file, R"({"geometry": {"solid": 7}})").find("geometry.solid"),
            std::string::npos);
}

TEST(ReferenceJob, ASolidIsNoBodyOfRevolution) {
  ReferenceJob job;
  job.press_to({1e-3});
  job.geometry = meshes::Geometry::of_solid(std::make_shared<meshes::Solid>(
      fingers::box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.02}), meshes::Region{{{2, true, 1e-3}}}));
  EXPECT_TRUE(job.violations().empty());
  EXPECT_FALSE(job.axisymmetric());
  job.symmetry = fem_reference::Symmetry::axisymmetric;
  ASSERT_EQ(job.violations().size(), 1u);
  EXPECT_EQ(job.violations()[0].key, "reference.symmetry");
  job.symmetry = fem_reference::Symmetry::automatic;
  job.analysis = Analysis::transient;
  ASSERT_EQ(job.violations().size(), 1u);
  EXPECT_EQ(job.violations()[0].key, "reference.mode");
}

TEST(ReferenceJob, OnlyAPressNeedsSamples) {
  ReferenceJob job;
  EXPECT_FALSE(job.violations().empty());
  job.analysis = Analysis::modes;
  EXPECT_TRUE(job.violations().empty());
  job.analysis = Analysis::verification;
  EXPECT_TRUE(job.violations().empty());
}

TEST(ReferenceJob, ShearRelaxesAloneWhereTheLawSaysWhatItIs) {
  ReferenceJob job;
  job.press_to({1e-3});
  job.rubber.relaxation = {{{0.3, 0.1}}, false};
  EXPECT_TRUE(job.violations().empty());
  job.strain = Strain::finite;  // a law of full invariants
  const auto broken = job.violations();
  ASSERT_EQ(broken.size(), 1U);
  EXPECT_EQ(broken.front().key, "rubber.relaxation_bulk");
  job.rubber.energy.volumetric = VolumetricLaw::quadratic;
  EXPECT_TRUE(job.violations().empty());
  job.rubber.energy.volumetric = VolumetricLaw::logarithmic;
  job.rubber.relaxation.bulk = true;
  EXPECT_TRUE(job.violations().empty());
}

}  // namespace
