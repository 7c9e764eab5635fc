/// A press that slips partly: the lattice under Coulomb friction, moving and at rest, against
/// figures of the continuum, which finds equilibria by an active set and shares no code with it.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "meshes/press/limit_surface.h"

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

/// Radius of a disc as large as what sticks over the contact's, from
///   fingertip reference --set press.contact=coulomb --set press.friction=0.5
///     --set 'press.program=[["0.2 cm", "1 cm/s"], ["lateral", "1.5 mm", "1 cm/s"]]'
///     --set press.lateral_samples=6 --set reference.tolerance=0.05
/// at each quarter of a millimetre aside.
TEST(SlidingPress, TheLatticeSticksWhereTheContinuumDoes) {
  constexpr std::array sticking{0.907, 0.841, 0.788, 0.727, 0.677, 0.620};
  lattice::PressSetup setup = press_under(conditions.front());
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  setup.protocol.lateral = 0.0;
  setup.protocol.samples = {setup.protocol.depth};
  setup.protocol.program = {{.indentation = setup.protocol.depth, .speed = setup.protocol.speed},
                            {.indentation = setup.protocol.depth,
                             .speed = setup.protocol.speed,
                             .move = meshes::StageMove::lateral,
                             .lateral = 1.5e-3}};
  setup.protocol.lateral_samples = int(sticking.size());
  const auto field = lattice::run_static_press(setup).contact;
  const auto samples = meshes::samples_of(field);
  ASSERT_EQ(samples.size(), 1 + sticking.size());
  const auto radius_of_stick = [](std::span<const meshes::ContactPoint> sample) {
    double stick = 0.0, all = 0.0;
    for (const meshes::ContactPoint& point : sample) {
      all += point.area;
      stick += point.state == meshes::ContactState::stick ? point.area : 0.0;
    }
    return std::sqrt(stick / all);
  };
  EXPECT_NEAR(radius_of_stick(samples[0]), 1.0, 0.01);
  for (std::size_t i = 0; i < sticking.size(); ++i)
    EXPECT_NEAR(radius_of_stick(samples[i + 1]), sticking[i], 0.05) << i;
}

/// Dragged and turned by turns the plane turns, on the whole, about a point beside the contact.
/// Once all slides, force and moment are those at which the contact's own pressure lets go about
/// that point: their means after both, and that at parts of no length.
TEST(SlidingPress, DraggedAndTurnedItHoldsWhatItsPressureTells) {
  lattice::PressSetup setup;
  setup.lattice.spacing = 0.01 / 8.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  setup.protocol.contact = meshes::ContactMode::coulomb;
  setup.protocol.friction = 0.05;
  setup.protocol.depth = 2e-3;
  setup.protocol.samples = {setup.protocol.depth};
  setup.protocol.lateral_samples = 1;
  /// Force in the plane and moment at the end of so many parts.
  const auto held_after = [&](int parts, double away) -> Eigen::Array2d {
    constexpr double turn = 0.5;  // in all, several times what it takes to slide [rad]
    meshes::PressStage stage{.indentation = setup.protocol.depth, .speed = setup.protocol.speed};
    setup.protocol.program = {stage};
    for (int part = 0; part < parts; ++part) {
      stage.move = meshes::StageMove::lateral;
      stage.lateral += away * turn / parts;
      setup.protocol.program.push_back(stage);
      stage.move = meshes::StageMove::twist;
      stage.twist += turn / parts;
      setup.protocol.program.push_back(stage);
    }
    const auto response = lattice::run_static_press(setup).response;
    const meshes::PressSample &dragged = *(response.samples().end() - 2),
                              &turned = response.samples().back();
    return {0.5 * (dragged.force() + turned.force()).head<2>().norm(),
            0.5 * std::abs(dragged.spin_torque + turned.spin_torque)};
  };
  setup.protocol.program.clear();
  const auto field = lattice::run_static_press(setup).contact;
  for (const double away : {1e-3, 3e-3}) {  // of that point from the contact's middle [m]
    const Eigen::Array2d held = 2.0 * held_after(40, away) - held_after(20, away);
    const meshes::LimitPoint told = meshes::limit_point(field, away, 0.5 * std::acos(-1.0));
    const double mu = setup.protocol.friction;
    EXPECT_NEAR(held[0], mu * told.force, 0.03 * mu * told.force);
    EXPECT_NEAR(held[1], mu * told.moment, 0.03 * mu * told.moment);
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
