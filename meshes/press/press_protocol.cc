#include "meshes/press/press_protocol.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/files.h"
#include "meshes/press/markers.h"

namespace fingertip::meshes::inline press {

namespace {
/// Beyond it the sleeve's end may come near the plane [rad].
constexpr double largest_tilt = 0.7854;
/// A right angle [rad].
constexpr double largest_twist = 1.5708;

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// Of a program's stages, each told by its number.
class ProgramRules {
 public:
  ProgramRules(const PressProtocol& protocol, const Geometry& geometry)
      : protocol_(protocol), geometry_(geometry) {}

  std::vector<Violation> broken() {
    PressStage reached{.indentation = -protocol_.clearance};
    double deepest = reached.indentation;
    for (const PressStage& stage : protocol_.program) {
      ++number_;
      check_rest(stage, reached);
      if (!stage.moves()) check_hold(stage);
      if (stage.moves() && stage.moves_along_plane()) check_plane_move(stage, reached);
      if (stage.moves() && !stage.moves_along_plane()) check_press(stage, reached.indentation);
      reached = stage;
      deepest = std::max(deepest, stage.indentation);
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

  void check_press(const PressStage& stage, double reached) {
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

  void check_plane_move(const PressStage& stage, const PressStage& reached) {
    require(number_ > 1, "the first stage must press, to an indentation above 0",
            "begin with the loading");
    require(is_positive(stage.speed), "the speed of a move must be finite and positive",
            "a displacement or angle below the last one moves back");
    const bool twist = stage.move == StageMove::twist;
    if (twist)
      require(std::abs(stage.twist) <= largest_twist, "a twist lies between -90 and 90 degrees",
              "twist less");
    else
      require(std::abs(stage.lateral) <= geometry_.tip_radius,
              "the lateral motion must not exceed the tip's radius", "move less far");
    require(twist ? stage.twist != reached.twist : stage.lateral != reached.lateral,
            "the move ends where it begins",
            "write [\"hold\", \"1 s\"] to stay, or drop the stage");
  }

  void check_hold(const PressStage& stage) {
    require(number_ > 1, "a program begins with a move", "press first, then hold");
    require(is_positive(stage.hold), "a hold must take a finite time above 0",
            "give its duration, or drop the stage");
  }

  /// What a stage does not change.
  void check_rest(const PressStage& stage, const PressStage& reached) {
    const bool moves = stage.moves();
    const auto kept = [&](StageMove move, double now, double before) {
      return (moves && stage.move == move) || now == before;
    };
    require(number_ == 1 || (kept(StageMove::press, stage.indentation, reached.indentation) &&
                             kept(StageMove::lateral, stage.lateral, reached.lateral) &&
                             kept(StageMove::twist, stage.twist, reached.twist)),
            "a hold stays at its indentation, and a move changes one thing",
            "give the rest as in the stage before");
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
    require(!protocol_.moves_after(),
            "no lateral motion and no twist follow the stages of a program",
            "make stages of them, [\"lateral\", \"1 mm\", \"1 cm/s\"] or [\"twist\", \"5 deg\", "
            "\"10 deg/s\"]");
    require(protocol_.lateral == 0.0 || !protocol_.has_plane_moves(),
            "press.lateral moves the plane on the way down, lateral stages after it",
            "leave press.lateral out");
  }

  const PressProtocol& protocol_;
  const Geometry& geometry_;
  std::size_t number_ = 0;  ///< of the stage, from 1; 0: the whole program
  std::vector<Violation> found_;
};

/// One way, with the poses at which output is wanted; the last one ends it.
struct Way {
  std::vector<PressPose> poses;
  double stage = std::numeric_limits<double>::quiet_NaN();
};

/// Along the normal, at these depths; `slope` is the lateral displacement per indentation.
Way along_normal(const PressPose& from, const std::vector<double>& depths, double slope) {
  Way way;
  for (const double depth : depths)
    way.poses.push_back({depth, slope == 0.0 ? from.lateral : slope * depth, from.twist});
  return way;
}

/// Along the plane, about its normal, or both, in equal steps.
Way along_plane(const PressPose& from, const PressPose& to, int steps) {
  Way way;
  for (int i = 1; i < steps; ++i) {
    const auto between = [&](double a, double b) { return a + (b - a) * i / steps; };
    way.poses.push_back(
        {to.indentation, between(from.lateral, to.lateral), between(from.twist, to.twist)});
  }
  way.poses.push_back(to);
  return way;
}

std::vector<Way> ways_of(const PressProtocol& protocol) {
  const double diagonal =
      protocol.lateral_path == LateralPath::diagonal ? protocol.lateral / protocol.depth : 0.0;
  const int steps = protocol.lateral_samples;
  std::vector<Way> ways;
  if (protocol.program.empty()) {
    ways.push_back(along_normal(
        {}, protocol.samples.empty() ? default_samples(protocol.depth) : protocol.samples,
        diagonal));
    const PressPose pressed = ways.back().poses.back();
    const bool after = protocol.lateral_path == LateralPath::after;
    if (protocol.moves_after())
      ways.push_back(along_plane(
          pressed, {protocol.depth, after ? protocol.lateral : pressed.lateral, protocol.twist},
          steps));
    return ways;
  }
  PressPose now;
  double number = 0.0;
  for (const PressStage& stage : protocol.program) {
    ++number;
    if (!stage.moves()) continue;
    ways.push_back(
        stage.moves_along_plane()
            ? along_plane(now, {stage.indentation, stage.lateral, stage.twist}, steps)
            : along_normal(now, depths_on_the_way(protocol, now.indentation, stage.indentation),
                           diagonal));
    ways.back().stage = number;
    now = ways.back().poses.back();
  }
  return ways;
}

}  // namespace

PressPath::PressPath(const PressProtocol& protocol) {
  legs_.clear();
  PressPose now;
  double place = 0.0;
  for (const Way& way : ways_of(protocol)) {
    const auto length = [&](const PressPose& to) {
      const double up_or_down = std::abs(to.indentation - now.indentation);
      return up_or_down > 0.0 ? up_or_down
                              : std::abs(to.lateral - now.lateral) +
                                    protocol.depth * std::abs(to.twist - now.twist);
    };
    for (const PressPose& pose : way.poses) {
      samples_.push_back(place + length(pose));
      poses_.push_back(pose);
      if (!std::isnan(way.stage)) stages_.push_back(way.stage);
    }
    const PressPose& to = way.poses.back();
    const double whole = length(to);
    legs_.push_back({place,
                     samples_.back(),
                     now,
                     {(to.indentation - now.indentation) / whole,
                      (to.lateral - now.lateral) / whole, (to.twist - now.twist) / whole}});
    place = samples_.back();
    now = to;
  }
}

double PressPath::stage(std::size_t sample) const {
  return stages_.empty() ? std::numeric_limits<double>::quiet_NaN() : stages_.at(sample);
}

bool PressPath::bends(double from, double to) const {
  return std::any_of(legs_.begin(), legs_.end() - 1,
                     [&](const Leg& leg) { return from < leg.end && leg.end < to; });
}

PressPose PressPath::at(double s) const {
  // A sample lies where it was asked for, without the rounding of s.
  const auto sample = std::ranges::lower_bound(samples_, s);
  if (sample != samples_.end() && *sample == s)
    return poses_[std::size_t(sample - samples_.begin())];
  const auto found = std::ranges::find_if(legs_, [s](const Leg& leg) { return s < leg.end; });
  const Leg& leg = found == legs_.end() ? legs_.back() : *found;
  const double way = s - leg.begin;
  return {leg.from.indentation + way * leg.slope.indentation,
          leg.from.lateral + way * leg.slope.lateral, leg.from.twist + way * leg.slope.twist};
}

bool PressProtocol::has_plane_moves() const {
  return std::ranges::any_of(program, &PressStage::moves_along_plane);
}

bool PressProtocol::twists() const {
  return twist != 0.0 ||
         std::ranges::any_of(program, [](const PressStage& stage) { return stage.twist != 0.0; });
}

std::pair<double, double> PressProtocol::lateral_range() const {
  std::pair<double, double> range = std::minmax(0.0, lateral);
  for (const PressStage& stage : program)
    range = {std::min(range.first, stage.lateral), std::max(range.second, stage.lateral)};
  return range;
}

bool PressProtocol::goes_back() const {
  const auto turns_round = [this](double PressStage::*way) {
    return !std::ranges::is_sorted(program, {}, way) &&
           !std::ranges::is_sorted(program, std::ranges::greater(), way);
  };
  return !std::ranges::is_sorted(program, {}, &PressStage::indentation) ||
         turns_round(&PressStage::lateral) || turns_round(&PressStage::twist);
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
  require(std::abs(twist) <= largest_twist, "press.twist", to_text(twist) + " rad",
          "the twist must lie between -90 and 90 degrees", "twist less");
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
  if (!markers.empty() && geometry.violations().empty())
    append(found, marker_violations(markers, geometry));
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
