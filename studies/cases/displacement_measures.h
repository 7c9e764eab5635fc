/// Displacements of a press's markers beside measured ones.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "calibration/press_fit/displacements.h"
#include "studies/fits/runs/displacement_study.h"

namespace fingertip::studies::inline cases {

/// What was measured and, per sample of it, how far a press is from that; unknown where the press
/// has no such sample.
struct DisplacementComparison {
  std::shared_ptr<const DisplacementFile> measured = nullptr;  ///< null: nothing was
  std::vector<calibration::DisplacementDistance> press, reference;

  bool empty() const { return measured == nullptr; }
};

/// Of a press and of what its forces are measured against, by their run folders; what has no
/// markers.csv is unknown.
DisplacementComparison compare_displacements(std::shared_ptr<const DisplacementFile> measured,
                                             const std::filesystem::path& press,
                                             const std::filesystem::path& reference);

/// Displacements of all points in the press of a run folder, per sample measured; empty where it
/// has none.
MarkerFields computed_fields(const DisplacementFile& measured, const std::filesystem::path& place);

/// The largest of a number of all samples; NaN where one of them is unknown.
double largest_of_samples(const std::vector<calibration::DisplacementDistance>& samples,
                          double calibration::DisplacementDistance::*number);

/// The press's largest rms over that of the points at rest about the grid they were to stand on.
double displacement_over_scatter(const DisplacementComparison& comparison);

/// Largest of all samples: by how much the press is farther off than its reference, over that.
double displacement_excess(const DisplacementComparison& comparison);

}  // namespace fingertip::studies::inline cases
