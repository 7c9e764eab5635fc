/// Presses of lattices as tests ask for them, and how alike two of them are.
#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "lattice/model/constants.h"
#include "lattice/press/press_setup.h"
#include "meshes/press/press_response.h"

namespace presses {

using namespace fingertip;

/// Constants by the model's own rule; at finite strain where it usually is.
struct Press {
  lattice::ModelKind model = lattice::ModelKind::hookean;
  double per_radius = 6;  ///< cells per radius of the tip
  meshes::ContactMode contact = meshes::ContactMode::stick;
  meshes::DriveMode mode = meshes::DriveMode::equilibrium;
  std::vector<double> samples = {};  ///< [m]; the last is the depth
  std::optional<lattice::Kinematics> kinematics = {};
  meshes::Geometry geometry = {};
};

inline lattice::PressSetup setup_of(const Press& press) {
  using enum lattice::ModelKind;
  lattice::PressSetup setup;
  const bool finite = press.model == published || press.model == network;
  setup.geometry = press.geometry;
  setup.lattice.model = press.model;
  setup.lattice.kinematics =
      press.kinematics.value_or(finite ? lattice::Kinematics::finite : lattice::Kinematics::small);
  const double spacing = setup.lattice.spacing = press.geometry.tip_radius / press.per_radius;
  setup.lattice.constants = press.model == published
                                ? lattice::published_constants(setup.rubber, spacing)
                                : lattice::hookean_constants(setup.rubber, spacing);
  setup.protocol.contact = press.contact;
  setup.protocol.mode = press.mode;
  setup.protocol.samples = press.samples;
  if (!press.samples.empty()) setup.protocol.depth = press.samples.back();
  setup.threads = 1;
  return setup;
}

/// Forces within `share` of the normal force, torques within that times `arm` [m].
inline void expect_same_load(const meshes::PressSample& got, const meshes::PressSample& expected,
                             double share, double arm) {
  const double force = share * expected.normal_force;
  EXPECT_NEAR(got.normal_force, expected.normal_force, force) << expected.indentation;
  EXPECT_NEAR(got.lateral_force_x, expected.lateral_force_x, force) << expected.indentation;
  EXPECT_NEAR(got.lateral_force_y, expected.lateral_force_y, force) << expected.indentation;
  EXPECT_NEAR(got.torque_x, expected.torque_x, force * arm) << expected.indentation;
  EXPECT_NEAR(got.torque_y, expected.torque_y, force * arm) << expected.indentation;
  EXPECT_NEAR(got.torque_z, expected.torque_z, force * arm) << expected.indentation;
}

}  // namespace presses
