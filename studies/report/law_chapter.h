/// The chapter on laws of rubber from material tests.
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/law_record.h"
#include "studies/files/folder_reader.h"
#include "studies/report/document.h"

namespace fingertip::studies::reporting {

/// laws.json and law_data.csv of a folder; empty where they are not there.
struct LawResult {
  calibration::LawsFile file;
  std::vector<calibration::LawDataRow> rows;

  bool empty() const { return file.laws.empty(); }
  /// The recommended law; the first without one.
  const calibration::LawEntry& taken() const;
};
LawResult read_laws(const std::filesystem::path& folder, FolderReader& reader);

/// Ranking, coefficients, tests measured and computed, what contradicts the law; without blocks for
/// an empty result.
Chapter law_chapter(const LawResult& result);
/// Its law in a sentence.
std::string law_answer(const LawResult& result);
std::vector<NotRun> missing_law_parts(const LawResult& result);

}  // namespace fingertip::studies::reporting
