#include "meshes/press/press_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::meshes::inline press {

namespace {

constexpr double longest_rise = 0.030;  // [s]

/// From rest to `speed` within `rise`, and on.
SetPoint risen(double speed, double rise, double time) {
  constexpr double tau = 2.0 * std::numbers::pi;
  if (time <= 0.0) return {};
  if (time >= rise) return {speed * (time - 0.5 * rise), speed, 0.0};
  const double s = time / rise;
  return {speed * rise * (0.5 * s * s + (std::cos(tau * s) - 1.0) / (tau * tau)),
          speed * (s - std::sin(tau * s) / tau), speed / rise * (1.0 - std::cos(tau * s))};
}

/// When `way` [m] is covered from rest [s].
double time_from_rest(double speed, double rise, double way) {
  if (way >= 0.5 * speed * rise) return way / speed + 0.5 * rise;
  double early = 0.0, late = rise;
  for (int halving = 0; halving < 100 && early < late; ++halving) {
    const double middle = 0.5 * (early + late);
    (risen(speed, rise, middle).distance < way ? early : late) = middle;
  }
  return 0.5 * (early + late);
}

/// Along the normal; a move along the plane or about the normal is a hold of its time.
MotionStage stage_of(const PressStage& stage, const PressStage& before, double begin, double from,
                     double longest) {
  MotionStage timed{begin, begin + stage.hold, from, stage.indentation, 0.0, 0.0};
  if (!stage.moves()) return timed;
  if (stage.moves_along_plane()) {
    timed.end += (std::abs(stage.lateral - before.lateral) + std::abs(stage.twist - before.twist)) /
                 stage.speed;
    return timed;
  }
  timed.speed = stage.speed;
  const double way = std::abs(timed.to - from);
  timed.rise = std::min({longest_rise, longest / stage.speed, way / stage.speed});
  timed.end = begin + way / stage.speed + timed.rise;
  return timed;
}

}  // namespace

PressMotion::PressMotion(const PressProtocol& protocol)
    : clearance_(protocol.clearance), stops_(!protocol.program.empty()) {
  if (!stops_) {
    const double rise = std::min(longest_rise, clearance_ / protocol.speed);
    const double end = (clearance_ + protocol.depth) / protocol.speed + 0.5 * rise;
    stages_.push_back({0.0, end, -clearance_, protocol.depth, protocol.speed, rise});
  }
  for (std::size_t i = 0; i < protocol.program.size(); ++i) {
    const bool first = i == 0;
    const PressStage &stage = protocol.program[i], &before = protocol.program[first ? 0 : i - 1];
    const double from = first ? -clearance_ : stages_.back().to;
    const double whole_way = std::abs(stage.indentation - from);
    stages_.push_back(stage_of(stage, before, first ? 0.0 : stages_.back().end, from,
                               first ? clearance_ : whole_way));
  }
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const MotionStage& stage = stages_[i];
    if (stage.moves()) {
      for (const double depth :
           depths_on_the_way(protocol, std::max(stage.from, i ? stage.from : 0.0), stage.to))
        samples_.push_back({time_at(depth, i), depth, i});
    } else {
      for (const double part : default_samples(1.0))
        samples_.push_back({stage.begin + part * (stage.end - stage.begin), stage.to, i});
      samples_.back().time = stage.end;
    }
  }
}

std::size_t PressMotion::stage_at(double time) const {
  std::size_t i = 0;
  while (i + 1 < stages_.size() && time >= stages_[i].end) ++i;
  return i;
}

SetPoint PressMotion::at(double time) const {
  const MotionStage& stage = stages_[stage_at(time)];
  if (!stops_) return risen(stage.speed, stage.rise, time);
  if (time >= stage.end || !stage.moves()) return {clearance_ + stage.to, 0.0, 0.0};
  const double sign = stage.to > stage.from ? 1.0 : -1.0, since = time - stage.begin;
  if (since <= stage.end - stage.begin - stage.rise) {
    const SetPoint point = risen(stage.speed, stage.rise, since);
    return {clearance_ + stage.from + sign * point.distance, sign * point.speed,
            sign * point.acceleration};
  }
  const SetPoint point = risen(stage.speed, stage.rise, stage.end - time);  // backwards in time
  return {clearance_ + stage.to - sign * point.distance, sign * point.speed,
          -sign * point.acceleration};
}

double PressMotion::time_at(double indentation, std::size_t number) const {
  const MotionStage& stage = stages_.at(number);
  const bool falls = stops_ && stage.moves();
  const auto [low, high] = std::minmax(stage.from, stage.to);
  if (!(indentation >= low && (indentation <= high || (!stops_ && stage.moves()))))
    throw std::out_of_range("an indentation of " + to_text(indentation) +
                            " m is no part of stage " + std::to_string(number + 1));
  if (!stage.moves()) return stage.begin;
  if (indentation == stage.to) return stage.end;
  const double way = number == 0 ? clearance_ + indentation : std::abs(indentation - stage.from),
               left = std::abs(stage.to - indentation);
  if (falls && left < 0.5 * stage.speed * stage.rise)
    return stage.end - time_from_rest(stage.speed, stage.rise, left);
  return stage.begin + time_from_rest(stage.speed, stage.rise, way);
}

}  // namespace fingertip::meshes::inline press
