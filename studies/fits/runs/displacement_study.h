/// Displacements of a press's markers beside measured ones, as files have them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/files/displacement_fit_file.h"
#include "calibration/press_fit/displacements.h"
#include "studies/files/displacement_study.h"
#include "studies/measurements/displacement_file.h"

namespace fingertip::studies::inline fits::inline runs {

/// Displacements [m] of all points, per load measured; empty where they are not known.
using MarkerFields = std::vector<std::vector<meshes::Vector3>>;

/// How far the fields are from what was measured, load by load; unknown where a field is.
std::vector<calibration::DisplacementDistance> distances_of(const DisplacementFile& measured,
                                                            const MarkerFields& fields);

/// Point by point of all loads; `name`: of what computed them.
std::vector<DisplacementRow> rows_of(
    const DisplacementFile& measured,
    const std::vector<calibration::DisplacementDistance>& distances, const MarkerFields& fields,
    const std::string& name);

/// Load by load.
std::vector<DisplacementEntry> entries_of(
    const DisplacementFile& measured,
    const std::vector<calibration::DisplacementDistance>& distances, const std::string& name);

/// None where the points were to stand on no grid.
std::optional<ScatterEntry> scatter_at_rest(const DisplacementFile& measured);

/// `folder`: of the fit, below the run's.
RatioEntry ratio_entry(const calibration::DisplacementFitFile& fit, const std::string& name,
                       const std::string& folder);

}  // namespace fingertip::studies::inline fits::inline runs
