#include "meshes/press/press_protocol.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline press {

namespace {
/// Beyond it the sleeve's end may come near the plane [rad].
constexpr double largest_tilt = 0.7854;

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// Of a program's stages, each told by its number.
class ProgramRules {
 public:
  ProgramRules(const PressProtocol& protocol, const Geometry& geometry)
      : protocol_(protocol), geometry_(geometry) {}

  std::vector<Violation> broken() {
    double reached = -protocol_.clearance, deepest = reached;
    for (const PressStage& stage : protocol_.program) {
      ++number_;
      if (stage.moves()) check_move(stage, reached);
      if (!stage.moves()) check_hold(stage, reached);
      reached = stage.indentation;
      deepest = std::max(deepest, reached);
    }
    if (found_.empty()) check_whole(deepest);
    return std::move(found_);
  }

 private:
  void require(bool holds, const std::string& rule, const std::string& remedy) {
    if (!holds)
      found_.push_back({"press.program", std::to_string(protocol_.program.size()) + " stages",
                        (number_ > 0 ? "stage " + std::to_string(number_) + ": " : "") + rule,
                        remedy});
  }

  void check_move(const PressStage& stage, double reached) {
    const double to = stage.indentation;
    require(is_positive(stage.speed), "the speed of a move must be finite and positive",
            "an indentation below the last one moves up");
    require(to >= -protocol_.clearance && to < geometry_.thickness(),
            "the indentation must lie between minus the clearance, where the rod starts, and the "
            "thickness of the rubber, " +
                to_text(geometry_.thickness()) + " m",
            "press less deep, or lift less far or give a larger press.clearance");
    require(number_ > 1 || to > 0.0, "the first stage must press, to an indentation above 0",
            "begin with the loading");
    require(to != reached, "the move ends where it begins",
            "write [\"hold\", \"1 s\"] to stay, or drop the stage");
    require(stage.hold == 0.0, "a stage moves or holds", "make two stages of it");
  }

  void check_hold(const PressStage& stage, double reached) {
    require(number_ > 1, "a program begins with a move", "press first, then hold");
    require(is_positive(stage.hold), "a hold must take a finite time above 0",
            "give its duration, or drop the stage");
    require(number_ == 1 || stage.indentation == reached, "a hold stays at its indentation",
            "give it that of the stage before");
  }

  void check_whole(double deepest) {
    number_ = 0;
    require(protocol_.depth == deepest,
            "press.depth must be the program's largest indentation, " + to_text(deepest) + " m",
            "leave press.depth out");
    require(protocol_.speed == protocol_.program.front().speed,
            "press.speed must be the speed of the first stage, " +
                to_text(protocol_.program.front().speed) + " m/s",
            "leave press.speed out");
    require(!protocol_.slides_after(), "no lateral motion follows the stages of a program",
            "take press.lateral_path = diagonal, or leave one of the two out");
  }

  const PressProtocol& protocol_;
  const Geometry& geometry_;
  std::size_t number_ = 0;  ///< of the stage, from 1; 0: the whole program
  std::vector<Violation> found_;
};
}  // namespace

PressPath::PressPath(const PressProtocol& protocol)
    : length_(protocol.depth),
      samples_(protocol.samples.empty() ? default_samples(protocol.depth) : protocol.samples) {
  if (!protocol.program.empty()) {
    slope_ = protocol.lateral / protocol.depth;
    samples_.clear();
    length_ = 0.0;
    double from = 0.0, number = 0.0;
    for (const PressStage& stage : protocol.program) {
      ++number;
      if (!stage.moves()) continue;
      for (const double depth : depths_on_the_way(protocol, from, stage.indentation)) {
        samples_.push_back(length_ + std::abs(depth - from));
        sample_depths_.push_back(depth);
        sample_stages_.push_back(number);
      }
      length_ = samples_.back();
      from = stage.indentation;
      moves_.emplace_back(length_, from);
    }
    return;
  }
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

double PressPath::stage(std::size_t sample) const {
  return sample_stages_.empty() ? std::numeric_limits<double>::quiet_NaN()
                                : sample_stages_.at(sample);
}

bool PressPath::bends(double from, double to) const {
  if (from < corner_ && corner_ < to) return true;
  return std::ranges::any_of(moves_,
                             [&](const auto& end) { return from < end.first && end.first < to; });
}

PressPose PressPath::at(double s) const {
  if (!moves_.empty()) {
    // A sample lies where it was asked for, without the rounding of s.
    const auto sample = std::ranges::lower_bound(samples_, s);
    double depth = s;
    if (sample != samples_.end() && *sample == s) {
      depth = sample_depths_[std::size_t(sample - samples_.begin())];
    } else {
      const auto end =
          std::ranges::find_if(moves_, [s](const auto& move) { return s < move.first; });
      const bool first = end == moves_.begin();
      if (end == moves_.end()) {
        depth = moves_.back().second;
      } else if (!first) {
        const auto& [place, from] = *(end - 1);
        depth = from + std::copysign(s - place, end->second - from);
      }
    }
    return {depth, slope_ * depth};
  }
  if (s <= corner_) return {s, slope_ * s};
  // A sample lies where it was asked for, without the rounding of s.
  constexpr double rounding = 1e-9;
  const double step = steps_ * (s - corner_) / (length_ - corner_), whole = std::round(step);
  return {corner_, lateral_ * (std::abs(step - whole) < rounding ? whole : step) / steps_};
}

bool PressProtocol::goes_back() const {
  return !std::ranges::is_sorted(program, {}, &PressStage::indentation);
}

std::vector<Violation> PressProtocol::violations(const Geometry& geometry) const {
  std::vector<Violation> found;
  const auto require = [&](bool holds, const char* key, std::string value, const char* rule,
                           const char* remedy) {
    if (!holds) found.push_back({key, std::move(value), rule, remedy});
  };
  const auto positive = is_positive;
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
  append(found, obstacle.violations(geometry, tilt));
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
  if (!program.empty()) append(found, ProgramRules(*this, geometry).broken());
  return found;
}

std::vector<double> depths_on_the_way(const PressProtocol& protocol, double from, double to) {
  const double same = 1e-9 * protocol.depth;
  std::vector<double> depths;
  for (const double depth :
       protocol.samples.empty() ? default_samples(protocol.depth) : protocol.samples)
    if (depth > std::min(from, to) + same && depth < std::max(from, to) - same)
      depths.push_back(depth);
  if (to < from) std::ranges::reverse(depths);
  depths.push_back(to);
  return depths;
}

std::vector<double> default_samples(double depth) {
  std::vector<double> samples;
  for (const double thirtieths : {1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0, 25.0}) {
    samples.push_back(depth * thirtieths / 30.0);
  }
  samples.push_back(depth);
  return samples;
}

std::vector<double> even_depths(double depth, std::size_t count) {
  std::vector<double> depths;
  for (std::size_t i = 1; i <= count; ++i) depths.push_back(depth * double(i) / double(count));
  return depths;
}

}  // namespace fingertip::meshes::inline press
