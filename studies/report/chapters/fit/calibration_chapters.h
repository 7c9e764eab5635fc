/// The chapters on fits to curves: what they found, what the data determine, and how far the
/// result carries.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/report/page/document.h"
#include "studies/report/results/calibration_data.h"

namespace fingertip::studies::report::inline chapters::inline fit {

/// Several fits side by side; then chapters of each fit: quality; what was held back; parameters;
/// what was measured; the machine; what the data determine; moduli and surrogate. Those without
/// files have no blocks.
std::vector<Chapter> fit_chapters(const CalibrationData& data);
/// Estimates with intervals, priors, bias and truth; correlation; other minima; where they hold.
Chapter parameter_chapter(const Fit& fit, const std::string& prefix);
/// What the data leave open in words, singular values and the profile; figures' names begin with
/// `prefix`. Without blocks for a fit without parameters.
Chapter identifiability_chapter(const Fit& fit, const std::string& prefix);
/// What further presses would tell, the best one first; `units` of parameters by their names.
Table next_table(const std::vector<calibration::NextEntry>& next,
                 const std::map<std::string, std::string>& units);
/// Of measured presses: files with noise, loop, holds and repeats; the machine and what is like the
/// misfit. Empty where files tell nothing of these.
std::vector<Chapter> measured_chapters(const Fit& fit, const std::string& prefix);
/// Presses that were held back, measured beside foretold. Without blocks where there are none.
Chapter predicted_chapter(const Fit& fit, const std::string& prefix);
/// "E = 3.93 kPa (95 %: 3.8 … 4.1)"
std::string estimate_words(const FitParameter& parameter);
/// Fits against what they predict: table of the worst errors, and errors against indentation.
Chapter transfer_chapter(const CalibrationData& data);
/// The result of one fit in a few sentences, of several how many describe their data.
std::string fits_answer(const CalibrationData& data);
/// Why a run's only fit is not accepted; none: it is, or it is one of several, which a case judges.
std::vector<std::string> fit_failures(const CalibrationData& data);
/// The run's result in one paragraph.
std::string calibration_answer(const CalibrationData& data);
/// What these chapters look for in vain.
std::vector<NotRun> missing_fit_parts(const CalibrationData& data);

}  // namespace fingertip::studies::report::inline chapters::inline fit
