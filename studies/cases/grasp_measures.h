/// What grasps are judged by.
#pragma once

#include "studies/cases/judged_runs.h"
#include "studies/files/grasp_summary.h"

namespace fingertip::studies {

/// What a grasp of a case may be measured by (studies/cases/README.md says what each is).
const std::vector<std::string>& grasp_measures();

/// Of a grasp that came to its end.
RunMeasures measure_grasp(const GraspSummary& summary);

/// How far a series is from the friction limit, where it should begin to hold: the larger of the
/// distances, relative, of its weakest grip that holds and of its strongest that does not. NaN
/// unless there are both, and every grip that holds is stronger than every one that does not.
double limit_error(const std::vector<RunMeasures>& series);

/// All measures a criterion of this case may name: of every grasp by its full name, and of a series
/// the largest of its grasps.
std::vector<std::string> grasp_measure_names(const Case& one);

/// Their values, `grasps` in the order of the case; what could not be taken is absent. A series has
/// a measure when all of its grasps have it.
std::map<std::string, double> take_grasp_measures(const Case& one,
                                                  const std::vector<RunMeasures>& grasps,
                                                  std::size_t not_converged);

}  // namespace fingertip::studies
