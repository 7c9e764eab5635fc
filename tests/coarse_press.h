/// A press that is quick enough for a test.
#pragma once

#include "lattice/model/constants.h"
#include "lattice/press/press_setup.h"

/// Five particles per radius, 5 cm/s, to 0.1 cm, from `clearance` [m].
inline fingertip::lattice::PressSetup coarse_press(double clearance = 0.5e-3) {
  fingertip::lattice::PressSetup setup;
  setup.lattice.spacing = setup.geometry.tip_radius / 5.0;
  setup.lattice.constants =
      fingertip::lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.speed = 0.05;
  setup.protocol.depth = 1e-3;
  setup.protocol.clearance = clearance;
  setup.threads = 1;
  return setup;
}
