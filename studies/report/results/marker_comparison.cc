#include "studies/report/results/marker_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/report/results/comparison_data.h"

namespace fingertip::studies::report::inline results {
namespace {

using meshes::MarkerRow;

/// That of a run's sample beside another press's sample: of its first loading by the indentation,
/// of what followed by the pose. Empty without one.
MarkerField markers_beside(const RunContact& run, const std::vector<MarkerField>& fields,
                           const meshes::PressSample& wanted, bool loading) {
  const auto& samples = run.response->samples();
  const std::size_t pressing = run.response->pressing().size();
  for (const MarkerField field : fields) {
    const std::size_t row = std::size_t(field.front().sample - 1);
    if (row >= samples.size() || loading != (row < pressing)) continue;
    const double off = std::abs(samples[row].indentation - wanted.indentation);
    if (loading ? off <= rounding_of_depths * std::abs(wanted.indentation)
                : samples[row].is_beside(wanted))
      return field;
  }
  return {};
}

/// Whether two tables are of the same markers.
bool same_markers(const std::vector<MarkerRow>& a, const std::vector<MarkerRow>& b) {
  return !marker_differences(meshes::samples_of(a).front(), meshes::samples_of(b).front()).empty();
}

double over_first(const MarkersAtSample& here, double length) {
  const double first = meshes::marker_lengths(here.fields.front()).rms;
  return first > 0.0 ? length / first : meshes::unknown;
}

}  // namespace

double MarkersAtSample::relative(std::size_t run) const {
  return over_first(*this, difference(run).rms);
}

double MarkersAtSample::relative_error(std::size_t run) const {
  return over_first(*this, difference(run).error);
}

MarkerComparison compared_markers(std::vector<RunContact> runs) {
  std::erase_if(runs, [](const RunContact& run) { return !run.markers || run.markers->empty(); });
  if (runs.empty()) return {};
  const std::vector<MarkerRow>& of_first = *runs.front().markers;
  std::erase_if(runs, [&](const RunContact& run) { return !same_markers(*run.markers, of_first); });
  std::vector<std::vector<MarkerField>> fields;
  for (const RunContact& run : runs) fields.push_back(meshes::samples_of(*run.markers));
  const meshes::PressResponse& response = *runs.front().response;
  MarkerComparison comparison{std::move(runs), {}};
  for (const MarkerField field : fields.front()) {
    const std::size_t row = std::size_t(field.front().sample - 1);
    if (row >= response.samples().size()) continue;
    const bool loading = row < response.pressing().size();
    MarkersAtSample here{field.front().sample, field.front().indentation, {field}, {{}}};
    for (std::size_t i = 1; i < fields.size(); ++i) {
      here.fields.push_back(
          markers_beside(comparison.runs[i], fields[i], response.samples()[row], loading));
      here.differences.push_back(meshes::marker_differences(here.fields.back(), field));
    }
    const auto known = std::ranges::count_if(here.fields, [](MarkerField f) { return !f.empty(); });
    if (known > 1 || fields.size() == 1) comparison.samples.push_back(std::move(here));
  }
  return comparison;
}

}  // namespace fingertip::studies::report::inline results
