#include "studies/cases/displacement_measures.h"

#include <algorithm>
#include <cmath>

#include "meshes/press/markers.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/force_comparison.h"

namespace fingertip::studies::inline cases {

namespace fs = std::filesystem;
using calibration::DisplacementDistance;

MarkerFields computed_fields(const DisplacementFile& measured, const fs::path& place) {
  const fs::path file = place / "markers.csv";
  return fields_of(fs::exists(file) ? meshes::read_rows<meshes::MarkerRow>(file)
                                    : std::vector<meshes::MarkerRow>(),
                   measured);
}

DisplacementComparison compare_displacements(std::shared_ptr<const DisplacementFile> measured,
                                             const fs::path& press, const fs::path& reference) {
  DisplacementComparison result{
      .press = distances_of(*measured, computed_fields(*measured, press)),
      .reference = distances_of(*measured, computed_fields(*measured, reference))};
  result.measured = std::move(measured);
  return result;
}

double largest_of_samples(const std::vector<DisplacementDistance>& samples,
                          double DisplacementDistance::*number) {
  std::vector<double> values;
  for (const DisplacementDistance& sample : samples) values.push_back(sample.*number);
  return largest(values);
}

double displacement_over_scatter(const DisplacementComparison& comparison) {
  const DisplacementFile& measured = *comparison.measured;
  if (measured.grid.empty()) return meshes::unknown;
  return largest_of_samples(comparison.press, &DisplacementDistance::rms) /
         calibration::grid_scatter(measured.grid, measured.places).rms;
}

double displacement_excess(const DisplacementComparison& comparison) {
  double most = -1.0;
  for (std::size_t s = 0; s < comparison.press.size(); ++s)
    most = larger(most, comparison.press[s].rms / comparison.reference[s].rms - 1.0);
  return comparison.press.empty() ? meshes::unknown : most;
}

}  // namespace fingertip::studies::inline cases
