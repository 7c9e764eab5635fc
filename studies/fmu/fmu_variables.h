/// The variables of the finger as a functional mock-up unit: their order is their value reference.
#pragma once

#include <array>
#include <string_view>

namespace fingertip::studies::inline fmu {

struct FmuVariable {
  std::string_view name, unit, description;
  bool input = false;
};

inline constexpr std::array fmu_variables{
    FmuVariable{"force_x", "N", "on the rod at its endpoint, held until it is set again", true},
    FmuVariable{"force_y", "N", "", true},
    FmuVariable{"force_z", "N", "", true},
    FmuVariable{"torque_x", "N.m", "on the rod about its endpoint", true},
    FmuVariable{"torque_y", "N.m", "", true},
    FmuVariable{"torque_z", "N.m", "", true},
    FmuVariable{"position_x", "m", "of the rod's endpoint, in the rod's starting axes"},
    FmuVariable{"position_y", "m", ""},
    FmuVariable{"position_z", "m", ""},
    FmuVariable{"orientation_w", "1", "since the start, a unit quaternion"},
    FmuVariable{"orientation_x", "1", ""},
    FmuVariable{"orientation_y", "1", ""},
    FmuVariable{"orientation_z", "1", ""},
    FmuVariable{"velocity_x", "m/s", "of the endpoint"},
    FmuVariable{"velocity_y", "m/s", ""},
    FmuVariable{"velocity_z", "m/s", ""},
    FmuVariable{"angular_velocity_x", "rad/s", ""},
    FmuVariable{"angular_velocity_y", "rad/s", ""},
    FmuVariable{"angular_velocity_z", "rad/s", ""},
    FmuVariable{"bond_force_x", "N", "of the tip on the rod"},
    FmuVariable{"bond_force_y", "N", ""},
    FmuVariable{"bond_force_z", "N", ""},
    FmuVariable{"bond_torque_x", "N.m", "of the tip on the rod, about the endpoint"},
    FmuVariable{"bond_torque_y", "N.m", ""},
    FmuVariable{"bond_torque_z", "N.m", ""},
    FmuVariable{"indentation", "m", "travel since first touch, negative before"},
    FmuVariable{"normal_force", "N", "of the tip on the rod along the obstacle's normal"},
};
inline constexpr std::size_t fmu_inputs = 6;

/// File of the settings among the unit's resources.
inline constexpr const char* fmu_settings = "parameters.toml";

}  // namespace fingertip::studies::inline fmu
