/// A press that slips partly: the lattice under Coulomb friction, moving and at rest, against
/// figures of the continuum, which finds equilibria by an active set and shares no code with it.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"

using namespace fingertip;

namespace {

/// Small strain, default specimen, mu = 0.5, from
///   fingertip reference --set press.contact=coulomb --set press.friction=0.5
///     --set 'press.depth="0.2 cm"' --set 'press.lateral="0.1 cm"'
/// (five meshes, at the last two depths four; force_error 0.05, 0.03, 0.5, 0.2 %) and with a
/// lateral motion of 0.2 cm (two meshes; 0.2, 0.3, 0.3 %, none at the last depth).
struct Figure {
  double indentation, normal_force, lateral_force;  ///< [m], [N], [N]
};
struct Condition {
  double lateral;  ///< [m]
  std::array<Figure, 4> figures;
};
constexpr std::array conditions{Condition{1e-3,
                                          {{{1e-3, 0.0327019, 0.00615348},
                                            {4e-3 / 3.0, 0.0537561, 0.00966545},
                                            {5e-3 / 3.0, 0.0792152, 0.01385524},
                                            {2e-3, 0.1086320, 0.01863513}}}},
                                Condition{2e-3,
                                          {{{1e-3, 0.0330796, 0.01225523},
                                            {4e-3 / 3.0, 0.0545475, 0.01924445},
                                            {5e-3 / 3.0, 0.0803908, 0.02733069},
                                            {2e-3, 0.1101015, 0.03653225}}}}};

lattice::PressSetup press_under(const Condition& condition) {
  lattice::PressSetup setup;
  setup.lattice.spacing = 0.01 / 12.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  setup.protocol.contact = meshes::ContactMode::coulomb;
  setup.protocol.friction = 0.5;
  setup.protocol.lateral = condition.lateral;
  setup.protocol.depth = 2e-3;
  setup.protocol.samples.clear();
  for (const Figure& figure : condition.figures)
    setup.protocol.samples.push_back(figure.indentation);
  return setup;
}

}  // namespace

TEST(SlidingPress, TheLatticeAtRestSlipsAsTheContinuumDoes) {
  for (const Condition& condition : conditions) {
    lattice::PressSetup setup = press_under(condition);
    setup.protocol.mode = meshes::DriveMode::equilibrium;
    const lattice::StaticOutcome outcome = lattice::run_static_press(setup);
    ASSERT_EQ(outcome.response.samples().size(), condition.figures.size());
    for (std::size_t i = 0; i < condition.figures.size(); ++i) {
      const meshes::PressSample& sample = outcome.response.samples()[i];
      const Figure& figure = condition.figures[i];
      EXPECT_NEAR(sample.normal_force, figure.normal_force, 0.01 * figure.normal_force);
      EXPECT_NEAR(sample.lateral_force_x, figure.lateral_force, 0.03 * figure.lateral_force);
    }
  }
}

TEST(SlidingPress, TheLatticeSlipsAsTheContinuumDoes) {
  for (const Condition& condition : conditions) {
    const lattice::PressSetup setup = press_under(condition);
    const lattice::PressOutcome outcome = lattice::run_press(setup);
    const lattice::TraceRow& last = outcome.trace.back();
    EXPECT_GT(last.sliding, last.anchored / 4);  // partial slip
    EXPECT_LT(last.sliding, last.anchored * 3 / 4);
    std::size_t compared = 0;
    for (const meshes::PressSample& sample : outcome.response.samples()) {
      if (compared == condition.figures.size()) break;
      const Figure& figure = condition.figures[compared];
      if (std::abs(sample.indentation - figure.indentation) > 1e-9) continue;
      EXPECT_NEAR(sample.normal_force, figure.normal_force, 0.01 * figure.normal_force);
      EXPECT_NEAR(sample.lateral_force_x, figure.lateral_force, 0.03 * figure.lateral_force);
      ++compared;
    }
    EXPECT_EQ(compared, condition.figures.size());
  }
}
