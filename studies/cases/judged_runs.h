/// Runs that are judged one by one and as members of their series.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/cases/case_file.h"

namespace fingertip::studies {

/// Measures of one run; a measure that it does not have, or that could not be taken, is absent.
using RunMeasures = std::map<std::string, double>;

/// Every name under which the run is judged: its own and that of its series.
std::vector<std::string> judged_names(const CaseVariant& run);

/// Enters `measure` of `run` under all its names; a series has the largest of its runs, and NaN
/// when one of them has none.
void enter(const CaseVariant& run, const std::string& measure, const RunMeasures& measures,
           std::map<std::string, double>& taken);

}  // namespace fingertip::studies
