/// The chapters on the continuum and its code.
#pragma once

#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline continuum {

/// The continuum's discretisation error, its meshes, and its contact beside Hertz's.
Chapter continuum_chapter(const RunData& run);
/// The continuum's code against solutions from elsewhere: orders, checks, locking.
Chapter verification_chapter(const RunData& run);

}  // namespace fingertip::studies::report::inline chapters::inline continuum
