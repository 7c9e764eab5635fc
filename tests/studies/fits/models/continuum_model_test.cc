/// The continuum as a forward model, from response.csv files of known forces.
#include "studies/fits/models/continuum_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "meshes/base/errors.h"
#include "meshes/press/press_response.h"
#include "studies/presses/reference_job.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using enum calibration::MaterialParameter;
using Eigen::Vector2d;
using fem_reference::ReferenceJob;
using meshes::PressResponse;
using meshes::PressSample;
namespace fs = std::filesystem;

namespace {

ReferenceJob reference() {
  ReferenceJob job;
  job.press_to({2e-4, 5e-4, 1e-3});
  job.protocol.tilt = 0.1;
  return job;
}

/// Hertz: F = G 8/3 sqrt(R d³)/(1 - nu).
double hertz(const meshes::Rubber& rubber, double depth) {
  return rubber.shear_modulus * 8.0 / 3.0 *
         std::sqrt(meshes::Geometry().tip_radius * std::pow(depth, 3)) /
         (1.0 - rubber.poissons_ratio());
}

/// A session that leaves what the runs would.
class ContinuumModel : public testing::Test {
 protected:
  JobContext context() {
    JobContext context;
    context.run_all = [this](const std::vector<PlannedJob>& jobs) {
      std::vector<fs::path> folders;
      for (const PlannedJob& planned : jobs) {
        names_.push_back(planned.name);
        const fs::path folder = folder_ / planned.name;
        fs::create_directories(folder);
        std::vector<PressSample> samples;
        const auto& inputs = planned.job.inputs;
        meshes::Rubber rubber;
        rubber.youngs_modulus = inputs["rubber"]["youngs_modulus"];
        rubber.shear_modulus = inputs["rubber"]["shear_modulus"];
        for (const double depth : inputs["protocol"]["samples"]) {
          PressSample& sample = samples.emplace_back();
          sample.indentation = depth;
          sample.normal_force = hertz(rubber, depth);
        }
        if (spoil_) spoil_(samples);
        PressResponse(samples).write_csv(folder / "response.csv");
        folders.push_back(folder);
      }
      return folders;
    };
    return context;
  }

  TemporaryFolder folder_;
  std::vector<std::string> names_;
  std::function<void(std::vector<PressSample>&)> spoil_;
};

}  // namespace

TEST(ContinuumOrders, DifferInPoissonsRatioAlone) {
  ReferenceJob other = reference();
  for (const double nu : {-0.3, 0.1, 0.45}) {
    const ReferenceJob job = at_ratio(reference(), nu);
    EXPECT_NEAR(job.rubber.poissons_ratio(), nu, 1e-14);
    EXPECT_EQ(job.rubber.shear_modulus, reference().rubber.shear_modulus);
    EXPECT_EQ(job.protocol.samples, reference().protocol.samples);
    EXPECT_EQ(job.protocol.tilt, reference().protocol.tilt);
    EXPECT_FALSE(job.write_fields);
    EXPECT_NE(reference_job(job).key(), reference_job(other).key());
    other = job;
  }
}

TEST(ContinuumOrders, ThatBreakARuleAreRefused) {
  EXPECT_EQ(refusal([&] { at_ratio(reference(), -0.3); }), "");
  ReferenceJob finite = reference();
  finite.strain = fem_reference::Strain::finite;
  const std::string text = refusal([&] { at_ratio(finite, -0.3); });
  EXPECT_TRUE(says(text, {"nu >= 0", "Poisson's ratio -0.3 of the fit"}));
  EXPECT_EQ(refusal([&] { at_ratio(finite, lowest_ratio(finite)); }), "");
  EXPECT_EQ(refusal([&] { at_ratio(reference(), lowest_ratio(reference())); }), "");
  ReferenceJob moving = reference();
  moving.protocol.tilt = 0.0;
  moving.analysis = fem_reference::Analysis::transient;
  EXPECT_TRUE(says(refusal([&] { at_ratio(moving, 0.4); }), "presses statically"));
}

TEST_F(ContinuumModel, GivesTheForcesOfOtherModuli) {
  auto model =
      continuum_model(reference(), {youngs_modulus, shear_modulus}, "continuum_1", context());
  meshes::Rubber rubber;
  for (const double nu : {0.1, 0.2, 0.33, 0.44}) {
    rubber.shear_modulus = 3.7 * reference().rubber.shear_modulus;
    rubber.youngs_modulus = 2.0 * rubber.shear_modulus * (1.0 + nu);
    const Vector2d moduli(rubber.youngs_modulus, rubber.shear_modulus);
    while (model.refine(moduli)) continue;
    const auto forces = model.evaluate(moduli).value;
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(forces(i) / hertz(rubber, reference().protocol.samples[std::size_t(i)]), 1.0,
                  2.5 * calibration::ScaledModel::tolerance);
  }
  ASSERT_GE(names_.size(), 4u);
  EXPECT_EQ(names_.front(), "continuum_1/0.000000");
}

TEST_F(ContinuumModel, RefusesOtherOrUnfinishedRuns) {
  const auto said = [&](std::function<void(std::vector<PressSample>&)> spoil) {
    spoil_ = std::move(spoil);
    auto model = continuum_model(reference(), {modulus}, "continuum_1", context());
    return refusal([&] { model.evaluate(Eigen::VectorXd::Constant(1, 3000.0)); });
  };
  EXPECT_EQ(said({}), "");
  std::string text = said([](auto& samples) { samples.pop_back(); });
  EXPECT_TRUE(says(text, {"needs the 3 samples", (folder_ / "continuum_1").string()}));
  text = said([](auto& samples) { samples[1].indentation = 6e-4; });
  EXPECT_TRUE(says(text, "6e-04 m"));
  text = said([](auto& samples) { samples[1].normal_force = -1.0; });
  EXPECT_TRUE(says(text, "force > 0"));
}
