/// What is told of measured presses, put in doubt: are the data far likelier with another contact,
/// size or Poisson's ratio?
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// The contact where somebody told it, and every number of untold_numbers at several other values.
/// Coarse lattices tell how much each changes the forces; the likelihood is that of posterior_of,
/// its mean over the values of a number. Those that count, likeliest first; none are sought where
/// nothing that the fit misses or has moved leaves room for one. `first`: where the search ended;
/// `log` is told of each.
std::vector<calibration::RivalEntry> rivals_of(const FitInput& input, const FitModels& models,
                                               const calibration::CurveFit& first,
                                               const calibration::FitRecord& record,
                                               const std::function<void(const std::string&)>& log);

/// Intervals of the rubber's parameters cover those of the record's rivals.
void take_rivals(calibration::FitRecord& record);

/// One that the data prefer beyond doubt is the first thing that the fit lacks, behind another
/// rubber that explains nearly all.
void accuse_rival(calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
