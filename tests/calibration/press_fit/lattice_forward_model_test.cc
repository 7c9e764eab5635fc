/// From parameters to forces: slopes against differences.

#include <gtest/gtest.h>

#include <numbers>

#include "calibration/press_fit/lattice_forward_model.h"
#include "tests/calibration/fit_fixtures.h"

using namespace fit_fixtures;

namespace {

PressSetup tilted(ContactMode contact, ModelKind model = ModelKind::hookean) {
  PressSetup setup = press(contact, model);
  setup.protocol.tilt = 20.0 / 180.0 * std::numbers::pi;
  return setup;
}

PressSetup finite(PressSetup setup) {
  setup.lattice.kinematics = lattice::Kinematics::finite;
  return setup;
}

double default_value(MaterialParameter parameter, const PressSetup& setup) {
  switch (parameter) {
    case youngs_modulus: return rubber.youngs_modulus;
    case shear_modulus:
    case lame_shear: return rubber.shear_modulus;
    case lambda: return rubber.lame_lambda();
    case k1: return setup.lattice.constants.k1;
    case k2: return setup.lattice.constants.k2;
    case kappa: return setup.lattice.constants.kappa;
    default: return 1.0;
  }
}

}  // namespace

/// Central differences of whole presses, truncated at 1e-8 of F; at these depths no contact
/// changes within them.
TEST(ForwardModel, SlopesMeetDifferences) {
  using enum ContactMode;
  const auto network = ModelKind::network;
  const std::vector<std::pair<PressSetup, std::vector<MaterialParameter>>> cases = {
      {press(frictionless), {youngs_modulus, shear_modulus, bond}},
      {press(stick), {shear_modulus, youngs_modulus}},
      {tilted(frictionless), {youngs_modulus, shear_modulus}},
      {tilted(stick), {youngs_modulus, shear_modulus}},
      {press(frictionless), {k1, k2, kappa}},
      {finite(press(frictionless, network)), {youngs_modulus, shear_modulus}},
      {finite(press(stick, network)), {youngs_modulus, shear_modulus}},
      {finite(tilted(frictionless, network)), {lambda, lame_shear, contact}},
      {press(frictionless, ModelKind::central), {k2, k1}}};
  for (std::size_t c = 0; c < cases.size(); ++c) {
    const auto& [setup, parameters] = cases[c];
    LatticeForwardModel model(with_samples(setup, {2.5e-4, 5e-4}), parameters);
    VectorXd p(Index(parameters.size()));
    for (Index j = 0; j < p.size(); ++j) p(j) = default_value(parameters[std::size_t(j)], setup);
    const CurveSlopes at = model.evaluate(p);
    for (Index j = 0; j < p.size(); ++j) {
      VectorXd up = p, down = p;
      up(j) *= 1.0 + 1e-4;
      down(j) *= 1.0 - 1e-4;
      const VectorXd difference =
          (model.evaluate(up).value - model.evaluate(down).value) / (2e-4 * p(j));
      EXPECT_LT((at.jacobian.col(j) - difference).norm() * p(j), 1e-6 * at.value.norm())
          << "case " << c << " by " << name(parameters[std::size_t(j)]);
    }
  }
}
