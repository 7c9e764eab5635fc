// The matrix of speeds, steps, spacings and models (lattice/MEASUREMENTS.md).
#include "press_deviation_cases.h"

using namespace press_deviation;
using lattice::ModelKind;

TEST(PressDeviationMatrix, NothingBeyondTwoPerCentGoesUntold) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
    for (const int per_radius : {6, 8}) {
      for (const double speed : {0.01, 0.02, 0.05, 0.1, 0.2})
        expect_honest(model, per_radius, speed, {1e-3, 5e-4, 2.5e-4, 1.25e-4});
    }
  }
}
