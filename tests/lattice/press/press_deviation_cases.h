/// Presses with scaled and with plain masses, side by side.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "lattice/press/press.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/static_press.h"
#include "tests/lattice/presses.h"

namespace press_deviation {

using namespace fingertip;

/// From 0.05 to 0.3 cm, the paper's specimen and rubber.
inline lattice::PressSetup press(lattice::ModelKind model, int per_radius, double speed) {
  lattice::PressSetup setup =
      presses::setup_of({.model = model,
                         .per_radius = double(per_radius),
                         .mode = meshes::DriveMode::pid,
                         .samples = {0.5e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3}});
  setup.protocol.speed = speed;
  return setup;
}

/// Of forces at the output depths, relative to those of `plain`.
inline std::vector<double> measured(const lattice::PressSetup& setup,
                                    const meshes::PressResponse& plain) {
  const meshes::PressResponse scaled = lattice::run_press(setup).response;
  std::vector<double> found;
  for (const double depth : setup.protocol.samples)
    found.push_back(std::abs(scaled.normal_force_at(depth) / plain.normal_force_at(depth) - 1.0));
  return found;
}

/// Every depth at which the force is off by more than is tolerated must be among those that the
/// estimate tells.
inline void expect_told(const lattice::PressSetup& setup, const meshes::PressResponse& plain) {
  const lattice::ScalingChoice choice = lattice::choose_scaling(setup);
  const std::vector<double> off = measured(setup, plain);
  for (std::size_t n = 0; n < off.size(); ++n) {
    if (off[n] <= lattice::tolerated_deviation) continue;
    double estimate = 0.0;
    for (const auto& deviation : choice.deviations) {
      if (deviation.indentation == setup.protocol.samples[n]) estimate = deviation.relative;
    }
    EXPECT_GT(estimate, lattice::tolerated_deviation)
        << setup.protocol.speed << " m/s, " << setup.time_step.value_or(0.0) << " s, "
        << setup.protocol.samples[n] << " m: " << off[n];
  }
}

/// With the chosen step nothing is to be told, and with `steps` what is.
inline void expect_honest(lattice::ModelKind model, int per_radius, double speed,
                          const std::vector<double>& steps) {
  lattice::PressSetup setup = press(model, per_radius, speed);
  const meshes::PressResponse plain = lattice::run_press(setup).response;
  setup.integrator = lattice::Integrator::mass_scaled;
  for (const double off : measured(setup, plain))
    EXPECT_LE(off, lattice::tolerated_deviation) << speed << " m/s at the chosen step";
  for (const double step : steps) {
    setup.time_step = step;
    expect_told(setup, plain);
  }
}

}  // namespace press_deviation
