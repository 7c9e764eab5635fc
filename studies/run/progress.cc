#include "studies/run/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace fingertip::studies {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Progress::Progress(ProgressStyle style) : style_(style), start_(Clock::now()), drawn_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::expect(const std::string& job, double weight) {
  const std::lock_guard lock(mutex_);
  parts_[job].weight = weight;
}

void Progress::report(const std::string& job, double fraction, const std::string& stage) {
  const std::lock_guard lock(mutex_);
  Part& part = parts_[job];
  part.fraction = std::clamp(fraction, 0.0, 1.0);
  const bool due = Clock::now() - drawn_ > std::chrono::milliseconds(100) || fraction >= 1.0;
  if (style_ == ProgressStyle::off || !due) return;
  drawn_ = Clock::now();
  if (style_ == ProgressStyle::json) {
    const nlohmann::ordered_json line = {{"job", job},
                                         {"fraction", part.fraction},
                                         {"stage", stage},
                                         {"elapsed", seconds_since(start_)}};
    fmt::print(stderr, "{}\n", line.dump());
  } else {
    draw(job, stage);
  }
  std::fflush(stderr);
}

void Progress::draw(const std::string& job, const std::string& stage) {
  double all = 0.0;
  double done = 0.0;
  for (const auto& [name, part] : parts_) {
    all += part.weight;
    done += part.weight * part.fraction;
  }
  constexpr int width = 30;
  const int filled = all > 0.0 ? int(width * done / all) : 0;
  const std::string bar =
      std::string(std::size_t(filled), '#') + std::string(std::size_t(width - filled), '.');
  const std::string line =
      fmt::format("[{}] {:3.0f} %  {:4.0f} s  {}: {}", bar, all > 0.0 ? 100.0 * done / all : 0.0,
                  seconds_since(start_), job, stage);
  fmt::print(stderr, "\r\033[K{}", line.substr(0, 110));
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::tty) {
    fmt::print(stderr, "\r\033[K");
    std::fflush(stderr);
  }
}

}  // namespace fingertip::studies
