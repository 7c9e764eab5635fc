/// Fits of laws to material tests that a case compares: which law meets which test, and which one
/// it foretells.
#pragma once

#include <string>
#include <vector>

#include "studies/report/chapters/fit/law_chapter.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline fit {

/// The fits of a case. Several runs may ask of one and the same fit.
struct MaterialsData {
  struct Fit {
    std::string folder, label;  ///< label: the series of the runs that ask, or a run
    LawResult result;
  };
  std::vector<MaterialRunEntry> runs;
  std::vector<Fit> fits;

  const LawResult& result_of(const MaterialRunEntry& run) const;
};

/// Those that `run` lists in its summary.
MaterialsData read_materials(const RunData& run, FolderReader& reader);

/// Measured and computed stresses of the laws that runs name, what each is measured by, all laws of
/// each fit; without blocks when there are no runs.
Chapter materials_chapter(const MaterialsData& data);
/// The result in one paragraph.
std::string materials_answer(const MaterialsData& data);

}  // namespace fingertip::studies::report::inline chapters::inline fit
