/// What the fits of a study say together: how well they predict, and whether they find the truth.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "studies/cases/case_file.h"

namespace fingertip::studies {

/// Largest magnitude of the relative force error of one fit's press under one prediction; NaN
/// where it did not get through.
using TransferErrors = std::vector<std::vector<double>>;  ///< per fit, per prediction

/// A prediction of a series is asked of the fits of that series alone.
inline bool is_asked(const CaseVariant& prediction, const CaseVariant& fit) {
  return prediction.series.empty() || prediction.series == fit.series;
}

/// All measures a criterion of this case may name (studies/cases/README.md says what each is).
std::vector<std::string> fit_measure_names(const Case& one);

/// Their values; what could not be taken is absent. `calibrations`: calibration.json per fit.
std::map<std::string, double> take_fit_measures(
    const Case& one, const TransferErrors& errors,
    const std::vector<nlohmann::ordered_json>& calibrations);

}  // namespace fingertip::studies
