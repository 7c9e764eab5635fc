/// The chapters of the validation report. Each function reads a run and returns the chapter with
/// what there is; a chapter without blocks is left out of the page.
#pragma once

#include <string>
#include <vector>

#include "studies/files/real_time_record.h"
#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::reporting {

/// The result in one paragraph, in words made from the numbers.
std::string answer(const RunData& run, FolderReader& reader);
/// Model × (elastic constants against target, force error at each depth, real-time factor),
/// criteria.
Chapter verdict_chapter(const RunData& run);
/// Force against indentation of continuum and lattices, and the relative error.
Chapter force_chapter(const RunData& run);
/// Speed, tilt and force of the models under the controller.
Chapter control_chapter(const RunData& run);
/// The models at a few moments of their presses.
Chapter snapshots_chapter(const RunData& run);
/// Elastic constants against direction, the calibrations and the cubes.
Chapter elasticity_chapter(const RunData& run);
/// The mesh and the lattices.
Chapter pictures_chapter(const RunData& run);
/// How the published model's force depends on grid and ligaments.
Chapter published_chapter(const RunData& run);
/// Static lattices on the tip's true surfaces.
Chapter equilibrium_chapter(const RunData& run);
/// A study's static presses against their continua.
Chapter variants_chapter(const RunData& run);
/// The study's result in one paragraph.
std::string variants_answer(const RunData& run);
/// Every press of a study with its force errors, as plain text.
std::string variants_text(const RunData& run);
/// Force, contact radius and, from contact.csv, pressure of one press; without blocks when it has
/// no sample. Of a program the force is drawn to its end, from trace.csv where there is one.
Chapter press_chapter(const meshes::PressResponse& response, const std::vector<ContactRow>& contact,
                      const std::vector<lattice::TraceRow>& trace = {});
/// How the press went on after its first loading: its stages, force in time. `files` may be empty,
/// but for a lattice's press. Without blocks when nothing followed.
Chapter program_chapter(const meshes::PressResponse& response, const PressFiles& files);
/// What --real-time chose, and what it costs; without blocks when nothing was tried.
Chapter real_time_chapter(const RealTimeRecord& record);
/// The lateral motion that followed the press; without blocks when none did.
Chapter sliding_chapter(const meshes::PressResponse& response);
/// Its force at full depth in a sentence, and that at the end of a lateral motion in another.
std::string press_answer(const meshes::PressResponse& response);
/// Frequencies and kinds of motion from modes.csv; without blocks when it is empty.
Chapter modes_chapter(const std::vector<VibrationMode>& modes);
std::string modes_answer(const std::vector<VibrationMode>& modes);
/// Why the models differ, in words.
Chapter reasons_chapter(const RunData& run);
/// The continuum's discretisation error, its meshes, and its contact beside Hertz's.
Chapter continuum_chapter(const RunData& run);
/// The continuum's code against solutions from elsewhere: orders, checks, locking.
Chapter verification_chapter(const RunData& run);
/// Time step, cost, mesh quality, momentum balance.
Chapter cost_chapter(const RunData& run);
/// Versions, host, times, parameters.
Chapter provenance_chapter(const RunData& run);
/// What `reader` found damaged, for the page to name.
std::vector<Damaged> damaged_parts(const FolderReader& reader);
/// Everything the chapters look for in vain.
std::vector<NotRun> missing_parts(const RunData& run);

}  // namespace fingertip::studies::reporting
