/// What the pages of this folder are made of besides chapters.
#pragma once

#include <string>
#include <vector>

#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report {

/// The result in one paragraph, in words made from the numbers.
std::string answer(const RunData& run, FolderReader& reader);
/// Model × (elastic constants against target, force error at each depth, real-time factor),
/// criteria.
Chapter verdict_chapter(const RunData& run);
/// Measured displacements beside computed ones; empty for a run that has none.
Chapter own_displacements(const RunData& run, FolderReader& reader);
/// What `reader` found damaged, for the page to name.
std::vector<Damaged> damaged_parts(const FolderReader& reader);
/// Everything the chapters look for in vain.
std::vector<NotRun> missing_parts(const RunData& run);

}  // namespace fingertip::studies::report
