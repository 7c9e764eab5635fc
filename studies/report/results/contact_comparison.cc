#include "studies/report/results/contact_comparison.h"

#include <algorithm>
#include <cmath>

#include "studies/report/results/comparison_data.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline results {
namespace {

using Field = std::span<const meshes::ContactPoint>;

/// That of the sample of a run's press at `depth`; empty without one.
Field field_at(const RunContact& run, double depth) {
  const auto samples = run.response->pressing();
  for (const Field field :
       grouped(*run.contact, [](const auto&a, const auto&b) { return a.sample == b.sample; })) {
    const int sample = field.front().sample;
    if (sample < 1 || std::size_t(sample) > samples.size()) continue;
    const double own = samples[std::size_t(sample) - 1].indentation;
    if (std::abs(own - depth) <= rounding_of_depths * std::abs(depth)) return field;
  }
  return {};
}

}  // namespace

std::vector<ContactsAtDepth> contacts_at_depths(const std::vector<RunContact>& runs) {
  std::vector<ContactsAtDepth> all;
  if (runs.empty()) return all;
  for (const meshes::PressSample& sample : runs.front().response->pressing()) {
    ContactsAtDepth here{sample.indentation, {}, {}};
    for (const RunContact& run : runs) here.fields.push_back(field_at(run, sample.indentation));
    const auto known = std::ranges::count_if(here.fields, [](Field f) { return !f.empty(); });
    if (here.fields.front().empty() || (runs.size() > 1 && known < 2)) continue;
    const meshes::Raster raster = here.raster();
    const meshes::ContactMap first = contact_map(here.fields.front(), raster);
    for (const Field field : here.fields)
      here.differences.push_back(field.empty() ? meshes::ContactDifference{}
                                               : difference_of(contact_map(field, raster), first));
    all.push_back(std::move(here));
  }
  return all;
}

}  // namespace fingertip::studies::report::inline results
