#include "studies/cases/displacement_measures.h"

#include <algorithm>
#include <cmath>

#include "meshes/press/markers.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/force_comparison.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;
using calibration::DisplacementDistance;
using meshes::Vector3;

/// Displacements of all points in a press, per sample measured; empty where it has none.
std::vector<std::vector<Vector3>> computed_fields(const DisplacementFile& measured,
                                                  const fs::path& place) {
  const fs::path file = place / "markers.csv";
  return fields_of(fs::exists(file) ? meshes::read_rows<meshes::MarkerRow>(file)
                                    : std::vector<meshes::MarkerRow>(),
                   measured);
}

std::vector<DisplacementDistance> distances_in(const DisplacementFile& measured,
                                               const fs::path& place) {
  const auto fields = computed_fields(measured, place);
  std::vector<DisplacementDistance> found(fields.size());
  for (std::size_t s = 0; s < fields.size(); ++s)
    if (!fields[s].empty())
      found[s] =
          calibration::distance_of(measured.places, measured.samples[s].displacement, fields[s]);
  return found;
}

}  // namespace

DisplacementComparison compare_displacements(std::shared_ptr<const DisplacementFile> measured,
                                             const fs::path& press, const fs::path& reference) {
  DisplacementComparison result{.press = distances_in(*measured, press),
                                .reference = distances_in(*measured, reference)};
  result.measured = std::move(measured);
  return result;
}

std::vector<DisplacementRow> displacement_rows(const DisplacementFile& measured,
                                               const std::vector<DisplacementDistance>& distances,
                                               const std::string& name, const fs::path& place) {
  const auto fields = computed_fields(measured, place);
  std::vector<DisplacementRow> rows;
  for (std::size_t s = 0; s < fields.size(); ++s)
    for (std::size_t i = 0; i < fields[s].size(); ++i) {
      const Vector3& seen = distances[s].displacement[i];
      rows.push_back({name, measured.samples[s].indentation, i + 1, measured.places[i], seen,
                      fields[s][i], (seen - fields[s][i]).norm()});
    }
  return rows;
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
