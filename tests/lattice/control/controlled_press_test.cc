// Presses of the lattice under the adaptive PID, force and hybrid control.
#include "controlled_press.h"

#include "lattice/control/hybrid_controller.h"

using namespace controlled;
using lattice::ForceSettings;

TEST(AdaptivePress, HookeanKeepsSpeedAndOrientation) {
  expect_the_papers_task(press_of(ModelKind::hookean, 6, 0.05), 0.0, false);
  expect_the_papers_task(press_of(ModelKind::hookean, 6, 0.05), 1.0, false);
  expect_the_papers_task(press_of(ModelKind::hookean, 6, 0.20), 0.0, true);
}

TEST(AdaptivePress, NetworkKeepsSpeedAndOrientation) {
  expect_the_papers_task(press_of(ModelKind::network, 6, 0.05), 0.0, true);
}

TEST(AdaptivePress, TheRelayLeavesNoTraceAndHalfTheStepChangesNothing) {
  PressSetup setup = press_of(ModelKind::hookean, 6, 0.05);
  setup.controller.bond_compensation = 0.0;
  setup.make_controller = [&](const ControlTask& task) {
    auto controller = std::make_unique<AdaptivePid>(setup.controller, AdaptiveSettings{}, task);
    EXPECT_NEAR(controller->relay()->delay, 0.5e-3, 1e-5);
    EXPECT_NEAR(controller->relay()->mass, task.inertia(0, 0), 0.06 * task.inertia(0, 0));
    return controller;
  };
  const PressOutcome coarse = lattice::run_press(setup);
  EXPECT_EQ(coarse.trace.front().time, 0.0);
  EXPECT_EQ(coarse.trace.front().speed, 0.0);
  EXPECT_EQ(coarse.trace.front().elastic_energy, 0.0);
  setup.time_step = 0.5 * coarse.step.step;
  const PressOutcome fine = lattice::run_press(setup);
  for (const double depth : {1e-3, 2e-3, 3e-3}) {
    const double force = fine.response.normal_force_at(depth);
    EXPECT_NEAR(coarse.response.normal_force_at(depth), force, 5e-3 * force) << depth;
  }
}

namespace {

struct ForceOutcome {
  PressOutcome press;
  int switches = 0;
  double highest = 0.0, last = 0.0;
};

/// Under a HybridController that tells how often it changed its mode.
ForceOutcome hybrid_press(PressSetup setup, double duration) {
  ForceOutcome outcome;
  setup.follows_path = false;
  setup.duration = duration;
  class Watched final : public lattice::Controller {
   public:
    Watched(lattice::HybridController controller, int& switches)
        : controller_(std::move(controller)), switches_(switches) {}
    lattice::Command command(const lattice::Measurement& measurement) override {
      const lattice::Command answer = controller_.command(measurement);
      switches_ = controller_.switches();
      return answer;
    }
    void reset() override { controller_.reset(); }
    lattice::ControllerReport report() const override { return controller_.report(); }

   private:
    lattice::HybridController controller_;
    int& switches_;
  };
  setup.make_controller = [&](const ControlTask& task) {
    return std::make_unique<Watched>(
        lattice::HybridController(setup.controller, ForceSettings{}, task), outcome.switches);
  };
  outcome.press = lattice::run_press(setup);
  for (const auto& row : outcome.press.trace) {
    outcome.highest = std::max(outcome.highest, row.normal_force);
    outcome.last = row.normal_force;
  }
  return outcome;
}

}  // namespace

TEST(HybridPress, SwitchesOnceAndHoldsTheForce) {
  for (const double speed : {0.01, 0.05}) {
    PressSetup setup = press_of(ModelKind::hookean, 6, speed);
    setup.hardware.force.noise = 5e-4;
    setup.hardware.tactile = false;
    const ForceOutcome outcome = hybrid_press(setup, speed > 0.02 ? 0.25 : 0.45);
    EXPECT_EQ(outcome.switches, 1) << speed;
    EXPECT_LT(outcome.highest, 1.05 * 0.1) << speed;
    EXPECT_NEAR(outcome.last, 0.1, 2e-3) << speed;
    EXPECT_TRUE(outcome.press.trace.back().force_mode);
    EXPECT_EQ(outcome.press.trace.back().wanted_force, 0.1);
    EXPECT_TRUE(std::isnan(outcome.press.trace.front().wanted_force));
  }
}

TEST(HybridPress, HalfTheStepChangesNothing) {
  const PressSetup setup = press_of(ModelKind::hookean, 6, 0.01);
  const ForceOutcome coarse = hybrid_press(setup, 0.35);
  PressSetup halved = setup;
  halved.time_step = 0.5 * coarse.press.step.step;
  const ForceOutcome fine = hybrid_press(halved, 0.35);
  EXPECT_EQ(coarse.switches, fine.switches);
  // Round-off decides which of them sees the last sample.
  const std::size_t rows = std::min(coarse.press.trace.size(), fine.press.trace.size());
  ASSERT_GE(rows, 351u);
  for (std::size_t i = 0; i < rows; ++i) {
    EXPECT_NEAR(coarse.press.trace[i].normal_force, fine.press.trace[i].normal_force, 5e-3 * 0.1);
  }
}

TEST(ForcePress, ApproachesAndHoldsTheForce) {
  PressSetup setup = press_of(ModelKind::hookean, 6, 0.05);
  setup.follows_path = false;
  setup.duration = 0.25;
  setup.make_controller = [&](const ControlTask& task) {
    return std::make_unique<lattice::ForceController>(setup.controller, ForceSettings{}, task);
  };
  const PressOutcome outcome = lattice::run_press(setup);
  double highest = 0.0;
  for (const auto& row : outcome.trace) highest = std::max(highest, row.normal_force);
  EXPECT_LT(highest, 1.05 * 0.1);
  EXPECT_NEAR(outcome.trace.back().normal_force, 0.1, 2e-3);
  EXPECT_LT(outcome.trace.back().tilt, 1e-6);
}
