/// Presses that were held back from a fit, and what it foretells of them.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "calibration/statistics/forward_model.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// Every press that FitInput::with_held_back has besides, by `record.fit` of `input`, for which
/// `models` answer. Its force is foretold with what the fit leaves open: parameters, what the model
/// may miss and is known to miss, as far as presses share it, factors of repeats, and noise, all as
/// calibration::further_values draws them. What of its machine only its own values tell is
/// estimated from them, by least squares weighed with that scatter, and the intervals are those of
/// what is then left. Presses are computed in `folder`, jobs by `context`; one that fails says so
/// in its entry. `go_on` hears which one is at work; false ends it with Interrupted.
std::vector<calibration::PredictedEntry> predicted(
    const FitInput& input, const FitModels& models, const calibration::FitRecord& record,
    const std::filesystem::path& folder, const JobContext& context,
    const std::function<bool(const std::string& name)>& go_on);

/// One of them, the curve `place` of FitInput::with_held_back, by what answers for all its curves.
calibration::PredictedEntry predicted_press(const FitInput& input, std::size_t place,
                                            const std::vector<calibration::ForwardModel*>& models,
                                            const calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
