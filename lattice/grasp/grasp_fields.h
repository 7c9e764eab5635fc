/// The members of a grasp's settings (meshes/press/fields.h).
#pragma once

#include "lattice/grasp/grasp.h"
#include "meshes/press/fields.h"

namespace fingertip::lattice::inline grasp {

FINGERTIP_FIELDS(BlockSettings, mass, width, height, eccentricity);

FINGERTIP_FIELDS(GripSettings, force, closing_speed, time_constant, lift_height, lift_speed,
                 hold_time, release_time, slip_limit, period);

}  // namespace fingertip::lattice::inline grasp
