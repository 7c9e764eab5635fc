/// The chapter on laws of rubber from material tests.
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/law_record.h"
#include "studies/files/folder_reader.h"
#include "studies/report/page/document.h"

namespace fingertip::studies::report::inline chapters::inline fit {

/// laws.json and law_data.csv of a folder; empty where they are not there.
struct LawResult {
  calibration::LawsFile file;
  std::vector<calibration::LawDataRow> rows;

  bool empty() const { return file.laws.empty(); }
  /// The recommended law; the first without one.
  const calibration::LawEntry& taken() const;
};
LawResult read_laws(const std::filesystem::path& folder, FolderReader& reader);

/// Every law that was fitted and its error of each test, the least AICc first.
Table ranking_table(const LawResult& result);
/// Sums of squares over those that others published: rows of laws, a column for each test of each
/// result that has any. Without rows where nobody published any.
Table squares_table(const std::vector<LawResult>& results);
/// Every so many of the rows of a law and a test, the first and the last among them.
std::vector<calibration::LawDataRow> law_rows(const LawResult& result, const std::string& law,
                                              const calibration::LawTestEntry& test,
                                              std::size_t most);

/// Ranking, coefficients, tests measured and computed, what contradicts the law; without blocks for
/// an empty result.
Chapter law_chapter(const LawResult& result);
/// Its law in a sentence.
std::string law_answer(const LawResult& result);
std::vector<NotRun> missing_law_parts(const LawResult& result);

}  // namespace fingertip::studies::report::inline chapters::inline fit
