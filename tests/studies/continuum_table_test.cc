/// The table of the continuum, from response.csv files of known forces.
#include "studies/run/continuum_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "meshes/errors.h"
#include "meshes/press_response.h"
#include "studies/run/jobs.h"
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

const std::vector<double> nodes = calibration::chebyshev_nodes(0.1, 0.45, 10);

ReferenceJob order() {
  ReferenceJob job;
  job.press_to({2e-4, 5e-4, 1e-3});
  job.protocol.tilt = 0.1;
  return job;
}

/// Hertz: F = G 8/3 sqrt(R d³)/(1 - nu).
double hertz(const ReferenceJob& job, double depth) {
  return job.rubber.shear_modulus * 8.0 / 3.0 *
         std::sqrt(job.geometry.tip_radius * std::pow(depth, 3)) /
         (1.0 - job.rubber.poissons_ratio());
}

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const meshes::InvalidInput& error) {
    return error.what();
  }
  return "accepted";
}

/// Folders as the runs would leave them.
class TableOfContinuum : public testing::Test {
 protected:
  void SetUp() override {
    for (const ReferenceJob& job : continuum_table_orders(order(), nodes)) {
      const fs::path folder = folder_ / std::to_string(folders_.size());
      fs::create_directory(folder);
      PressResponse response;
      for (const double depth : job.protocol.samples) {
        PressSample sample;
        sample.indentation = depth;
        sample.normal_force = hertz(job, depth);
        // 0.1 % per node and 1 % at the first sample
        sample.force_error =
            sample.normal_force * (0.001 * double(folders_.size()) + (depth < 3e-4 ? 0.01 : 0.0));
        response.append(sample);
      }
      response.write_csv(folder / "response.csv");
      folders_.push_back(folder);
    }
  }
  ContinuumTable table() const {
    return read_continuum_table(order(), nodes, folders_, {youngs_modulus, shear_modulus});
  }
  /// Changes one run's response.
  void change(std::size_t run, const std::function<void(std::vector<PressSample>&)>& how) {
    const fs::path file = folders_[run] / "response.csv";
    std::vector<PressSample> samples = PressResponse::read_csv(file).samples();
    how(samples);
    PressResponse(samples).write_csv(file);
  }

  TemporaryFolder folder_;
  std::vector<fs::path> folders_;
};

}  // namespace

TEST(TableOrders, DifferInPoissonsRatioAlone) {
  const auto orders = continuum_table_orders(order(), nodes);
  ASSERT_EQ(orders.size(), nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    EXPECT_NEAR(orders[k].rubber.poissons_ratio(), nodes[k], 1e-14);
    EXPECT_EQ(orders[k].rubber.shear_modulus, order().rubber.shear_modulus);
    EXPECT_EQ(orders[k].protocol.samples, order().protocol.samples);
    EXPECT_EQ(orders[k].protocol.tilt, order().protocol.tilt);
    EXPECT_FALSE(orders[k].write_fields);
    for (std::size_t other = 0; other < k; ++other)
      EXPECT_NE(reference_job(orders[k]).key(), reference_job(orders[other]).key());
  }
}

TEST(TableOrders, ThatBreakARuleAreRefused) {
  const std::vector<double> negative = {-0.3, 0.0, 0.4};
  EXPECT_EQ(refusal([&] { continuum_table_orders(order(), negative); }), "accepted");
  ReferenceJob finite = order();
  finite.strain = fem_reference::Strain::finite;
  const std::string text = refusal([&] { continuum_table_orders(finite, negative); });
  EXPECT_NE(text.find("nu >= 0"), std::string::npos) << text;
  EXPECT_NE(text.find("Poisson's ratio -0.3 of the table"), std::string::npos) << text;
  EXPECT_EQ(text.find('\n'), std::string::npos) << "0 and 0.4 are fine: " << text;
  ReferenceJob moving = order();
  moving.protocol.tilt = 0.0;
  moving.analysis = fem_reference::Analysis::transient;
  EXPECT_NE(refusal([&] { continuum_table_orders(moving, negative); }).find("static presses"),
            std::string::npos);
}

TEST_F(TableOfContinuum, GivesTheForcesOfOtherModuli) {
  ContinuumTable made = table();
  for (const double nu : {0.1, 0.2, 0.33, 0.44}) {
    ReferenceJob other = order();
    other.rubber.shear_modulus = 3.7 * order().rubber.shear_modulus;
    other.rubber.youngs_modulus = 2.0 * other.rubber.shear_modulus * (1.0 + nu);
    const auto forces =
        made.table.evaluate(Vector2d(other.rubber.youngs_modulus, other.rubber.shear_modulus));
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(forces.value(i) / hertz(other, order().protocol.samples[std::size_t(i)]), 1.0,
                  1e-8);
  }
  ASSERT_EQ(made.continuum_error.size(), 3);
  EXPECT_NEAR(made.continuum_error(0), 0.019, 1e-12);
  EXPECT_NEAR(made.continuum_error(1), 0.009, 1e-12);
}

TEST_F(TableOfContinuum, KnowsNoErrorWhereARunHasNone) {
  change(3, [](auto& samples) { samples[1].force_error = meshes::unknown; });
  const Eigen::VectorXd error = table().continuum_error;
  EXPECT_NEAR(error(0), 0.019, 1e-12);
  EXPECT_TRUE(std::isnan(error(1)));
  EXPECT_NEAR(error(2), 0.009, 1e-12);
}

TEST_F(TableOfContinuum, RefusesOtherOrUnfinishedRuns) {
  const auto said = [&] { return refusal([&] { table(); }); };
  EXPECT_EQ(said(), "accepted");
  change(2, [](auto& samples) { samples.pop_back(); });
  EXPECT_NE(said().find("needs the 3 samples"), std::string::npos) << said();
  EXPECT_NE(said().find((folders_[2] / "response.csv").string()), std::string::npos) << said();
  fs::remove(folders_[2] / "response.csv");
  EXPECT_NE(said().find("there is no such file"), std::string::npos) << said();
  fs::copy(folders_[1] / "response.csv", folders_[2]);
  change(2, [](auto& samples) { samples[1].indentation = 6e-4; });
  EXPECT_NE(said().find("6e-04 m"), std::string::npos) << said();
  change(2, [](auto& samples) {
    samples[1].indentation = 5e-4;
    samples[1].normal_force = -1.0;
  });
  EXPECT_NE(said().find("force > 0"), std::string::npos) << said();
  folders_.pop_back();
  EXPECT_NE(said().find("a folder for each"), std::string::npos) << said();
}
