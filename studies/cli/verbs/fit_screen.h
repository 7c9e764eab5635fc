/// What the screens of a fit and of a plan have in common.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fingertip::studies::inline cli::inline verbs {

/// A value as the table of units shows it, and its unit.
std::pair<double, std::string> as_shown(double value, const std::string& si);

/// Exit code of a fit that failed its own tests, with what that means on stderr; 0 without
/// `failed`. `written`: its material.toml is there; none: no such file comes of the fit.
int verdict(const std::vector<std::string>& failed, bool converged, std::optional<bool> written);

}  // namespace fingertip::studies::inline cli::inline verbs
