#include "studies/presses/force_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "lattice/press/press_deviation.h"
#include "studies/presses/reference_job.h"
#include "tests/studies/configured.h"

using namespace fingertip::studies;
using fingertip::meshes::PressResponse;
using fingertip::meshes::PressSample;

namespace {

PressSample sample(double indentation, double force, double error = std::nan("")) {
  PressSample result;
  result.indentation = indentation;
  result.normal_force = force;
  result.force_error = error;
  return result;
}

ErrorSource source_of(const std::vector<std::string>& sets) {
  return error_source(config_of(sets));
}

}  // namespace

TEST(ForceError, IsTheDistanceFromTheContinuumAndItsOwnError) {
  const PressResponse continuum({sample(1e-3, 2.0, 0.02), sample(2e-3, 6.0, 0.12)});
  const PressResponse lattice({sample(0.5e-3, 1.0), sample(1e-3, 2.3), sample(1.5e-3, 3.0),
                               sample(2e-3, 5.0), sample(2.5e-3, 8.0)});
  const auto samples = with_force_error(lattice, continuum).samples();
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_TRUE(std::isnan(samples[0].force_error)) << "above the continuum's first depth";
  EXPECT_NEAR(samples[1].force_error, 0.3 + 0.02, 1e-12);
  const double between = continuum.normal_force_at(1.5e-3);
  EXPECT_NEAR(samples[2].force_error, between - 3.0 + 0.02 * between, 1e-12)
      << "with the larger relative error of both sides";
  EXPECT_NEAR(samples[3].force_error, 1.0 + 0.12, 1e-12);
  EXPECT_TRUE(std::isnan(samples[4].force_error)) << "beyond its last";
  for (std::size_t i = 0; i < samples.size(); ++i)
    EXPECT_EQ(samples[i].normal_force, lattice.samples()[i].normal_force);
  const PressResponse alone = with_force_error(lattice, {});
  for (const PressSample& own : alone.samples()) EXPECT_TRUE(std::isnan(own.force_error));
}

TEST(ForceError, OfALateralMotionIsToldWhereBothHaveMovedAsFar) {
  const auto moved = [](double displacement, double force, double error = std::nan("")) {
    PressSample result = sample(1e-3, force, error);
    result.lateral_displacement = displacement;
    return result;
  };
  const PressResponse continuum({sample(1e-3, 2.0, 0.02), moved(1e-3, 1.9, 0.03)});
  const PressResponse lattice({sample(1e-3, 2.0), moved(0.5e-3, 2.0), moved(1e-3, 2.1)});
  ASSERT_EQ(lattice.sliding().size(), 2U);
  const auto samples = with_force_error(lattice, continuum).samples();
  EXPECT_NEAR(samples[0].force_error, 0.02, 1e-12);
  EXPECT_TRUE(std::isnan(samples[1].force_error));
  EXPECT_NEAR(samples[2].force_error, 0.2 + 0.03, 1e-12);
}

TEST(ForceError, OfWhatPullsAsideIsAVectors) {
  const auto tilted = [](double aside, double moment, double error = std::nan("")) {
    PressSample result = sample(1e-3, 2.0, error);
    result.lateral_force_x = aside;
    result.lateral_force_y = 0.0;
    result.torque_x = result.torque_z = 0.0;
    result.torque_y = moment;
    result.contact_radius = 1e-3;
    return result;
  };
  const PressResponse continuum({tilted(0.4, 0.05, 0.02)}), lattice({tilted(0.3, 0.06)});
  const PressSample found = with_force_error(lattice, continuum).samples().front();
  EXPECT_NEAR(found.force_error, 0.02, 1e-12);
  EXPECT_NEAR(found.lateral_force_error, 0.1 + 0.01 * std::hypot(0.3, 2.0 / 8.0), 1e-12);
  EXPECT_NEAR(found.torque_error, 0.01 + 0.01 * (0.06 + 1e-3 * 2.3), 1e-12);
  // Of no force there is no share.
  PressSample nothing = tilted(0.4, 0.05, 0.02);
  nothing.normal_force = 0.0;
  const PressSample unknown = with_force_error(lattice, PressResponse({nothing})).samples().front();
  EXPECT_TRUE(std::isnan(unknown.lateral_force_error));
  EXPECT_TRUE(std::isnan(unknown.torque_error));
}

