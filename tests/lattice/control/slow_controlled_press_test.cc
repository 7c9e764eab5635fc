// All speeds, with and without wrench feed-forward and schedule; fine lattices.
#include "controlled_press.h"

using namespace controlled;

TEST(SlowAdaptivePress, HookeanKeepsSpeedAndOrientation) {
  for (const double speed : {0.01, 0.05, 0.20}) {
    for (const double share : {0.0, 1.0}) {
      for (const bool scheduled : {false, true}) {
        expect_the_papers_task(press_of(ModelKind::hookean, 8, speed), share, scheduled);
      }
    }
  }
}

TEST(SlowAdaptivePress, NetworkKeepsSpeedAndOrientation) {
  for (const double speed : {0.01, 0.05, 0.20}) {
    for (const double share : {0.0, 1.0}) {
      expect_the_papers_task(press_of(ModelKind::network, 8, speed), share, true);
    }
  }
}
