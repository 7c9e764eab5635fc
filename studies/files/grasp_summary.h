/// summary.json of a grasp, SI: what the entries mean, lattice/grasp/grasp.h.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// summary.json of `grasp`.
struct GraspSummary {
  std::string model, contact, status, fate;
  double spacing = meshes::unknown, wanted_force = meshes::unknown, least_force = meshes::unknown,
         least_force_at_rest = meshes::unknown, friction = meshes::unknown,
         lift_height = meshes::unknown, slip_force = meshes::unknown, slip_ratio = meshes::unknown,
         sliding_ratio = meshes::unknown, momentum_defect = meshes::unknown,
         lift_off_time = meshes::unknown, held_force = meshes::unknown, held_load = meshes::unknown,
         held_ratio = meshes::unknown, held_slip = meshes::unknown, coupling = meshes::unknown,
         step = meshes::unknown, simulated_time = meshes::unknown, wall_time = meshes::unknown;
};
FINGERTIP_FIELDS(GraspSummary, model, contact, status, fate, spacing, wanted_force, least_force,
                 least_force_at_rest, friction, lift_height, slip_force, slip_ratio, sliding_ratio,
                 momentum_defect, lift_off_time, held_force, held_load, held_ratio, held_slip,
                 coupling, step, simulated_time, wall_time);

}  // namespace fingertip::studies::inline files
