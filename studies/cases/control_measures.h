/// What presses in time under their controllers are judged by.
#pragma once

#include "studies/cases/judged_runs.h"

namespace fingertip::studies {

/// What a press of a case may be measured by (studies/cases/README.md says what each is).
const std::vector<std::string>& press_measures();

/// From summary.json and trace.csv in the press's folder.
RunMeasures tracking_measures(const std::filesystem::path& folder);

/// All measures a criterion of this case may name: of every press by its full name, and of a series
/// the largest of its presses.
std::vector<std::string> control_measure_names(const Case& one);

/// Their values, `presses` in the order of the case; what could not be taken is absent. A series
/// has a measure when all of its presses have that are meant to have it.
std::map<std::string, double> take_control_measures(const Case& one,
                                                    const std::vector<RunMeasures>& presses,
                                                    std::size_t not_converged,
                                                    double reference_error);

}  // namespace fingertip::studies
