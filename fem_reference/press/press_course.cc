#include "fem_reference/press/press_course.h"

#include <algorithm>

namespace fingertip::fem_reference::inline press {

PressCourse::PressCourse(const meshes::PressProtocol& protocol, bool in_time)
    : speed_(protocol.speed), path_(protocol), samples_(path_.samples()) {
  legs_.push_back({});
  if (protocol.program.empty() || !in_time) return;
  motion_.emplace(protocol);
  touch_time_ = motion_->touch_time();
  samples_.clear();
  for (const meshes::MotionSample& sample : motion_->samples())
    samples_.push_back(speed_ * (sample.time - touch_time_));
  legs_.clear();
  for (const meshes::MotionStage& stage : motion_->stages())
    legs_.push_back({std::max(0.0, speed_ * (stage.begin - touch_time_)), stage.speed / speed_});
}

meshes::PressPose PressCourse::at(double s) const {
  if (!motion_) return path_.at(s);
  // A sample lies where it was asked for, without the rounding of s.
  const auto sample = std::ranges::lower_bound(samples_, s);
  const double indentation =
      sample != samples_.end() && *sample == s
          ? motion_->samples()[std::size_t(sample - samples_.begin())].indentation
          : motion_->indentation(touch_time_ + time(s));
  return {indentation, path_.slope() * indentation};
}

double PressCourse::stage(std::size_t sample) const {
  return motion_ ? double(motion_->samples().at(sample).stage) + 1.0 : path_.stage(sample);
}

double PressCourse::acceleration(double s) const {
  return motion_ ? motion_->at(touch_time_ + time(s)).acceleration : 0.0;
}

const PressCourse::Leg& PressCourse::leg(double s) const {
  std::size_t i = 0;
  while (i + 1 < legs_.size() && s > legs_[i + 1].begin) ++i;
  return legs_[i];
}

}  // namespace fingertip::fem_reference::inline press
