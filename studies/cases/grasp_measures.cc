#include "studies/cases/grasp_measures.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

namespace {

/// |value/wanted - 1|
double relative_error(double value, double wanted) {
  return std::abs(value / wanted - 1.0);
}

/// Names of the series of a case's grasps, once each.
std::vector<std::string> series_of(const Case& one) {
  std::vector<std::string> names;
  for (const CaseVariant& grasp : one.grasps)
    if (!grasp.series.empty() && std::ranges::find(names, grasp.series) == names.end())
      names.push_back(grasp.series);
  return names;
}

}  // namespace

const std::vector<std::string>& grasp_measures() {
  static const std::vector<std::string> names = {
      "held",       "lost",           "slip_error", "sliding_error", "slip_force_error",
      "load_error", "momentum_defect"};
  return names;
}

RunMeasures measure_grasp(const GraspSummary& summary) {
  RunMeasures measures;
  const std::string& fate = summary.fate;
  const double friction = summary.friction;
  measures["held"] = fate == "held" ? 1.0 : 0.0;
  measures["lost"] = fate == "held" ? 0.0 : 1.0;
  measures["surplus"] = summary.wanted_force / summary.least_force - 1.0;
  measures["slip_error"] = relative_error(summary.slip_ratio, friction);
  measures["sliding_error"] = relative_error(summary.sliding_ratio, friction);
  // Where the grip does not fall, the force of slip is the one that was asked for.
  if (fate == "held")
    measures["slip_force_error"] = relative_error(summary.slip_force, summary.least_force_at_rest);
  measures["load_error"] = relative_error(summary.held_load, 1.0);
  measures["momentum_defect"] = summary.momentum_defect;
  std::erase_if(measures, [](const auto& entry) { return !std::isfinite(entry.second); });
  return measures;
}

double limit_error(const std::vector<RunMeasures>& series) {
  double weakest_held = std::nan(""), strongest_lost = std::nan("");
  for (const RunMeasures& grasp : series) {
    if (!grasp.contains("surplus")) return std::nan("");
    const double surplus = grasp.at("surplus");
    if (grasp.at("held") > 0.0)
      weakest_held = std::fmin(weakest_held, surplus);
    else
      strongest_lost = std::fmax(strongest_lost, surplus);
  }
  if (!(weakest_held > strongest_lost)) return std::nan("");
  return std::max(std::abs(weakest_held), std::abs(strongest_lost));
}

std::vector<std::string> grasp_measure_names(const Case& one) {
  std::vector<std::string> names = {"grasps.not_converged"};
  for (const CaseVariant& grasp : one.grasps) {
    for (const std::string& judged : judged_names(grasp)) {
      for (const std::string& measure : grasp_measures()) {
        const std::string name = judged + "." + measure;
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
      }
    }
  }
  for (const std::string& series : series_of(one)) names.push_back(series + ".limit_error");
  return names;
}

std::map<std::string, double> take_grasp_measures(const Case& one,
                                                  const std::vector<RunMeasures>& grasps,
                                                  std::size_t not_converged) {
  std::map<std::string, double> taken;
  taken["grasps.not_converged"] = double(not_converged);
  for (std::size_t i = 0; i < one.grasps.size(); ++i)
    for (const std::string& measure : grasp_measures())
      enter(one.grasps[i], measure, grasps[i], taken);
  for (const std::string& series : series_of(one)) {
    std::vector<RunMeasures> members;
    for (std::size_t i = 0; i < one.grasps.size(); ++i)
      if (one.grasps[i].series == series) members.push_back(grasps[i]);
    taken[series + ".limit_error"] = limit_error(members);
  }
  std::erase_if(taken, [](const auto& entry) { return std::isnan(entry.second); });
  return taken;
}

}  // namespace fingertip::studies
