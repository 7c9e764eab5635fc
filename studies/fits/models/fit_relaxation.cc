#include "studies/fits/models/fit_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using calibration::FitBranch;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using calibration::relaxation_parameters;

namespace {

/// Times are sought so far beyond those that the curves tell of.
constexpr double beyond = 30.0;
/// No share is sought beyond these: with more nothing would be left after long times.
constexpr double min_share = 1e-4, max_share = 0.95;
/// Where no hold tells one.
constexpr double usual_share = 0.2;
/// Between starts in time.
constexpr double time_spread = 4.0;
/// Of the time of a loading what its curve resolves.
constexpr double resolved = 0.05;

const std::vector<meshes::RelaxationBranch>& given_branches(const LoadedConfig& loaded) {
  return loaded.config.press.rubber.relaxation.branches;
}

/// The branch, from 0, that a parameter belongs to, and whether it is its time.
std::pair<std::size_t, bool> branch_of(MaterialParameter parameter) {
  const auto place = std::size_t(std::ranges::find(relaxation_parameters, parameter) -
                                 relaxation_parameters.begin());
  return {place / 2, place % 2 == 1};
}

}  // namespace

LoadedConfig in_equilibrium(const LoadedConfig& loaded) {
  return given_branches(loaded).empty() ? loaded : with_sets(loaded, {"rubber.relaxation=[]"});
}

std::vector<MaterialParameter> relaxation_sought(const LoadedConfig& loaded) {
  const std::size_t count =
      std::clamp<std::size_t>(given_branches(loaded).size(), 1, relaxation_parameters.size() / 2);
  return {relaxation_parameters.begin(), relaxation_parameters.begin() + std::ptrdiff_t(2 * count)};
}

std::vector<FitBranch> branches_of(const LoadedConfig& loaded,
                                   const std::vector<FreeParameter>& free) {
  std::vector<FitBranch> branches;
  for (const meshes::RelaxationBranch& given : given_branches(loaded))
    branches.push_back({{given.share}, {given.time}});
  const std::size_t known = branches.size();
  if (2 * known > relaxation_parameters.size())
    throw refused(loaded, "rubber.relaxation", std::to_string(known) + " branches",
                  "a fit to presses knows at most five", "join branches of similar times");
  for (std::size_t k = 0; k < free.size(); ++k) {
    if (!calibration::is_of_the_relaxation(free[k].parameter)) continue;
    const auto [branch, is_time] = branch_of(free[k].parameter);
    if (branch >= branches.size()) branches.resize(branch + 1);
    (is_time ? branches[branch].time : branches[branch].share).place = Eigen::Index(k);
  }
  for (std::size_t i = known; i < branches.size(); ++i)
    if (!branches[i].share.place || !branches[i].time.place)
      throw refused(loaded, "calibration.parameters", "",
                    std::string(calibration::name(
                        relaxation_parameters[2 * i + (branches[i].share.place ? 1 : 0)])) +
                        " is neither free nor given",
                    "free share and time of every branch, or give them in rubber.relaxation");
  if (!branches.empty() && !loaded.config.press.rubber.relaxation.bulk)
    throw refused(loaded, "rubber.relaxation_bulk", "false",
                  "a fit to presses knows a rubber whose moduli all fade alike",
                  "take true, or rubber.relaxation = [] for the moduli after long times");
  return branches;
}

std::array<double, 2> observed_times(const std::vector<FitCurve>& curves) {
  std::array<double, 2> all{std::numeric_limits<double>::infinity(), 0.0};
  for (const Curve& curve : curves) {
    if (curve.time.size() < 2) continue;
    const double deepest = *std::ranges::max_element(curve.x), first = curve.x.front();
    // The loading ends where the way is done, nearly.
    const auto end = std::ranges::find_if(
        curve.x, [&](double x) { return x >= first + 0.99 * (deepest - first); });
    const double begin = curve.time.front(),
                 loading = curve.time[std::size_t(end - curve.x.begin())] - begin;
    all[0] = std::min(all[0], resolved * loading);
    all[1] = std::max(all[1], curve.time.back() - begin);
  }
  return all;
}

void start_branches(const LoadedConfig& loaded, FitInput& input) {
  const std::size_t known = given_branches(loaded).size();
  const std::array<double, 2> times = observed_times(input.curves);
  double fall = usual_share;
  for (const Curve& curve : input.curves)
    if (curve.course.relaxation > 0.0) fall = std::clamp(curve.course.relaxation, 0.05, 0.6);
  const double sought = double(input.branches.size()) - double(known);
  for (FreeParameter& free : input.options.free) {
    if (!calibration::is_of_the_relaxation(free.parameter)) continue;
    const auto [branch, is_time] = branch_of(free.parameter);
    if (is_time) {
      free.lower = times[0] / beyond;
      free.upper = times[1] * beyond;
      // Apart from each other, the fastest first.
      const double share = (double(branch) - double(known) + 0.5) / std::max(1.0, sought);
      free.start = branch < known
                       ? std::clamp(given_branches(loaded)[branch].time, free.lower, free.upper)
                       : times[0] * std::pow(times[1] / times[0], share);
    } else {
      free.lower = min_share;
      free.upper = max_share;
      free.start = branch < known ? std::min(given_branches(loaded)[branch].share, max_share)
                                  : fall / sought;
      free.scale = usual_share;
    }
  }
}

void add_starts_in_time(FitInput& input) {
  std::vector<FreeParameter>& free = input.options.free;
  const auto is_time = [](const FreeParameter& each) {
    return calibration::is_of_the_relaxation(each.parameter) && branch_of(each.parameter).second;
  };
  if (!asks_one_press(input) || std::ranges::none_of(free, is_time)) return;
  for (const double factor : {1.0 / time_spread, time_spread}) {
    Eigen::VectorXd& start = input.options.other_starts.emplace_back(Eigen::Index(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i)
      start(Eigen::Index(i)) =
          is_time(free[i]) ? std::clamp(factor * free[i].start, free[i].lower, free[i].upper)
                           : free[i].start;
  }
}

meshes::Relaxation relaxation_of(const FitInput& input, const Eigen::VectorXd& estimates) {
  meshes::Relaxation relaxation = calibration::relaxation_in(input.branches, estimates);
  std::ranges::sort(relaxation.branches, {}, &meshes::RelaxationBranch::time);
  return relaxation;
}

}  // namespace fingertip::studies::inline fits::inline models
