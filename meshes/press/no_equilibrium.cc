#include "meshes/press/no_equilibrium.h"

#include <cmath>
#include <cstdio>

namespace fingertip::meshes::inline press {

namespace {

std::string text_of(double number, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, number);
  return text;
}

/// press.depth = "6.2 mm", to three digits, no deeper than that.
std::string depth_setting(double indentation) {
  const double depth = 1e3 * indentation,
               unit = std::pow(10.0, std::floor(std::log10(depth)) - 2.0);
  return "press.depth = \"" + text_of(std::floor(depth / unit * (1.0 + 1e-12)) * unit, "%.4g") +
         " mm\"";
}

std::string last_words(const std::string& who, const PressPose& pose, const std::string& why,
                       const std::string& remedy) {
  const double indentation = pose.indentation;
  std::string text =
      who + " found no equilibrium beyond an indentation of " + text_of(indentation, "%.5g") + " m";
  if (pose.lateral != 0.0)
    text += " and a lateral displacement of " + text_of(pose.lateral, "%.5g") + " m";
  if (pose.twist != 0.0) text += " and a twist of " + text_of(pose.twist, "%.5g") + " rad";
  if (!why.empty()) text += " (" + why + ")";
  text += "; press less deep";
  if (indentation > 0.0) text += ", " + depth_setting(indentation);
  if (pose.lateral != 0.0) text += ", move less far";
  if (pose.twist != 0.0) text += ", twist less";
  return text + ", or " + remedy;
}

}  // namespace

NoEquilibrium::NoEquilibrium(const std::string& who, const PressPose& pose, const std::string& why,
                             const std::string& remedy)
    : NoEquilibrium(last_words(who, pose, why, remedy), pose.indentation) {}

}  // namespace fingertip::meshes::inline press
