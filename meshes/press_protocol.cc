#include "meshes/press_protocol.h"

#include <cmath>
#include <string>

#include "meshes/files.h"

namespace fingertip::meshes {

namespace {
/// Beyond it the sleeve's end may come near the plane [rad].
constexpr double largest_tilt = 0.7854;
}  // namespace

std::string_view name(ContactMode mode) {
  switch (mode) {
    case ContactMode::stick: return "stick";
    case ContactMode::frictionless: return "frictionless";
    case ContactMode::coulomb: return "coulomb";
  }
  return "";
}

std::string_view name(DriveMode mode) {
  switch (mode) {
    case DriveMode::pid: return "pid";
    case DriveMode::quasi_static: return "quasi-static";
    case DriveMode::equilibrium: return "static";
  }
  return "unknown";
}

std::string_view name(LateralPath path) {
  return path == LateralPath::after ? "after" : "diagonal";
}

PressPath::PressPath(const PressProtocol& protocol)
    : length_(protocol.depth),
      samples_(protocol.samples.empty() ? default_samples(protocol.depth) : protocol.samples) {
  if (!protocol.slides_after()) {
    slope_ = protocol.lateral / protocol.depth;
    return;
  }
  corner_ = protocol.depth;
  lateral_ = protocol.lateral;
  length_ = corner_ + std::abs(lateral_);
  steps_ = protocol.lateral_samples;
  for (int i = 1; i < steps_; ++i) samples_.push_back(corner_ + std::abs(lateral_) * i / steps_);
  samples_.push_back(length_);
}

PressPose PressPath::at(double s) const {
  if (s <= corner_) return {s, slope_ * s};
  // A sample lies where it was asked for, without the rounding of s.
  constexpr double rounding = 1e-9;
  const double step = steps_ * (s - corner_) / (length_ - corner_), whole = std::round(step);
  return {corner_, lateral_ * (std::abs(step - whole) < rounding ? whole : step) / steps_};
}

std::vector<Violation> PressProtocol::violations(const Geometry& geometry) const {
  std::vector<Violation> found;
  const auto require = [&](bool holds, const char* key, std::string value, const char* rule,
                           const char* remedy) {
    if (!holds) found.push_back({key, std::move(value), rule, remedy});
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  require(positive(depth) && depth < geometry.thickness(), "press.depth", to_text(depth) + " m",
          geometry.is_dome()
              ? "the depth must lie between 0 and the rubber's thickness R - r"
              : "the depth must lie between 0 and the height of the pole over the bond",
          "press less deep, or make the rubber thicker");
  require(positive(speed), "press.speed", to_text(speed) + " m/s",
          "the speed must be finite and positive", "give the approach speed");
  require(positive(clearance), "press.clearance", to_text(clearance) + " m",
          "the clearance must be finite and positive",
          "give the gap between pole and plane at the start");
  if (contact == ContactMode::coulomb)
    require(positive(friction), "press.friction", to_text(friction),
            "the coefficient of friction must be finite and positive",
            "choose press.contact = \"frictionless\" for none");
  require(std::abs(tilt) <= largest_tilt, "press.tilt", to_text(tilt) + " rad",
          "the tilt must lie between -45 and 45 degrees", "tilt less");
  require(std::abs(lateral) <= geometry.tip_radius, "press.lateral", to_text(lateral) + " m",
          "the lateral motion must not exceed the tip's radius", "move less far");
  require(lateral_samples > 0, "press.lateral_samples", std::to_string(lateral_samples),
          "a lateral motion needs at least one output", "1 gives its end alone");
  for (Violation& violation : obstacle.violations(geometry, tilt))
    found.push_back(std::move(violation));
  bool increasing = true;
  double previous = 0.0;
  for (const double sample : samples) {
    increasing = increasing && std::isfinite(sample) && sample > previous;
    previous = sample;
  }
  require(increasing, "press.samples", std::to_string(samples.size()) + " depths",
          "sample depths must be positive and increase", "sort them and drop duplicates");
  if (increasing && !samples.empty()) {
    require(samples.back() == depth, "press.samples", to_text(samples.back()) + " m",
            "the last sample must be the depth of the press", "end the samples at press.depth");
  }
  return found;
}

std::vector<double> default_samples(double depth) {
  std::vector<double> samples;
  for (const double thirtieths : {1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0, 25.0}) {
    samples.push_back(depth * thirtieths / 30.0);
  }
  samples.push_back(depth);
  return samples;
}

}  // namespace fingertip::meshes
