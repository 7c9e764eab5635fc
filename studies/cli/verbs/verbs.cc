#include "studies/cli/verbs/verbs.h"

#include <map>

namespace fingertip::studies::inline cli::inline verbs {

int run_verb(const CommandLine& line) {
  static const std::map<std::string, int (*)(const CommandLine&)> verbs = {
      {"validate", run_validate},
      {"press", run_press},
      {"live", run_live},
      {"modes", run_modes},
      {"grasp", run_grasp},
      {"reference", run_reference},
      {"calibrate", run_calibrate},
      {"compare", run_compare},
      {"export", run_export},
      {"limit-surface", run_limit_surface},
      {"report", run_report},
      {"check", run_check},
      {"explain", run_explain},
      {"init", run_init},
      {"doctor", run_doctor},
      {"bench", run_bench},
      {"sweep", run_sweep},
      {"shape", run_shape},
      {"web", run_web}};
  return verbs.at(line.verb)(line);
}

}  // namespace fingertip::studies::inline cli::inline verbs
