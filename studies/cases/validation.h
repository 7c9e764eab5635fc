/// The whole path from rubber to report for one case.
#pragma once

#include "studies/cases/case_file.h"
#include "studies/run/session.h"

namespace fingertip::studies {

/// Whether every criterion of the case was met.
enum class Verdict { passed, failed };

/// Fits the central and the hookean lattice, computes the continuum, presses all three lattices,
/// tests cubes, varies what the paper leaves open in the published model, compares, judges, and
/// writes summary.json and report.html into the session's folder. Jobs run side by side, one
/// thread each, and come from the cache when nothing they depend on has changed.
/// Throws what the jobs throw, except that the published and central models may fail to converge:
/// their status then says so.
Verdict validate(Session& session, const Case& one);

}  // namespace fingertip::studies
