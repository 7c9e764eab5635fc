/// What a case's run writes: tables with a row per run and depth, and summary.json.
#pragma once

#include "studies/cases/planner.h"
#include "studies/files/case_summary.h"

namespace fingertip::studies::inline cases {

/// The columns a table may have, by their heads.
std::vector<std::string> table_columns();

/// Writes variants.csv, later.csv, transfer.csv and the tables that the case asks for into
/// `folder`, those that have rows. Cells are empty where a press did not get that far.
void write_tables(const Case& study_case, const RunResults& results,
                  const std::filesystem::path& folder);

/// What summary.json says: a section for each kind of the case's runs, and the verdict.
CaseSummary summary_of(const Case& study_case, const Planner& planner, const RunResults& results,
                       const std::filesystem::path& folder);

/// Writes it, with the measures of presses and grasps beside their own entries.
void write_summary(const CaseSummary& summary, const RunResults& results,
                   const std::filesystem::path& file);

}  // namespace fingertip::studies::inline cases
