/// The rubber's two elastic constants from whichever two were given, and its law.
#pragma once

#include "studies/config/loaded_config.h"

namespace fingertip::studies::inline config {

/// Poisson's ratio taken where E (or hardness) or G is given alone: silicones and natural rubber
/// are nearly incompressible.
inline constexpr double usual_poissons_ratio = 0.49;

/// E [Pa] of a rubber of that Shore A hardness, 0 < S < 100: Gent's formula, from the indentation
/// of a half-space by a truncated cone under the durometer's spring (A. N. Gent, Rubber Chemistry
/// and Technology 31, 896, 1958): E = 0.0981 (56 + 7.62336 S)/(0.137505 (254 - 2.54 S)) MPa. Rough:
/// a point of hardness is 3 to 5 % of E, and durometers differ by some points.
double youngs_modulus_of_hardness(double shore_a);

/// Puts E, G and the law of large strain into config.press.rubber. Given can be E or hardness, G
/// (or the coefficients of a law, which tell it), nu, K: two of the four, one (then nu is
/// `usual_poissons_ratio`, or E the default where nu or K is given; a note tells) or none (the
/// defaults of E and G); another note tells an E that no rubber has. Entries of what follows from
/// others become "auto", so that the resolved configuration can be loaded again. Appends a problem
/// where three are given, both E and hardness, a stiffness beside coefficients, or where a law
/// misses its coefficients.
void resolve_elasticity(LoadedConfig& loaded, std::vector<meshes::Violation>& problems);

/// Settings of with_sets that give the rubber another Poisson's ratio at its E, or where a law's
/// coefficients or a card tell G at that, whatever else was given.
std::vector<std::string> settings_at_ratio(const LoadedConfig& loaded, double poissons_ratio);

}  // namespace fingertip::studies::inline config
