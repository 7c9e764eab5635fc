/// Case files that a test writes, and what is said against them.
#pragma once

#include <string>

#include "studies/cases/measures.h"
#include "studies/cases/planner.h"
#include "studies/cases/validation.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

/// The case whose table [case] ends with `table`, after a press of two samples and `settings`.
inline fingertip::studies::Case case_with(const TemporaryFolder& folder, const std::string& table,
                                          const std::string& settings = {}) {
  write_text(folder / "case.toml", "[press]\nsamples = [\"0.1 cm\", \"0.2 cm\"]\n" + settings +
                                       "[case]\ntitle = \"t\"\n" + table);
  return fingertip::studies::load_case(folder / "case.toml", {});
}

/// What is said against that case; empty when it is a good one.
inline std::string refusal(const TemporaryFolder& folder, const std::string& table,
                           const std::string& settings = {}) {
  return ::refusal<fingertip::studies::ConfigError>(
      [&] { check_case(case_with(folder, table, settings)); });
}

/// The jobs of its first stage.
inline std::vector<fingertip::studies::PlannedJob> planned_jobs(
    const fingertip::studies::Case& study_case) {
  return fingertip::studies::Planner(study_case).next({});
}

/// A finished run with these measures.
inline fingertip::studies::RunResult finished_run(const fingertip::studies::CaseRun& run,
                                                  const fingertip::studies::Measures& measures) {
  fingertip::studies::RunResult result;
  result.run = &run;
  result.status = fingertip::studies::finished;
  result.measures = measures;
  return result;
}
