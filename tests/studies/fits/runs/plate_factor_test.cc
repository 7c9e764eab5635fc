/// Cylinders between plates that stick: the job, and what its forces are compared with.
#include "studies/fits/runs/plate_factor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "meshes/press/press_response.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::StressMeasure;
using calibration::TestKind;

namespace {

const Plates plates{0.05, 0.03};
const calibration::SizedLaw yeoh =
    calibration::sized_law({meshes::RubberLaw::yeoh, 2}, Eigen::Vector2d(7.5e3, 0.3e3));

TEST(PlateFactor, TheJobIsTheCylinderGluedAndStuck) {
  const auto job = stuck_cylinder(plates, yeoh);
  EXPECT_TRUE(job.violations().empty());
  EXPECT_TRUE(job.axisymmetric());
  EXPECT_NEAR(job.geometry.tip_radius, 0.025, 1e-12);
  EXPECT_EQ(job.protocol.contact, meshes::ContactMode::stick);
  EXPECT_NEAR(job.protocol.samples.back(), 0.012, 1e-12);
  EXPECT_EQ(job.rubber.energy.law, meshes::RubberLaw::yeoh);
  EXPECT_NEAR(job.rubber.bulk_modulus() / job.rubber.shear_modulus, 499.7, 0.1);
}

TEST(PlateFactor, ItIsTheForceOverThatOfTheHomogeneousCylinder) {
  const TemporaryFolder folder;
  JobContext context;
  context.run_all = [&](const std::vector<PlannedJob>& jobs) {
    EXPECT_EQ(jobs.size(), 1u);
    meshes::PressResponse response;
    for (const double depth : stuck_cylinder(plates, yeoh).protocol.samples) {
      const double stretch = 1.0 - depth / plates.height;
      meshes::PressSample sample;
      sample.indentation = depth;
      sample.normal_force = (1.2 + 10.0 * depth) * M_PI * 0.025 * 0.025 *
                            -test_stress(yeoh, TestKind::uniaxial, StressMeasure::nominal, stretch);
      response.append(sample);
    }
    response.write_csv(folder / "response.csv");
    return std::vector{folder.path()};
  };
  const PlateFactor factor = plate_factor(plates, yeoh, "plates", context);
  EXPECT_NEAR(factor.at(0.9), 1.2 + 10.0 * 0.003, 1e-9);
  EXPECT_NEAR(factor.at(0.75), 1.2 + 10.0 * 0.0075, 1e-9);
  EXPECT_NEAR(factor.at(0.9999), 1.2 + 10.0 * 0.0006, 1e-9);
  EXPECT_NEAR(factor.at(0.1), 1.2 + 10.0 * 0.012, 1e-9);
  EXPECT_EQ(factor.at(1.5), 1.0);
}

}  // namespace
