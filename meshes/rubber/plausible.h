/// Young's moduli that rubbers have: beyond, a slip of the unit is likelier than such a rubber.
#pragma once

#include <string>

namespace fingertip::meshes::inline rubber {

/// From the softest gels to rubbers as hard as leather [Pa].
inline constexpr double lowest_youngs_modulus = 1e3, highest_youngs_modulus = 1e8;

/// Of E [Pa] > 0 outside of these: a sentence that no rubber has it, with the nearest value a power
/// of 1000 away that one has. "" of any other number.
std::string implausible_modulus(double youngs_modulus);

}  // namespace fingertip::meshes::inline rubber
