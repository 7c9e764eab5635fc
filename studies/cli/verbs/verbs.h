/// The verbs. Each returns an exit code or throws what main maps to one.
#pragma once

#include "studies/cli/command_line/command_line.h"
#include "studies/config/loader.h"

namespace fingertip::studies::inline cli::inline verbs {

/// Ends the verb with exit code 2: what is wrong at `place`, and what to do.
[[noreturn]] inline void refuse(const std::string& place, const std::string& rule,
                                const std::string& remedy) {
  throw ConfigError({"", "", rule, remedy, place});
}

/// The verb that the line names.
int run_verb(const CommandLine& line);

int run_validate(const CommandLine& line);
int run_press(const CommandLine& line);
int run_live(const CommandLine& line);
int run_modes(const CommandLine& line);
int run_grasp(const CommandLine& line);
int run_reference(const CommandLine& line);
int run_calibrate(const CommandLine& line);
/// calibrate with calibration.problem = "material".
int run_material(const CommandLine& line, const LoadedConfig& loaded);
/// calibrate --plan.
int run_plan(const CommandLine& line, const LoadedConfig& loaded);
int run_compare(const CommandLine& line);
int run_report(const CommandLine& line);
int run_limit_surface(const CommandLine& line);
int run_export(const CommandLine& line);
int run_sweep(const CommandLine& line);
int run_check(const CommandLine& line);
int run_shape(const CommandLine& line);
int run_explain(const CommandLine& line);
int run_init(const CommandLine& line);
int run_doctor(const CommandLine& line);
int run_bench(const CommandLine& line);
int run_web(const CommandLine& line);

}  // namespace fingertip::studies::inline cli::inline verbs
