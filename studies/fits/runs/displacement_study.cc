#include "studies/fits/runs/displacement_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace fingertip::studies::inline fits::inline runs {

using calibration::DisplacementDistance;
using meshes::Vector3;

std::vector<DisplacementDistance> distances_of(const DisplacementFile& measured,
                                               const MarkerFields& fields) {
  std::vector<DisplacementDistance> found(fields.size());
  for (std::size_t s = 0; s < fields.size(); ++s)
    if (!fields[s].empty())
      found[s] =
          calibration::distance_of(measured.places, measured.samples[s].displacement, fields[s]);
  return found;
}

std::vector<DisplacementRow> rows_of(const DisplacementFile& measured,
                                     const std::vector<DisplacementDistance>& distances,
                                     const MarkerFields& fields, const std::string& name) {
  std::vector<DisplacementRow> rows;
  for (std::size_t s = 0; s < fields.size(); ++s)
    for (std::size_t i = 0; i < fields[s].size(); ++i) {
      const Vector3& seen = distances[s].displacement[i];
      rows.push_back({name, measured.samples[s].indentation, i + 1, measured.places[i], seen,
                      fields[s][i], (seen - fields[s][i]).norm()});
    }
  return rows;
}

std::vector<DisplacementEntry> entries_of(const DisplacementFile& measured,
                                          const std::vector<DisplacementDistance>& distances,
                                          const std::string& name) {
  std::vector<DisplacementEntry> entries;
  for (std::size_t s = 0; s < distances.size(); ++s) {
    const DisplacementDistance& own = distances[s];
    entries.push_back({name, measured.samples[s].indentation, own.rms, own.largest,
                       own.farthest + 1, own.size, own.ratio, own.turn});
  }
  return entries;
}

std::optional<ScatterEntry> scatter_at_rest(const DisplacementFile& measured) {
  if (measured.grid.empty()) return std::nullopt;
  const calibration::GridScatter found = calibration::grid_scatter(measured.grid, measured.places);
  return ScatterEntry{found.rms, found.largest, found.pitch};
}

RatioEntry ratio_entry(const calibration::DisplacementFitFile& fit, const std::string& name,
                       const std::string& folder) {
  return {name,
          folder,
          fit.model,
          fit.strain,
          fmt::format("{}", fmt::join(fit.freed, ", ")),
          fit.poissons_ratio,
          fit.lower,
          fit.upper,
          fit.at_bound,
          fit.noise,
          fit.misfit,
          fit.statement};
}

}  // namespace fingertip::studies::inline fits::inline runs
