#include "studies/jobs/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace fingertip::studies::inline jobs {

namespace {

/// "about 40 s left"
std::string left(const std::optional<double>& remaining) {
  return remaining ? "about " + rough_duration(*remaining) + " left" : "time left not yet known";
}

}  // namespace

std::optional<double> remaining_time(double elapsed, double done, double left) {
  constexpr double soon = 1.0, little = 0.01;  // [s]; part of the work
  if (!(left > 0.0)) return 0.0;
  if (elapsed < soon || done < little * (done + left)) return {};
  return elapsed * left / done;
}

double next_line(double elapsed) {
  constexpr double first = 10.0, longest = 600.0;  // [s]
  return elapsed + std::clamp(0.25 * elapsed, first, longest);
}

std::string rough_duration(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", std::ceil(seconds));
  const double minutes = std::round(seconds / 60.0);
  if (minutes < 90.0) return fmt::format("{:.0f} min", minutes);
  const double hours = std::floor(minutes / 60.0),
               rest = 10.0 * std::floor((minutes - 60.0 * hours) / 10.0);
  return rest > 0.0 && hours < 10.0 ? fmt::format("{:.0f} h {:.0f} min", hours, rest)
                                    : fmt::format("{:.0f} h", hours);
}

Progress::Progress(ProgressStyle style, std::FILE* out)
    : style_(style), out_(out), start_(Clock::now()), drawn_(start_), next_line_(next_line(0.0)) {}

Progress::~Progress() {
  clear();
}

double Progress::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::expect(const std::string& job, double weight) {
  const std::lock_guard lock(mutex_);
  parts_[job].weight = weight;
}

void Progress::expect_later(double weight) {
  const std::lock_guard lock(mutex_);
  later_ = weight;
}

Progress::Sum Progress::sum() const {
  Sum sum;
  sum.all = later_;
  for (const auto& [name, part] : parts_) {
    const double done = part.weight * part.fraction;
    sum.all += part.weight;
    sum.done += done;
    if (!part.reused) sum.computed += done;
  }
  return sum;
}

void Progress::reused(const std::string& job) {
  {
    const std::lock_guard lock(mutex_);
    parts_[job].reused = true;
  }
  report(job, 1.0, "reused");
}

void Progress::report(const std::string& job, double fraction, const std::string& stage) {
  const std::lock_guard lock(mutex_);
  Part& part = parts_[job];
  part.fraction = std::max(part.fraction, std::min(fraction, 1.0));
  if (due(fraction)) show(job, part, stage);
}

bool Progress::due(double fraction) const {
  if (style_ == ProgressStyle::off) return false;
  if (style_ == ProgressStyle::lines) return elapsed() >= next_line_;
  return Clock::now() - drawn_ > std::chrono::milliseconds(100) || fraction >= 1.0;
}

void Progress::show(const std::string& job, const Part& part, const std::string& stage) {
  drawn_ = Clock::now();
  const Sum all = sum();
  const double taken = elapsed();
  const auto remaining = remaining_time(taken, all.computed, all.all - all.done);
  shown_ = std::max(shown_, all.fraction());
  const double percent = 100.0 * shown_;
  if (style_ == ProgressStyle::json) {
    const nlohmann::ordered_json line = {
        {"job", job},
        {"fraction", part.fraction},
        {"stage", stage},
        {"elapsed", taken},
        {"remaining", remaining ? nlohmann::ordered_json(*remaining) : nlohmann::ordered_json()}};
    fmt::print(out_, "{}\n", line.dump());
  } else if (style_ == ProgressStyle::lines) {
    next_line_ = next_line(taken);
    fmt::print(out_, "fingertip: {:.0f} % after {}, {} ({}: {})\n", percent, rough_duration(taken),
               left(remaining), job, stage);
  } else {
    constexpr int width = 30;
    const int filled = int(width * shown_);
    const std::string bar =
        std::string(std::size_t(filled), '#') + std::string(std::size_t(width - filled), '.');
    const std::string line =
        fmt::format("[{}] {:3.0f} %  {}  {}: {}", bar, percent, left(remaining), job, stage);
    fmt::print(out_, "\r\033[K{}", line.substr(0, 110));
  }
  std::fflush(out_);
}

void Progress::clear() {
  const std::lock_guard lock(mutex_);
  if (style_ == ProgressStyle::tty) {
    fmt::print(out_, "\r\033[K");
    std::fflush(out_);
  }
}

}  // namespace fingertip::studies::inline jobs
