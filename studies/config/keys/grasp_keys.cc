/// The keys of [grasp].
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

std::vector<Key> grasp_keys() {
  using lattice::BlockSettings, lattice::GripSettings;
  const auto block = [](auto member) { return at(&Config::block, member); };
  const auto grip = [](auto member) { return at(&Config::grip, member); };
  return {
      quantity("grasp", "block_mass", "g", "kg", positive, "mass of the rigid block",
               block(&BlockSettings::mass)),
      quantity("grasp", "block_width", "cm", "m", positive,
               "width of the block between the fingers", block(&BlockSettings::width)),
      quantity("grasp", "block_height", "cm", "m", positive,
               "side of its square faces, for its moment of inertia; contact takes them as endless",
               block(&BlockSettings::height)),
      quantity(
          "grasp", "eccentricity", "cm", "m", not_negative,
          "horizontal distance of the centre of mass from the grip's axis: twists the contacts",
          [](Config& config) -> double& { return config.block.eccentricity.y(); }),
      quantity("grasp", "gravity", "m/s^2", "m/s^2", positive, "acceleration of gravity",
               at(&Config::grasp_gravity)),
      quantity("grasp", "force", "mN", "N", positive,
               "normal force of each finger, kept by force control", grip(&GripSettings::force)),
      quantity("grasp", "closing_speed", "cm/s", "m/s", positive,
               "largest speed of a finger toward the block", grip(&GripSettings::closing_speed)),
      quantity("grasp", "time_constant", "ms", "s", positive,
               "of the force control, at least four controller periods",
               grip(&GripSettings::time_constant)),
      quantity("grasp", "lift_height", "cm", "m", positive, "how far the fingers lift",
               grip(&GripSettings::lift_height)),
      quantity("grasp", "lift_speed", "cm/s", "m/s", positive, "largest speed of the lift",
               grip(&GripSettings::lift_speed)),
      quantity("grasp", "hold_time", "s", "s", not_negative, "how long the block is held",
               grip(&GripSettings::hold_time)),
      quantity("grasp", "release_time", "s", "s", not_negative,
               "then the grip force falls to zero within this time, which tells where the block "
               "slips; 0: the run ends",
               grip(&GripSettings::release_time)),
      quantity("grasp", "slip_limit", "mm", "m", positive,
               "a block that slid farther down the fingers counts as dropped",
               grip(&GripSettings::slip_limit)),
  };
}

}  // namespace fingertip::studies::inline config::inline keys
