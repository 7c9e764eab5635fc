#include "lattice/control/hardware.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace fingertip;
using lattice::Hardware;
using lattice::HardwareSettings;
using lattice::Measurement;
using lattice::Wrench;
using meshes::Vector3;

namespace {

Measurement truth() {
  Measurement m;
  m.time = 0.123;
  m.pose.position = {1.0e-3, -2.0e-3, 3.1e-3};
  m.pose.orientation = Eigen::AngleAxisd(0.02, Vector3(1, -2, 2) / 3.0);
  m.twist = {{0.01, 0.02, -0.03}, {0.4, -0.5, 0.6}};
  m.wrench = {{0.11, -0.22, 0.33}, {0.0011, 0.0022, -0.0033}};
  m.contact = lattice::ContactState{5, 1e-3, {}};
  return m;
}

Vector3 rotation_vector(const Measurement& m) {
  const Eigen::AngleAxisd turned(m.pose.orientation);
  return turned.angle() * turned.axis();
}

/// What `count` readings say about the vector that `part` takes out of them.
struct Statistics {
  Vector3 mean = Vector3::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  template <typename Part>
  Statistics(Hardware& hardware, const Measurement& m, int count, const Part& part) {
    for (int i = 0; i < count; ++i) {
      const Vector3 error = part(hardware.sense(m)) - part(m);
      mean += error / count;
      covariance += error * error.transpose() / count;
    }
    covariance -= mean * mean.transpose();
  }
};

}  // namespace

TEST(Hardware, PerfectSensorsAndActuatorsChangeNothing) {
  Hardware hardware({}, 20.0, 1.0);
  const Measurement m = truth(), seen = hardware.sense(m);
  EXPECT_EQ(seen.time, m.time);
  EXPECT_EQ(seen.pose.position, m.pose.position);
  EXPECT_EQ(seen.pose.orientation.coeffs(), m.pose.orientation.coeffs());
  EXPECT_EQ(seen.twist.velocity, m.twist.velocity);
  EXPECT_EQ(seen.twist.angular_velocity, m.twist.angular_velocity);
  EXPECT_EQ(seen.wrench.force, m.wrench.force);
  EXPECT_EQ(seen.wrench.torque, m.wrench.torque);
  ASSERT_TRUE(seen.contact);
  EXPECT_EQ(seen.contact->touching, 5);
  const Wrench acts = hardware.act(m.wrench, 1e-3);
  EXPECT_EQ(acts.force, m.wrench.force);
  EXPECT_EQ(acts.torque, m.wrench.torque);
}

TEST(Hardware, ReadingsAreTheNearestMultiplesOfTheResolution) {
  HardwareSettings settings;
  settings.position.resolution = 7e-7;
  settings.velocity.resolution = 3e-4;
  settings.angular_velocity.resolution = 0.07;
  settings.force.resolution = 0.013;
  settings.torque.resolution = 1.7e-4;
  settings.orientation.resolution = 1.1e-3;
  Hardware hardware(settings, 20.0, 1.0);
  const Measurement m = truth(), seen = hardware.sense(m);
  const auto expect_multiple = [](const Vector3& reading, const Vector3& real, double step) {
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = reading[axis] / step;
      EXPECT_NEAR(steps, std::round(steps), 1e-9);
      EXPECT_LE(std::abs(reading[axis] - real[axis]), 0.5 * step * (1.0 + 1e-9));
    }
  };
  expect_multiple(seen.pose.position, m.pose.position, 7e-7);
  expect_multiple(seen.twist.velocity, m.twist.velocity, 3e-4);
  expect_multiple(seen.twist.angular_velocity, m.twist.angular_velocity, 0.07);
  expect_multiple(seen.wrench.force, m.wrench.force, 0.013);
  expect_multiple(seen.wrench.torque, m.wrench.torque, 1.7e-4);
  expect_multiple(rotation_vector(seen), rotation_vector(m), 1.1e-3);
}

TEST(Hardware, NoiseIsWhiteWithTheStatedDeviation) {
  HardwareSettings settings;
  settings.position.noise = 1e-6;
  settings.orientation.noise = 2e-4;
  settings.velocity.noise = 3e-4;
  settings.angular_velocity.noise = 4e-3;
  settings.force.noise = 5e-3;
  settings.torque.noise = 6e-6;
  // Standard errors of 40 000 samples: 0.005 s of the mean and of a correlation, 0.0035 s of the
  // deviation; a bound of five of them.
  constexpr int count = 40'000;
  const auto expect_noise = [&](double deviation, const auto& part) {
    Hardware hardware(settings, 20.0, 1.0);
    const Statistics seen(hardware, truth(), count, part);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(seen.mean[i], 0.0, 0.025 * deviation);
      EXPECT_NEAR(std::sqrt(seen.covariance(i, i)), deviation, 0.018 * deviation);
      for (int j = 0; j < i; ++j) {
        EXPECT_NEAR(seen.covariance(i, j), 0.0, 0.025 * deviation * deviation);
      }
    }
  };
  expect_noise(1e-6, [](const Measurement& m) { return m.pose.position; });
  expect_noise(2e-4, rotation_vector);
  expect_noise(3e-4, [](const Measurement& m) { return m.twist.velocity; });
  expect_noise(4e-3, [](const Measurement& m) { return m.twist.angular_velocity; });
  expect_noise(5e-3, [](const Measurement& m) { return m.wrench.force; });
  expect_noise(6e-6, [](const Measurement& m) { return m.wrench.torque; });
}

TEST(Hardware, SuccessiveReadingsAreUncorrelated) {
  HardwareSettings settings;
  settings.force.noise = 1.0;
  Hardware hardware(settings, 20.0, 1.0);
  constexpr int count = 40'000;
  double last = 0.0, correlation = 0.0;
  for (int i = 0; i < count; ++i) {
    const double now = hardware.sense({}).wrench.force.x();
    correlation += now * last / count;
    last = now;
  }
  EXPECT_NEAR(correlation, 0.0, 0.025);
}

