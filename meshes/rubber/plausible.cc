#include "meshes/rubber/plausible.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace fingertip::meshes::inline rubber {

namespace {

/// "20 kPa"
std::string in_words(double modulus) {
  const auto [unit, name] = modulus < 1e3   ? std::pair(1.0, " Pa")
                            : modulus < 1e6 ? std::pair(1e3, " kPa")
                            : modulus < 1e9 ? std::pair(1e6, " MPa")
                                            : std::pair(1e9, " GPa");
  std::ostringstream text;
  text.precision(4);
  text << modulus / unit << name;
  return text.str();
}

}  // namespace

std::string implausible_modulus(double youngs_modulus) {
  const bool soft = youngs_modulus < lowest_youngs_modulus;
  if (!(youngs_modulus > 0.0) || !std::isfinite(youngs_modulus) ||
      (!soft && youngs_modulus <= highest_youngs_modulus))
    return {};
  double meant = youngs_modulus, factor = 1.0;
  while (meant < lowest_youngs_modulus || meant > highest_youngs_modulus) {
    meant = soft ? 1e3 * meant : 1e-3 * meant;
    factor *= 1e3;
  }
  std::ostringstream off;
  off.precision(12);
  off << factor;
  return "E = " + in_words(youngs_modulus) + " is no rubber's, which lies between " +
         in_words(lowest_youngs_modulus) + " and " + in_words(highest_youngs_modulus) +
         ": most likely a unit (Pa, kPa, MPa, GPa) is wrong by a factor of " + off.str() +
         ", and " + in_words(meant) + " is meant";
}

}  // namespace fingertip::meshes::inline rubber