TEST(ForceError, OfRadiusAreaAndPeakIsLikewise) {
  PressSample truth = sample(1e-3, 2.0, 0.02), own = sample(1e-3, 2.1);
  truth.set_contact(3e-3, 4e3);
  truth.contact_radius_error = 1e-5;
  truth.contact_area_error = 2e-7;
  own.set_contact(3.1e-3, 3.9e3);
  const PressSample found =
      with_force_error(PressResponse({own}), PressResponse({truth})).samples()[0];
  EXPECT_NEAR(found.contact_radius_error, 1.1e-4, 1e-12);
  EXPECT_NEAR(found.contact_area_error, own.contact_area - truth.contact_area + 2e-7, 1e-15);
  EXPECT_TRUE(std::isnan(found.max_pressure_error)) << "as long as the truth's is unknown";
}

TEST(ForceError, IsFromTheContinuumWhereThatTakesSeconds) {
  const ErrorSource small = source_of({});
  ASSERT_TRUE(small.continuum);
  EXPECT_TRUE(small.continuum->estimate_error);
  EXPECT_EQ(small.statement, "from the continuum at small strain");
  const ErrorSource large = source_of({"lattice.model=published"});
  ASSERT_TRUE(large.continuum);
  EXPECT_EQ(large.statement, "from the continuum at large strain");
  const auto key = [](const ErrorSource& source) { return reference_job(*source.continuum).key(); };
  EXPECT_NE(key(large), key(small));
  EXPECT_EQ(source_of({"lattice.model=published", "reference.strain=linear"}).statement,
            small.statement);
  EXPECT_EQ(key(source_of({"press.mode=static"})), key(small));
}

TEST(ForceError, IsEstimatedElsewhereAndSaysWhy) {
  for (const auto& [set, why] : std::map<std::string, std::string>{
           {"press.tilt=5 deg", "run.error = \"continuum\""},
           {"rubber.relaxation=[[0.25, \"0.3 s\"]]", "relaxes"},
           {R"(press.program=[["2 mm", "3 cm/s"], ["hold", "2 s"]])", "program"}}) {
    const ErrorSource source = source_of({set});
    EXPECT_FALSE(source.continuum) << set;
    EXPECT_TRUE(source.estimated) << set;
    EXPECT_TRUE(says(source.statement, {"estimated, for ", why})) << source.statement;
    const ErrorSource published = source_of({set, "lattice.model=published"});
    EXPECT_FALSE(published.estimated) << set;
    EXPECT_TRUE(says(published.statement, {"not known: ", "has no estimate"}))
        << published.statement;
  }
  const ErrorSource solid = source_of({"press.tilt=5 deg", "run.error=continuum"});
  EXPECT_TRUE(solid.continuum);
  EXPECT_FALSE(solid.estimated);
  const ErrorSource asked = source_of({"run.error=estimate"});
  EXPECT_FALSE(asked.continuum);
  EXPECT_TRUE(asked.estimated);
  EXPECT_EQ(asked.statement, "estimated");
  const ErrorSource off = source_of({"run.error=off"});
  EXPECT_FALSE(off.continuum || off.estimated);
  EXPECT_EQ(off.statement, "");
}

TEST(ForceError, OfAnEstimateIsAPartOfTheForceWhereThereIsContact) {
  PressSample touches = sample(1e-3, 2.0);
  touches.contact_radius = 3e-3;
  touches.max_pressure = 500.0;
  const fingertip::lattice::PressSetup setup = setup_of({"press.mode=static"});
  const fingertip::lattice::ForceEstimator estimator(setup);
  const auto samples =
      with_estimated_error(PressResponse({sample(0.5e-3, 1.0), touches}), estimator).samples();
  EXPECT_TRUE(std::isnan(samples[0].force_error)) << "no radius is known";
  const fingertip::lattice::ForceEstimate estimate = *estimator.of(touches);
  EXPECT_DOUBLE_EQ(samples[1].force_error, 2.0 * estimate.sum());
  EXPECT_TRUE(std::isnan(samples[0].pressure_error));
  EXPECT_DOUBLE_EQ(samples[1].pressure_error, 500.0 * (estimate.sum() + estimate.profile));
  // Beside a continuum what the force is off is known, and the rest estimated.
  touches.force_error = 0.01;
  touches.indentation = 1e-3;
  EXPECT_DOUBLE_EQ(
      with_pressure_error(PressResponse({touches}), estimator).samples()[0].pressure_error,
      500.0 * (0.005 + estimate.profile));
}

