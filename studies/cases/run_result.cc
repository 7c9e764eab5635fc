#include "studies/cases/run_result.h"

namespace fingertip::studies::inline cases {

RunResults blank_results(const Case& study_case) {
  RunResults results;
  for (const CaseRun& run : study_case.runs) {
    if (!run.is("prediction")) results.push_back({.run = &run});
    for (const CaseRun& prediction : study_case.runs)
      if (is_asked(prediction, run)) results.push_back({.run = &prediction, .fit = &run});
  }
  return results;
}

}  // namespace fingertip::studies::inline cases
