/// Makes the entries of the verification's tables.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference::inline verification {

/// Name of the mesh of a press in its folder.
inline constexpr const char* verification_mesh = "verification.msh";

/// `value` against `expected`, which is not zero.
inline Check compare(std::string name, std::string quantity, std::string source, double value,
                     double expected, double tolerance) {
  const double error = std::abs(value / expected - 1.0);
  return {std::move(name), std::move(quantity), std::move(source), value, expected,
          error,           tolerance,           error <= tolerance};
}

/// A ratio that should vanish.
inline Check vanishing(std::string name, std::string quantity, std::string source, double value,
                       double tolerance) {
  const double error = std::abs(value);
  return {std::move(name), std::move(quantity), std::move(source), value, 0.0,
          error,           tolerance,           error <= tolerance};
}

}  // namespace fingertip::fem_reference::inline verification
