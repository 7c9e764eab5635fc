/// The whole path from a case to its report.
#pragma once

#include "studies/cases/case_file.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline cases {

/// Whether every criterion of the case was met.
enum class Verdict { passed, failed };

/// Throws ConfigError for a case that cannot be carried out, with the line of the run that is to
/// blame, or whose data are not at hand.
void check_case(const Case& study_case);

/// Carries out the case's runs (planner.h), judges its criteria, and writes tables, summary.json
/// and report.html into the session's folder. Jobs run side by side, one thread each, and come from
/// the cache when nothing they depend on has changed.
/// Throws what the jobs throw, except that exhibits and the presses of variants may fail to
/// converge: their status then says so.
Verdict validate(Session& session, const Case& study_case);

}  // namespace fingertip::studies::inline cases
