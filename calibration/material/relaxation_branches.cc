#include "calibration/material/relaxation_branches.h"

#include <numbers>

#include "calibration/files/words.h"

namespace fingertip::calibration::inline material {

std::vector<std::string> open_branches(const meshes::Relaxation& relaxation,
                                       const std::array<double, 2>& times) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < relaxation.branches.size(); ++i) {
    const double tau = relaxation.branches[i].time;
    const std::string branch =
        "branch " + std::to_string(i + 1) + " of the relaxation, " + rounded(tau, 3) + " s, is ";
    if (tau < times[0])
      found.push_back(branch + "faster than what the data tell, from " + rounded(times[0], 3) +
                      " s on: its share and time are open; a ramp of less than " + rounded(tau, 2) +
                      " s or cycles of about " + rounded(0.5 / (std::numbers::pi * tau), 2) +
                      " Hz would show it");
    else if (tau > times[1])
      found.push_back(branch + "slower than what the data tell, up to " + rounded(times[1], 3) +
                      " s: its share and time, and so the modulus after long times, are open; a "
                      "hold of " +
                      rounded(3.0 * tau, 2) + " s would show it");
  }
  return found;
}

}  // namespace fingertip::calibration::inline material
