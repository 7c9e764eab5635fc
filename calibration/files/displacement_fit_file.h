/// displacements.json: Poisson's ratio from measured displacements. SI.
#pragma once

#include <string>
#include <vector>

#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline files {

/// A load of the measured file.
struct LoadEntry {
  double indentation = meshes::unknown;
  std::size_t points = 0, values = 0;  ///< measured, and what the fit takes of them
  double size = meshes::unknown;  ///< rms of the displacements, without the frame's rigid motion
  double rms = meshes::unknown;   ///< of what the best fit leaves of the values, over all points
  double stretch = 1.0;           ///< of the computed field; 1 unless fitted
  double stretch_lower = meshes::unknown, stretch_upper = meshes::unknown;  ///< 95 %
  double slip = 0.0;  ///< share of the way from stick to frictionless; 0 unless fitted
  double slip_lower = meshes::unknown, slip_upper = meshes::unknown;  ///< 95 %
};
consteval auto fields_of(const LoadEntry*) {
  return FINGERTIP_ALL_MEMBERS(LoadEntry, indentation, points, values, size, rms, stretch,
                               stretch_lower, stretch_upper, slip, slip_lower, slip_upper)
      .if_known("stretch_lower stretch_upper slip_lower slip_upper");
}

struct DisplacementFitFile {
  std::string data, model, strain, frame;
  std::vector<std::string> freed;  ///< of "compression", "slip"
  double poissons_ratio = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
  bool at_bound = false;           ///< the interval reaches an end of what is sought
  double noise = meshes::unknown;  ///< deviation of a displacement's component
  double misfit = meshes::unknown, misfit_upper = meshes::unknown, misfit_seen = meshes::unknown;
  double log_evidence = meshes::unknown;
  std::vector<double> asked;  ///< Poisson's ratios at which the model was pressed
  std::vector<LoadEntry> loads;
  std::vector<std::string> failed;
  std::string statement;
};
FINGERTIP_FIELDS(DisplacementFitFile, data, model, strain, frame, freed, poissons_ratio, lower,
                 upper, at_bound, noise, misfit, misfit_upper, misfit_seen, log_evidence, asked,
                 loads, failed, statement);

}  // namespace fingertip::calibration::inline files