TEST(Hardware, TheSeedDecidesTheNoise) {
  HardwareSettings settings;
  settings.force.noise = 0.1;
  settings.orientation.noise = 0.1;
  const auto readings = [](Hardware& hardware) {
    std::vector<double> values;
    for (int i = 0; i < 20; ++i) {
      const Measurement m = hardware.sense(truth());
      values.push_back(m.wrench.force.y());
      values.push_back(m.pose.orientation.z());
    }
    return values;
  };
  Hardware hardware(settings, 20.0, 1.0), same(settings, 20.0, 1.0);
  const auto first = readings(hardware);
  EXPECT_EQ(first, readings(same));
  EXPECT_NE(first, readings(hardware));  // it goes on
  hardware.reset();
  EXPECT_EQ(first, readings(hardware));
  settings.seed = 2;
  Hardware other(settings, 20.0, 1.0);
  EXPECT_NE(first, readings(other));
}

TEST(Hardware, WithoutTactileSensorNothingIsKnownOfTheContact) {
  HardwareSettings settings;
  settings.tactile = false;
  Hardware hardware(settings, 20.0, 1.0);
  EXPECT_FALSE(hardware.sense(truth()).contact);
}

TEST(Hardware, ActuatorsAreLimitedAxisByAxis) {
  Hardware hardware({}, 2.0, 0.5);
  const Wrench acts = hardware.act({{3.0, -1.0, -5.0}, {0.4, 0.6, -0.7}}, 1e-3);
  EXPECT_EQ(acts.force, Vector3(2.0, -1.0, -2.0));
  EXPECT_EQ(acts.torque, Vector3(0.4, 0.5, -0.5));
}

TEST(Hardware, ActuatorsChangeAtTheirRateAtMost) {
  HardwareSettings settings;
  settings.force_rate = 100.0;
  settings.torque_rate = 7.0;
  Hardware hardware(settings, 20.0, 1.0);
  const Wrench wanted{{0.35, -0.05, 0.0}, {0.0, 0.0, 0.01}};
  for (int i = 1; i <= 5; ++i) {  // from rest: 0.1 N and 7 mN m per millisecond
    const Wrench acts = hardware.act(wanted, 1e-3);
    EXPECT_NEAR(acts.force.x(), std::min(0.1 * i, 0.35), 1e-15);
    EXPECT_NEAR(acts.force.y(), -0.05, 1e-15);
    EXPECT_NEAR(acts.torque.z(), std::min(0.007 * i, 0.01), 1e-15);
  }
  hardware.reset();
  EXPECT_NEAR(hardware.act(wanted, 2e-3).force.x(), 0.2, 1e-15);
}

TEST(Hardware, SettingsMustBeFiniteAndNotNegative) {
  EXPECT_TRUE(HardwareSettings().violations().empty());
  HardwareSettings settings;
  settings.force.noise = -1.0;
  settings.orientation.resolution = std::numeric_limits<double>::quiet_NaN();
  settings.actuator_latency = std::numeric_limits<double>::infinity();
  settings.torque_rate = -1e-9;
  const auto found = settings.violations();
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].key, "hardware.orientation_resolution");
  EXPECT_EQ(found[1].key, "hardware.force_noise");
  EXPECT_EQ(found[2].key, "hardware.actuator_latency");
  EXPECT_EQ(found[3].key, "hardware.torque_rate");
}

TEST(Hardware, ASkinIsReadAtItsRateAndLate) {
  HardwareSettings settings;
  settings.taxel_rate = 400.0;
  settings.taxel_latency = 2e-3;
  Hardware hardware(settings, 20.0, 1.0);
  // New ones at 0, 3, 5, 8, 10 ms, the first calls after a multiple of 2.5 ms.
  const std::vector<double> told = {0, 0, 0, 0, 0, 3, 3, 5, 5, 5, 8, 8, 10};
  Measurement m = truth();
  for (std::size_t i = 0; i < told.size(); ++i) {
    m.time = 1e-3 * double(i);
    m.taxels = {{double(i), 2.0 * double(i), 3.0 * double(i)}};
    const Measurement seen = hardware.sense(m);
    EXPECT_EQ(seen.taxels.at(0).normal_stress, told[i]) << i;
    EXPECT_EQ(seen.taxels.at(0).shear_v, 3.0 * told[i]) << i;
  }
  hardware.reset();
  EXPECT_EQ(hardware.sense(m).taxels.at(0).normal_stress, 12.0);
}

TEST(Hardware, ASkinHasNoiseAndSteps) {
  HardwareSettings settings;
  settings.taxel = {5.0, 0.5};
  Hardware hardware(settings, 20.0, 1.0);
  Measurement m = truth();
  m.taxels = {{100.0, -20.0, 0.0}};
  const Statistics seen(hardware, m, 4000, [](const Measurement& of) {
    return Vector3(of.taxels[0].normal_stress, of.taxels[0].shear_u, of.taxels[0].shear_v);
  });
  EXPECT_NEAR(seen.mean.norm(), 0.0, 0.4);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(std::sqrt(seen.covariance(axis, axis)), 5.0, 0.3) << axis;
  const double read = hardware.sense(m).taxels[0].normal_stress;
  EXPECT_EQ(read, 0.5 * std::round(read / 0.5));
}

TEST(Hardware, WithoutASkinNothingIsFelt) {
  HardwareSettings settings;
  settings.taxel.noise = 1.0;
  EXPECT_TRUE(Hardware(settings, 20.0, 1.0).sense(truth()).taxels.empty());
}
