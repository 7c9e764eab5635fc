#include "studies/report/results/contact_comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "studies/report/results/comparison_data.h"

namespace fingertip::studies::report::inline results {
namespace {

using Field = std::span<const meshes::ContactPoint>;

/// Along each side of a raster, one in the middle.
constexpr Eigen::Index places = 81;

/// That of the sample of a run's press at `depth`; empty without one.
Field field_at(const meshes::PressResponse& response, const std::vector<Field>& fields,
               double depth) {
  const auto samples = response.pressing();
  for (const Field field : fields) {
    const int sample = field.front().sample;
    if (sample < 1 || std::size_t(sample) > samples.size()) continue;
    const double own = samples[std::size_t(sample) - 1].indentation;
    if (std::abs(own - depth) <= rounding_of_depths * std::abs(depth)) return field;
  }
  return {};
}

void draw_maps(ContactsAtDepth& here) {
  const meshes::Raster raster = meshes::raster_around(here.fields, places);
  for (const Field field : here.fields)
    here.maps.push_back(field.empty() ? meshes::ContactMap() : contact_map(field, raster));
}

}  // namespace

meshes::ContactDifference ContactsAtDepth::difference(std::size_t run) const {
  return fields[run].empty() ? meshes::ContactDifference() : difference_of(maps[run], maps.front());
}

ContactComparison compared_contacts(std::vector<RunContact> runs) {
  std::erase_if(runs, [](const RunContact& run) { return run.contact->empty(); });
  ContactComparison comparison{std::move(runs), {}};
  if (comparison.runs.empty()) return comparison;
  std::vector<std::vector<Field>> fields;
  for (const RunContact& run : comparison.runs) fields.push_back(meshes::samples_of(*run.contact));
  const bool alone = comparison.runs.size() == 1;
  for (const meshes::PressSample& sample : comparison.runs.front().response->pressing()) {
    ContactsAtDepth here{sample.indentation, {}, {}};
    for (std::size_t i = 0; i < fields.size(); ++i)
      here.fields.push_back(field_at(*comparison.runs[i].response, fields[i], sample.indentation));
    const auto known = std::ranges::count_if(here.fields, [](Field f) { return !f.empty(); });
    if (here.fields.front().empty() || (!alone && known < 2)) continue;
    if (alone) comparison.depths.clear();
    comparison.depths.push_back(std::move(here));
  }
  for (ContactsAtDepth& here : comparison.depths) draw_maps(here);
  return comparison;
}

}  // namespace fingertip::studies::report::inline results
