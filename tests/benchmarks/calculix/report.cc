#include "report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>
#include <ostream>
#include <utility>

namespace fingertip::benchmarks {
namespace {

using Json = nlohmann::json;

constexpr double megabyte = 1e6;
constexpr double centimetre = 0.01;
constexpr std::array clocks{std::pair{"wall", &Cost::wall_seconds},
                            std::pair{"cpu", &Cost::cpu_seconds}};

std::string state(const Cost& cost) {
  if (cost.finished) return "ok";
  if (cost.timed_out) return "not finished";
  return cost.exit_code < 0 ? "ended by a signal" : fmt::format("exit code {}", cost.exit_code);
}

std::string text(const std::optional<TimeToError>& time) {
  if (!time) return "not reached";
  return fmt::format("{}{:.2f} s", time->at_most ? "<= " : "", time->seconds);
}

std::string ratio_text(const std::optional<TimeToError>& first,
                       const std::optional<TimeToError>& second) {
  if (!first || !second) return "unknown";
  return fmt::format("{:.1f}{}", first->seconds / second->seconds,
                     first->at_most || second->at_most ? " (of bounds)" : "");
}

Json to_json(const std::optional<TimeToError>& time) {
  if (!time) return nullptr;
  return {{"seconds", time->seconds}, {"at_most", time->at_most}};
}

Json to_json(const ProgramRuns& program) {
  Json runs = Json::array();
  for (const Measurement& run : program.runs) {
    const auto worst = run.worst_error();
    runs.push_back({{"mesh", run.mesh},
                    {"unknowns", run.unknowns},
                    {"iterations", run.iterations},
                    {"state", state(run.cost)},
                    {"errors", run.errors},
                    {"worst_error", worst ? Json(*worst) : Json(nullptr)},
                    {"wall_seconds", run.cost.wall_seconds},
                    {"cpu_seconds", run.cost.cpu_seconds},
                    {"peak_memory", run.cost.peak_memory}});
  }
  return {{"program", program.name}, {"settings", program.settings}, {"runs", runs}};
}

/// The times of both programs to `target` by one clock.
auto times(const ProgramRuns& first, const ProgramRuns& second, double Cost::*clock,
           double target) {
  return std::pair{time_to_error(first.errors_and_times(clock), target),
                   time_to_error(second.errors_and_times(clock), target)};
}

}  // namespace

std::vector<ErrorAndTime> ProgramRuns::errors_and_times(double Cost::*time) const {
  std::vector<ErrorAndTime> points;
  for (const Measurement& run : runs)
    if (const auto worst = run.worst_error(); worst && run.cost.finished)
      points.push_back({*worst, run.cost.*time});
  return points;
}

void print_runs(std::ostream& out, const ProgramRuns& program, const Truth& truth) {
  out << fmt::format("{}: {}\n", program.name, program.settings)
      << fmt::format("{:>6} {:>9} {:>6} |", "mesh", "unknowns", "iter.");
  for (const double depth : truth.depths) out << fmt::format(" {:>6.3f}", depth / centimetre);
  out << fmt::format(" cm | {:>7} {:>9} {:>9} {:>7}\n", "worst", "wall", "cpu", "memory");
  for (const Measurement& run : program.runs) {
    out << fmt::format("{:>6} {:>9} {:>6} |", run.mesh, run.unknowns, run.iterations);
    for (const double error : run.errors) out << fmt::format(" {:>+6.3f}", 100.0 * error);
    if (run.errors.empty()) out << fmt::format(" {:<{}}", "", 7 * truth.depths.size() - 1);
    const auto worst = run.worst_error();
    out << fmt::format("  % | {:>7} {:>7.2f} s {:>7.2f} s {:>4.0f} MB  {}\n",
                       worst ? fmt::format("{:.3f} %", 100.0 * *worst) : "-", run.cost.wall_seconds,
                       run.cost.cpu_seconds, double(run.cost.peak_memory) / megabyte,
                       state(run.cost));
  }
  out << '\n';
}

void print_times_to_error(std::ostream& out, const ProgramRuns& first, const ProgramRuns& second,
                          const std::vector<double>& targets) {
  for (const double target : targets)
    for (const auto& [label, time] : clocks) {
      const auto [a, b] = times(first, second, time, target);
      out << fmt::format("time to {:g} %, {:<4}: {} {}, {} {}, ratio {}\n", 100.0 * target, label,
                         first.name, text(a), second.name, text(b), ratio_text(a, b));
    }
}

Json to_json(const ProgramRuns& first, const ProgramRuns& second, const Truth& truth,
             const std::vector<double>& targets) {
  Json result{{"depths", truth.depths},
              {"true_forces", truth.forces},
              {"programs", Json::array({to_json(first), to_json(second)})}};
  for (const double target : targets)
    for (const auto& [label, time] : clocks) {
      const auto [a, b] = times(first, second, time, target);
      result["times"].push_back(
          {{"target", target},
           {"clock", label},
           {first.name, to_json(a)},
           {second.name, to_json(b)},
           {"ratio", a && b ? Json(a->seconds / b->seconds) : Json(nullptr)}});
    }
  return result;
}

}  // namespace fingertip::benchmarks
