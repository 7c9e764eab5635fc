/// A press that is coarse enough to run in a test.
#pragma once

#include "lattice/constants.h"
#include "lattice/settings.h"

inline fingertip::lattice::PressSetup coarse_press() {
  fingertip::lattice::PressSetup setup;
  setup.lattice.spacing = setup.geometry.tip_radius / 5.0;
  setup.lattice.constants =
      fingertip::lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.speed = 0.05;
  setup.protocol.depth = 1e-3;
  setup.threads = 1;
  return setup;
}
