/// The members of a grasp's settings by name and unit (meshes/press/fields.h).
#pragma once

#include "lattice/grasp/grasp.h"
#include "meshes/press/fields.h"

namespace fingertip::lattice::inline grasp {

template <meshes::Fields<BlockSettings> T>
void visit_fields(T& block, auto&& visit) {
  auto& [mass, width, height, eccentricity] = block;
  visit("mass", mass, "kg");
  visit("width", width, "m");
  visit("height", height, "m");
  visit("eccentricity", eccentricity, "m");
}

template <meshes::Fields<GripSettings> T>
void visit_fields(T& grip, auto&& visit) {
  auto& [force, closing_speed, time_constant, lift_height, lift_speed, hold_time, release_time,
         slip_limit, period] = grip;
  visit("force", force, "N");
  visit("closing_speed", closing_speed, "m/s");
  visit("time_constant", time_constant, "s");
  visit("lift_height", lift_height, "m");
  visit("lift_speed", lift_speed, "m/s");
  visit("hold_time", hold_time, "s");
  visit("release_time", release_time, "s");
  visit("slip_limit", slip_limit, "m");
  visit("period", period, "s");
}

}  // namespace fingertip::lattice::inline grasp
