/// The paper's task on the lattice under the adaptive PID.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "lattice/control/adaptive_pid.h"
#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/lattice/fixtures.h"
#include "tests/lattice/presses.h"

namespace controlled {

using namespace fixtures;
using lattice::AdaptivePid;
using lattice::AdaptiveSettings;
using lattice::ControlTask;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressOutcome;
using lattice::PressSetup;

/// Stick; at speed far enough away that 50 ms pass before the touch.
inline PressSetup press_of(ModelKind kind, int per_radius, double speed) {
  PressSetup setup = presses::setup_of(
      {.model = kind, .per_radius = double(per_radius), .mode = meshes::DriveMode::pid});
  setup.protocol.speed = speed;
  if (speed > 0.02) setup.protocol.clearance = speed > 0.1 ? 15e-3 : 3e-3;
  return setup;
}

/// Differences of the static press's forces, linear in between.
inline lattice::StiffnessSchedule schedule_for(PressSetup setup) {
  setup.protocol.samples.clear();
  for (int i = 1; i <= 10; ++i) setup.protocol.samples.push_back(0.1 * i * setup.protocol.depth);
  const auto samples = lattice::run_static_press(setup).response.samples();
  const double width = 0.1 * setup.protocol.depth;
  std::vector<double> stiffness{0.0};  // at 0 and in the middle of every interval
  double before = 0.0;
  for (const auto& sample : samples) {
    stiffness.push_back((sample.normal_force - before) / width);
    before = sample.normal_force;
  }
  return [stiffness, width](double indentation) {
    const double place = std::min(indentation / width + 0.5, double(stiffness.size()) - 1.001);
    const auto i = std::size_t(place);
    return stiffness[i] + (place - double(i)) * (stiffness[i + 1] - stiffness[i]);
  };
}

struct Tracking {
  double speed = 0.0, at_touch = 0.0, tilt = 0.0;
};

inline Tracking tracking_of(const PressOutcome& outcome, double speed) {
  Tracking worst;
  for (const auto& row : outcome.trace) {
    worst.tilt = std::max(worst.tilt, row.tilt);
    if (row.time < 0.05) continue;
    const double since = row.time - outcome.first_touch_time;
    double& value = since >= 0.0 && since < 0.02 ? worst.at_touch : worst.speed;
    value = std::max(value, std::abs(row.speed - row.commanded_speed) / speed);
  }
  return worst;
}

inline void expect_the_papers_task(PressSetup setup, double share, bool scheduled) {
  setup.controller.bond_compensation = share;
  AdaptiveSettings settings;
  if (scheduled) settings.stiffness = schedule_for(setup);
  setup.make_controller = [&](const ControlTask& task) {
    return std::make_unique<AdaptivePid>(setup.controller, settings, task);
  };
  const PressOutcome outcome = lattice::run_press(setup);
  const double speed = setup.protocol.speed;
  const Tracking tracking = tracking_of(outcome, speed);
  const std::string label = std::string(name(setup.lattice.model)) + ", " + std::to_string(speed) +
                            " m/s, share " + std::to_string(share);
  EXPECT_LT(tracking.speed, 0.01) << label;
  EXPECT_LT(tracking.tilt, 0.05 * 3.14159265 / 180.0) << label;
  EXPECT_EQ(outcome.response.depth(), setup.protocol.depth) << label;
  EXPECT_GT(outcome.first_touch_time, 0.05) << label;
}

}  // namespace controlled