/// As large a part of it as of the force, but near the contact, where displacements change sign.
TEST(ForceError, OfADisplacementIsAPartOfIt) {
  PressSample pressed = sample(1e-3, 2.0), slid = sample(1e-3, 2.0);
  pressed.contact_radius = slid.contact_radius = 3e-3;
  slid.lateral_displacement = 0.5e-3;
  const PressResponse response({sample(0.5e-3, 1.0), pressed, slid});
  const auto setup = setup_of({"press.mode=static"});
  const fingertip::lattice::ForceEstimator estimator(setup);
  const fingertip::meshes::Vector3 pole(0.0, 0.0, setup.geometry.pole()), down(0.0, 0.0, -0.2e-3);
  const auto error = [&](int at, double below, const fingertip::meshes::Vector3& displacement) {
    return with_estimated_error({{.sample = at,
                                  .place = pole - fingertip::meshes::Vector3(0.0, 0.0, below),
                                  .displacement = displacement}},
                                response, estimator)
        .front()
        .error;
  };
  const double share = estimator.of(pressed)->sum();
  EXPECT_TRUE(std::isnan(error(1, 0.0, down))) << "no radius is known";
  EXPECT_NEAR(error(2, 4.9e-3, 5.0 * down), share * 1e-3, 1e-12) << "as far as the obstacle";
  EXPECT_NEAR(error(2, 6e-3, down), share * 0.25e-3, 1e-12) << "(a/r)² of the indentation";
  EXPECT_NEAR(error(2, 12e-3, down), share * 0.2e-3, 1e-12) << "of the displacement";
  EXPECT_NEAR(error(2, 0.0, fingertip::meshes::Vector3::Zero()), share * 1e-3, 1e-12)
      << "in the contact of all of the way";
  // Aside the edge of what sticks counts, too.
  EXPECT_GT(error(3, 0.0, fingertip::meshes::Vector3::Zero()),
            1.5 * error(2, 0.0, fingertip::meshes::Vector3::Zero()));
}

TEST(ForceError, OfADisplacementIsItsDistanceFromTheContinuum) {
  using fingertip::meshes::MarkerRow;
  using fingertip::meshes::Vector3;
  const PressResponse lattice({sample(1e-3, 2.0), sample(2e-3, 6.0)}),
      continuum({sample(0.5e-3, 1.0), sample(1e-3, 2.1)});
  const auto row = [](int at, int marker, double down, double error) {
    return MarkerRow{
        .sample = at, .marker = marker, .displacement = Vector3(0.0, 0.0, -down), .error = error};
  };
  const auto rows = with_marker_error(
      {row(1, 1, 0.5e-3, 1.0), row(1, 2, 0.2e-3, 1.0), row(2, 1, 1e-3, 1.0)}, lattice,
      {row(1, 1, 0.1e-3, 0.0), row(1, 2, 0.1e-3, 0.0), row(2, 1, 0.47e-3, 0.01e-3),
       row(2, 2, 0.2e-3, 0.02e-3)},
      continuum);
  EXPECT_NEAR(rows[0].error, 0.04e-3, 1e-12);
  EXPECT_NEAR(rows[1].error, 0.02e-3, 1e-12);
  EXPECT_TRUE(std::isnan(rows[2].error)) << "the continuum has no such sample";
}

/// A bar above what was asked for says so, from where on that is kept, and what would keep it.
TEST(ForceError, AboveTheToleranceSaysWhatMakesItSmaller) {
  const auto words = [](const std::vector<std::string>& sets, double largest, double depth) {
    return beyond_tolerance(config_of(sets), {"estimated", largest, depth});
  };
  const std::string few = words({"press.mode=static"}, 0.05, 1e-4);
  EXPECT_TRUE(says(few, {"lattice.tolerance = 2 %", "from 0.3 mm on", "tip_radius/"})) << few;
  EXPECT_EQ(words({"press.mode=static"}, 0.019, 1e-4), "");
  EXPECT_EQ(words({"press.mode=static", "lattice.spacing=tip_radius/8"}, 0.05, 1e-4), "")
      << "nobody has asked for 2 %";
  // The spacing that it names does keep the tolerance there.
  const std::size_t begin = few.find("tip_radius/"), end = few.find(' ', begin);
  const LoadedConfig finer =
      config_of({"press.mode=static", "lattice.spacing=" + few.substr(begin, end - begin)});
  const auto at = [](const LoadedConfig& loaded) {
    return fingertip::lattice::ForceEstimator(loaded.config.press).at(1e-4)->grid();
  };
  EXPECT_LE(at(finer), 0.02);
  EXPECT_GT(at(config_of({"press.mode=static"})), 0.02);
  const std::string fast = words({"press.speed=10 cm/s", "press.mode=quasi-static"}, 0.5, 1e-4);
  EXPECT_TRUE(says(fast, {"press.mode = static"})) << fast;
}
