/// The rigs of measured presses: what of them is free, where a search starts.
#pragma once

#include <cstddef>
#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

/// No compliance is sought beyond it, over reach/force.
inline constexpr double highest_compliance = 0.9;

/// Appends what of the rigs is fitted to the free parameters: an offset of touch, one of force and
/// a drift per curve, a compliance per machine, which one of its files may tell for all. Further
/// rows of a curve have its offsets. Throws InvalidInput where files of one machine say different
/// compliances.
void free_rigs(FitInput& input);

/// Of the fit's free parameters those that the presses themselves depend on; they stand first.
std::size_t material_parameters(const FitInput& input);

/// What rigs are held at or fitted by, for the record of a fit: an entry per curve, of the
/// compliance per machine.
std::vector<calibration::RigValue> rig_values(const FitInput& input);

/// The indentations, > 0, of a curve's values at the start of the search [m]: of a travel before
/// touch a hundredth of the first depth that the press knows.
std::vector<double> depths_of_values(const FitCurve& curve, const Eigen::VectorXd& start);

/// Of something known at the samples of a curve's press, where it has a value: between them
/// straight, constant beyond.
std::vector<double> at_values(const FitCurve& curve, const Eigen::VectorXd& start,
                              const std::vector<double>& at_samples);

}  // namespace fingertip::studies::inline fits::inline models
