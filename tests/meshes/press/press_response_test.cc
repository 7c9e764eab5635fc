#include "meshes/press/press_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <utility>

#include "meshes/base/errors.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip::meshes;

namespace {

class PressResponseFile : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    write_text(folder_ / "response.csv", text);
    return folder_ / "response.csv";
  }
  std::string refusal(const std::string& text) const {
    try {
      PressResponse::read_csv(file(text));
    } catch (const InvalidInput& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder_;
};

PressResponse power_law(double factor, double exponent, int samples, double depth) {
  PressResponse response;
  for (int i = 1; i <= samples; ++i) {
    PressSample sample;
    sample.indentation = depth * i / samples;
    sample.normal_force = factor * std::pow(sample.indentation, exponent);
    response.append(sample);
  }
  return response;
}

TEST_F(PressResponseFile, ReadsBackExactlyWhatItWrote) {
  PressResponse written;
  written.append({.indentation = 1.0 / 3.0, .normal_force = 0.1, .torque_y = -1e-300});
  written.append({.indentation = 2.0 / 3.0, .normal_force = 0.7, .time = 12.5});
  written.write_csv(folder_ / "response.csv");
  const PressResponse read = PressResponse::read_csv(folder_ / "response.csv");
  ASSERT_EQ(read.samples().size(), 2u);
  EXPECT_EQ(read.samples()[0].indentation, 1.0 / 3.0);
  EXPECT_EQ(read.samples()[0].torque_y, -1e-300);
  EXPECT_TRUE(std::isnan(read.samples()[0].time));
  EXPECT_EQ(read.samples()[1].time, 12.5);
}

TEST_F(PressResponseFile, FirstLineNamesEveryColumnWithItsUnit) {
  const std::string common =
      "indentation [m],normal_force [N],lateral_force_x [N],lateral_force_y [N],"
      "torque_x [N m],torque_y [N m],torque_z [N m],contact_radius [m],max_pressure [Pa],"
      "force_error [N],time [s],contact_area [m^2],mean_pressure [Pa]";
  PressResponse response;
  for (const double lateral : {0.0, -1e-4}) {
    response.append({.indentation = 1e-3, .normal_force = 1.0, .lateral_displacement = lateral});
    response.write_csv(folder_ / "response.csv");
    std::string line;
    std::ifstream in(folder_ / "response.csv");
    std::getline(in, line);
    EXPECT_EQ(line, lateral == 0.0 ? common : common + ",lateral_displacement [m]");
  }
}

TEST_F(PressResponseFile, ALateralMotionFollowsThePress) {
  const PressResponse press = power_law(2.0, 1.5, 4, 2e-3);
  PressResponse written;
  for (PressSample sample : press.samples()) {
    sample.lateral_displacement = 0.0;
    written.append(sample);
  }
  for (const double lateral : {-1e-4, -2e-4})
    written.append({.indentation = 2e-3, .normal_force = 9.0, .lateral_displacement = lateral});
  written.write_csv(folder_ / "response.csv");
  const PressResponse read = PressResponse::read_csv(folder_ / "response.csv");
  ASSERT_EQ(read.pressing().size(), 4u);
  ASSERT_EQ(read.sliding().size(), 2u);
  EXPECT_EQ(read.sliding()[1].lateral_displacement, -2e-4);
  EXPECT_EQ(read.depth(), 2e-3);
  // The force against indentation is that of the press alone.
  for (const double depth : {1e-4, 1.2e-3, 2e-3})
    EXPECT_EQ(read.normal_force_at(depth), press.normal_force_at(depth));
  EXPECT_TRUE(press.sliding().empty());
  EXPECT_TRUE(PressResponse().pressing().empty());
}

TEST_F(PressResponseFile, ATwistFollowsThePress) {
  PressResponse written;
  for (const double twist : {0.0, -0.1, -0.2})
    written.append({.indentation = 2e-3,
                    .normal_force = 9.0,
                    .lateral_displacement = 0.0,
                    .twist = twist,
                    .spin_torque = 3.0 * twist});
  written.write_csv(folder_ / "response.csv");
  const PressResponse read = PressResponse::read_csv(folder_ / "response.csv");
  ASSERT_EQ(read.sliding().size(), 2u);
  EXPECT_EQ(read.sliding()[1].twist, -0.2);
  EXPECT_EQ(read.sliding()[1].spin_torque, 3.0 * -0.2);
  EXPECT_TRUE(std::isnan(read.sliding()[1].lateral_displacement));
}

TEST_F(PressResponseFile, StagesOfAProgramFollowTheFirstLoading) {
  PressResponse written;
  const double rows[][4] = {{1e-3, 1.0, 0.1, 1}, {2e-3, 3.0, 0.2, 1}, {2e-3, 2.5, 0.3, 2},
                            {2e-3, 2.4, 0.4, 2}, {3e-3, 4.0, 0.5, 3}, {-1e-4, 0.0, 0.9, 4}};
  for (const auto& [indentation, force, time, stage] : rows)
    written.append(
        {.indentation = indentation, .normal_force = force, .time = time, .stage = stage});
  written.write_csv(folder_ / "response.csv");
  const PressResponse read = PressResponse::read_csv(folder_ / "response.csv");
  ASSERT_EQ(read.pressing().size(), 2u);
  ASSERT_EQ(read.following().size(), 4u);
  EXPECT_TRUE(read.sliding().empty());
  EXPECT_EQ(read.following().back().stage, 4.0);
  EXPECT_EQ(read.depth(), 2e-3) << "up to which the first loading tells forces";
  EXPECT_EQ(read.deepest(), 3e-3);
  EXPECT_EQ(read.normal_force_at(2e-3), 3.0);
  EXPECT_THROW(read.normal_force_at(2.5e-3), std::out_of_range);
  EXPECT_TRUE(power_law(2.0, 1.5, 4, 2e-3).following().empty());

  const std::string titles = "indentation [m],normal_force [N],time [s],stage\n0.2,1,1,1\n";
  EXPECT_TRUE(says(refusal(titles + "0.1,1,2,1\n"), "increase"));
  EXPECT_TRUE(says(refusal(titles + "0.2,1,1,2\n"), "times must increase"));
  EXPECT_TRUE(says(refusal(titles + "0.1,1,2,0\n"), "not decrease"));
  EXPECT_TRUE(says(refusal(titles + "0.3,1,2,\n"), "every row or none"));
}

TEST_F(PressResponseFile, AcceptsColumnsInAnyOrderAndUnknownOnes) {
  const auto response = PressResponse::read_csv(
      file("comment [1],normal_force [N],indentation [m]\n7,2.5,0.001\r\n,3.5,0.002\n"));
  ASSERT_EQ(response.samples().size(), 2u);
  EXPECT_EQ(response.samples()[1].normal_force, 3.5);
}

TEST_F(PressResponseFile, RefusesDamagedFilesWithFileAndLine) {
  const std::string titles = "indentation [m],normal_force [N]\n";
  EXPECT_TRUE(says(refusal("depth,normal_force [N]\n"), "response.csv:1"));
  EXPECT_TRUE(says(refusal(titles + "0.1,1\n0.2\n"), "response.csv:3"));
  EXPECT_TRUE(says(refusal(titles + "0.1,one\n"), "response.csv:2, normal_force [N] = one"));
  EXPECT_TRUE(says(refusal(titles + "0.1,nan\n"), "finite"));
  EXPECT_TRUE(says(refusal(titles + ",1\n"), "response.csv:2"));
  EXPECT_TRUE(says(refusal(titles + "0.2,1\n0.1,2\n"), "increase"));
  EXPECT_TRUE(says(refusal(titles + "0.2,1\n0.2,2\n"), "increase"));
  EXPECT_TRUE(says(refusal("indentation [m],normal_force [N],twist [rad]\n0.2,1,0.1\n0.2,1,0.1\n"),
                   "twists at full depth"));
  const std::string lateral =
      "indentation [m],normal_force [N],lateral_displacement [m]\n0.2,1,0.1\n";
  EXPECT_TRUE(says(refusal(lateral + "0.2,2,0.1\n"), "response.csv:3"));
  EXPECT_TRUE(says(refusal(lateral + "0.1,2,0.2\n"), "response.csv:3"));
  EXPECT_TRUE(says(refusal(titles + "0.1,1\n0.2,2.0"), "truncated"));
  EXPECT_TRUE(says(refusal(""), "empty"));
  EXPECT_TRUE(says(refusal(titles + "0.1,1e70\n"), "finite"));
  EXPECT_TRUE(says(refusal("indentation [m],indentation [m]\n"), "once"));
  EXPECT_THROW_SAYING(PressResponse::read_csv(folder_ / "absent.csv"), InvalidInput, "absent.csv");
  EXPECT_THROW_SAYING(PressResponse::read_csv(folder_.path()), InvalidInput, "is no file");
}

TEST_F(PressResponseFile, AnUnwritableFolderIsNamed) {
  EXPECT_TRUE(refuses<std::runtime_error>(
      [&] { PressResponse().write_csv(folder_ / "absent" / "response.csv"); }, "absent"));
}

TEST(PressResponse, ItsErrorBetweenSamplesIsTheLargerOneOfBothSides) {
  EXPECT_TRUE(std::isnan(power_law(2.0, 1.5, 4, 2e-3).relative_error_at(1e-3)));
  PressResponse response;
  for (const auto& [depth, error] :
       {std::pair(1e-3, unknown), std::pair(2e-3, 0.2), std::pair(3e-3, 0.1), std::pair(4e-3, 0.3)})
    response.append({.indentation = depth, .normal_force = 2.0, .force_error = error});
  EXPECT_EQ(response.relative_error_at(0.5e-3), 0.1);
  EXPECT_EQ(response.relative_error_at(2.5e-3), 0.1);
  EXPECT_EQ(response.relative_error_at(3e-3), 0.05);
  EXPECT_EQ(response.relative_error_at(3.5e-3), 0.15);
  EXPECT_EQ(response.relative_error_at(9e-3), 0.15);
}

TEST(PressResponse, AContactHasTheAreaOfItsCircle) {
  PressSample sample{.indentation = 1e-3, .normal_force = 2.0};
  sample.set_contact(3e-3, 5e4);
  EXPECT_EQ(sample.contact_radius, 3e-3);
  EXPECT_NEAR(sample.contact_area, std::numbers::pi * 9e-6, 1e-18);
  EXPECT_NEAR(sample.mean_pressure * sample.contact_area, 2.0, 1e-15);
  EXPECT_EQ(sample.max_pressure, 5e4);
  sample.set_contact(0.0, 0.0);
  EXPECT_EQ(sample.mean_pressure, 0.0);
}

/// A force of 3 N, 4 N of it aside, and its moment; nothing aside of what a symmetry leaves.
TEST(PressResponse, ErrorsAreThoseOfAForceAndItsPlace) {
  PressSample sample{.normal_force = 3.0,
                     .lateral_force_x = 0.0,
                     .lateral_force_y = -4.0,
                     .torque_x = 0.02,
                     .torque_y = 0.0,
                     .torque_z = 0.0,
                     .contact_radius = 1e-3};
  sample.set_errors(0.1);
  EXPECT_NEAR(sample.force_error, 0.3, 1e-15);
  EXPECT_NEAR(sample.lateral_force_error, 0.1 * std::hypot(4.0, 3.0 / 8.0), 1e-15);
  EXPECT_NEAR(sample.torque_error, 0.1 * (0.02 + 0.007), 1e-15);
  sample.lateral_force_y = 1e-10;
  sample.torque_x = 1e-13;
  sample.set_errors(0.1);
  EXPECT_TRUE(std::isnan(sample.lateral_force_error));
  EXPECT_TRUE(std::isnan(sample.torque_error));
}

/// A disc that sticks, of another radius and about another centre: closed forms before and after.
TEST(PressResponse, ErrorsOfWhatSticksAreThoseOfItsRadiusAndItsCentre) {
  constexpr double shear_modulus = 1e4, ratio = 0.4, twist = 0.1, way = 1e-3, radius = 2e-3,
                   off = 1e-4, height = 0.02;
  const auto of_radius = [&](double e) {
    return RelativeErrors{.normal = 0.0, .aside = e, .spin = 3.0 * e, .lever = height};
  };
  const auto aside = [](double a) { return 8.0 * shear_modulus * a * way / (2.0 - ratio); };
  const auto turn = [](double a) { return 16.0 / 3.0 * shear_modulus * std::pow(a, 3) * twist; };
  PressSample turned{.normal_force = 1.0,
                     .lateral_force_x = 0.0,
                     .lateral_force_y = 0.0,
                     .torque_x = 0.0,
                     .torque_y = 0.0,
                     .torque_z = turn(radius),
                     .contact_radius = radius,
                     .spin_torque = -turn(radius)};
  turned.set_errors(of_radius(off));
  EXPECT_EQ(turned.force_error, 0.0);
  EXPECT_NEAR(turned.torque_error, turn((1.0 + off) * radius) - turn(radius),
              2e-4 * turned.torque_error);
  PressSample slid = turned;
  slid.lateral_force_x = aside(radius);
  slid.torque_y = height * aside(radius);
  slid.torque_z = slid.spin_torque = 0.0;
  slid.set_errors(of_radius(off));
  EXPECT_NEAR(slid.lateral_force_error, aside((1.0 + off) * radius) - aside(radius), 1e-9);
  EXPECT_NEAR(slid.torque_error, height * slid.lateral_force_error, 1e-9);
  // What is turned about a place beside its centre goes aside, and that has a moment.
  PressSample beside = turned;
  beside.lateral_force_y = 1e-3;
  beside.set_errors({.normal = 0.0, .aside = 0.0, .spin = 0.0, .centre = 0.05, .lever = height});
  const double moved = 8.0 * shear_modulus * radius / (2.0 - ratio) * twist * 0.05 * radius;
  EXPECT_NEAR(beside.lateral_force_error, moved, 0.1 * moved);
  EXPECT_NEAR(beside.torque_error, height * beside.lateral_force_error, 1e-12);
}

TEST(PressResponse, InterpolationPassesThroughSamplesAndOrigin) {
  const PressResponse response = power_law(2.0, 1.5, 10, 3e-3);
  EXPECT_EQ(response.normal_force_at(0.0), 0.0);
  for (const PressSample& sample : response.samples()) {
    EXPECT_NEAR(response.normal_force_at(sample.indentation), sample.normal_force, 1e-15);
  }
  EXPECT_THROW(response.normal_force_at(3.1e-3), std::out_of_range);
  EXPECT_THROW(response.normal_force_at(-1e-9), std::out_of_range);
}

TEST(PressResponse, InterpolationConvergesToASmoothForceLaw) {
  const auto error = [](int samples) {
    const PressResponse response = power_law(1.0, 1.5, samples, 1.0);
    double worst = 0.0;
    for (double at = 0.3; at < 1.0; at += 0.0137) {
      worst = std::max(worst, std::abs(response.normal_force_at(at) - std::pow(at, 1.5)));
    }
    return worst;
  };
  EXPECT_LT(error(10), 2e-3);
  EXPECT_GT(std::log2(error(10) / error(20)), 1.8);  // at least second order where monotone
}

/// Intervals of 1 and 3 with secants 1 and 3: the slope between them is the harmonic mean with the
/// weights 7 and 5 of Fritsch & Butland, 18/13; the parabola at the end has 4.5 - 9/13.
TEST(PressResponse, UnevenSamplesWeighTheirSecants) {
  PressResponse response;
  response.append({.indentation = 1.0, .normal_force = 1.0});
  response.append({.indentation = 4.0, .normal_force = 10.0});
  const double inner = 18.0 / 13.0, end = 4.5 - 9.0 / 13.0;
  EXPECT_NEAR(response.normal_force_at(2.5), 5.5 + 3.0 / 8.0 * (inner - end), 1e-14);
}

TEST(PressResponse, InterpolationNeverOvershootsAStep) {
  PressResponse response;
  for (const auto& [at, force] : {std::pair{1.0, 0.0}, {2.0, 0.01}, {3.0, 5.0}, {4.0, 5.01}}) {
    response.append({.indentation = at, .normal_force = force});
  }
  double previous = 0.0;
  for (double at = 0.0; at <= 4.0; at += 0.01) {
    const double force = response.normal_force_at(at);
    EXPECT_GE(force, previous - 1e-14) << at;
    previous = force;
  }
}

TEST(PressResponse, ErrorNormsOfAConstantFactorAreThatFactor) {
  const PressResponse reference = power_law(2.0, 1.5, 20, 3e-3);
  const PressResponse response = power_law(2.2, 1.5, 20, 3e-3);
  EXPECT_NEAR(relative_force_error(response, reference, 1.1e-3), 0.1, 1e-12);
  EXPECT_NEAR(relative_l2_force_error(response, reference, 1e-4, 3e-3), 0.1, 1e-12);
  EXPECT_EQ(relative_l2_force_error(reference, reference, 0.0, 3e-3), 0.0);
}

}  // namespace
