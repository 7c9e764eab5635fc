#include "comparison.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fingertip::benchmarks {
namespace {

constexpr double metres_per_centimetre = 0.01;
constexpr double newtons_per_gram_force = 9.80665e-3;

}  // namespace

Truth read_truth(const std::filesystem::path& file) {
  std::ifstream in(file);
  Truth truth;
  bool header = false;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    if (!header) {
      header = line.starts_with("indentation_cm,normal_force_gf,");
      if (!header) break;
      continue;
    }
    std::istringstream cells(line);
    double depth = 0.0, force = 0.0;
    char comma = 0;
    if (!(cells >> depth >> comma >> force))
      throw std::runtime_error(file.string() + ": no numbers in \"" + line + "\"");
    truth.depths.push_back(depth * metres_per_centimetre);
    truth.forces.push_back(force * newtons_per_gram_force);
  }
  if (truth.depths.empty())
    throw std::runtime_error(file.string() + " is no table of indentation_cm,normal_force_gf");
  return truth;
}

std::optional<double> Measurement::worst_error() const {
  if (errors.empty()) return std::nullopt;
  double worst = 0.0;
  for (const double error : errors) worst = std::max(worst, std::abs(error));
  return worst;
}

std::vector<double> relative_errors(const std::vector<double>& forces, const Truth& truth) {
  if (forces.size() != truth.forces.size()) return {};
  std::vector<double> errors;
  for (std::size_t i = 0; i < forces.size(); ++i)
    errors.push_back(forces[i] / truth.forces[i] - 1.0);
  return errors;
}

std::vector<ErrorAndTime> envelope(std::vector<ErrorAndTime> runs) {
  std::ranges::sort(runs, [](const ErrorAndTime& a, const ErrorAndTime& b) {
    return a.seconds < b.seconds || (a.seconds == b.seconds && a.error < b.error);
  });
  std::vector<ErrorAndTime> best;
  for (const ErrorAndTime& run : runs)
    if (best.empty() || run.error < best.back().error) best.push_back(run);
  return best;
}

std::optional<TimeToError> time_to_error(const std::vector<ErrorAndTime>& runs, double target) {
  const std::vector<ErrorAndTime> best = envelope(runs);
  const auto reached =
      std::ranges::find_if(best, [target](const ErrorAndTime& run) { return run.error <= target; });
  if (reached == best.end()) return std::nullopt;
  if (reached == best.begin()) return TimeToError{reached->seconds, reached->error < target};
  const ErrorAndTime &coarse = *(reached - 1), &fine = *reached;
  const double share = std::log(coarse.error / target) / std::log(coarse.error / fine.error);
  return TimeToError{coarse.seconds * std::pow(fine.seconds / coarse.seconds, share), false};
}

}  // namespace fingertip::benchmarks
