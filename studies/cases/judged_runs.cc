#include "studies/cases/judged_runs.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

std::vector<std::string> judged_names(const CaseVariant& run) {
  std::vector<std::string> names = {full_name(run)};
  if (!run.series.empty()) names.push_back(run.series);
  return names;
}

void enter(const CaseVariant& run, const std::string& measure, const RunMeasures& measures,
           std::map<std::string, double>& taken) {
  const auto found = measures.find(measure);
  const double value = found == measures.end() ? std::nan("") : found->second;
  for (const std::string& judged : judged_names(run)) {
    const auto [entry, is_new] = taken.insert({judged + "." + measure, value});
    const bool unknown = std::isnan(value) || std::isnan(entry->second);
    if (!is_new) entry->second = unknown ? std::nan("") : std::max(entry->second, value);
  }
}

}  // namespace fingertip::studies
