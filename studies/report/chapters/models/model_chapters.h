/// The chapters on lattices, their studies and costs. One without blocks is left out of the page.
#pragma once

#include <string>

#include "studies/files/displacement_study.h"
#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline models {

/// How the published model's force depends on grid and ligaments.
Chapter published_chapter(const RunData& run);
/// Static lattices on the tip's true surfaces.
Chapter equilibrium_chapter(const RunData& run);
/// Elastic constants against direction, the calibrations and the cubes.
Chapter elasticity_chapter(const RunData& run);
/// A study's static presses against their continua.
Chapter variants_chapter(const RunData& run);
/// Measured displacements beside those of a study's presses and their continua.
Chapter displacements_chapter(const DisplacementStudy& study,
                              const std::vector<DisplacementRow>& points);
/// The study's result in one paragraph.
std::string variants_answer(const RunData& run);
/// Why the models differ, in words.
Chapter reasons_chapter(const RunData& run);
/// Time step, cost, mesh quality, momentum balance.
Chapter cost_chapter(const RunData& run);
/// Versions, host, times, parameters.
Chapter provenance_chapter(const RunData& run);

}  // namespace fingertip::studies::report::inline chapters::inline models
