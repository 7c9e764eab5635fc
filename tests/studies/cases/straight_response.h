/// A response that everyone can work out in the head.
#pragma once

#include "meshes/press/press_response.h"

/// A straight line of the given stiffness [N/m] up to `depth` [m].
inline fingertip::meshes::PressResponse straight(double stiffness, double depth) {
  fingertip::meshes::PressResponse response;
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    fingertip::meshes::PressSample sample;
    sample.indentation = part * depth;
    sample.normal_force = stiffness * sample.indentation;
    response.append(sample);
  }
  return response;
}
