/// The variables of the finger as a functional mock-up unit: their order is their value reference.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace fingertip::studies::inline fmu {

struct FmuVariable {
  std::string name, unit, description;
  bool input = false;
};

/// Of a finger with so many taxels in its skin (sensor.taxels).
inline std::vector<FmuVariable> fmu_variables(std::size_t taxels) {
  std::vector<FmuVariable> all{
      {"force_x", "N", "on the rod at its endpoint, held until it is set again", true},
      {"force_y", "N", "", true},
      {"force_z", "N", "", true},
      {"torque_x", "N.m", "on the rod about its endpoint", true},
      {"torque_y", "N.m", "", true},
      {"torque_z", "N.m", "", true},
      {"position_x", "m", "of the rod's endpoint, in the rod's starting axes"},
      {"position_y", "m", ""},
      {"position_z", "m", ""},
      {"orientation_w", "1", "since the start, a unit quaternion"},
      {"orientation_x", "1", ""},
      {"orientation_y", "1", ""},
      {"orientation_z", "1", ""},
      {"velocity_x", "m/s", "of the endpoint"},
      {"velocity_y", "m/s", ""},
      {"velocity_z", "m/s", ""},
      {"angular_velocity_x", "rad/s", ""},
      {"angular_velocity_y", "rad/s", ""},
      {"angular_velocity_z", "rad/s", ""},
      {"bond_force_x", "N", "of the tip on the rod"},
      {"bond_force_y", "N", ""},
      {"bond_force_z", "N", ""},
      {"bond_torque_x", "N.m", "of the tip on the rod, about the endpoint"},
      {"bond_torque_y", "N.m", ""},
      {"bond_torque_z", "N.m", ""},
      {"indentation", "m", "travel since first touch, negative before"},
      {"normal_force", "N", "of the tip on the rod along the obstacle's normal"},
  };
  for (std::size_t i = 1; i <= taxels; ++i) {
    const std::string taxel = "taxel_" + std::to_string(i);
    all.push_back({taxel + "_normal_stress", "Pa", "positive where it is pressed"});
    for (const char* axis : {"u", "v"})
      all.push_back({taxel + "_shear_" + axis, "Pa", "of the obstacle on the skin"});
  }
  return all;
}
inline constexpr std::size_t fmu_inputs = 6;

/// File of the settings among the unit's resources.
inline constexpr const char* fmu_settings = "parameters.toml";

}  // namespace fingertip::studies::inline fmu
