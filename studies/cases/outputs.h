/// What a case's run writes: tables with a row per run and depth, and summary.json.
#pragma once

#include <nlohmann/json.hpp>

#include "studies/cases/planner.h"

namespace fingertip::studies {

/// The columns a table may have, by their heads.
std::vector<std::string> table_columns();

/// Writes variants.csv, transfer.csv and the tables that the case asks for into `folder`, those
/// that have rows. Cells are empty where a press did not get that far.
void write_tables(const Case& one, const RunResults& results, const std::filesystem::path& folder);

/// The sections of summary.json that the kinds of the case's runs call for; their fields are in
/// studies/manual/files.md.
nlohmann::ordered_json summary_of(const Case& one, const Planner& planner,
                                  const RunResults& results, const std::filesystem::path& folder);

}  // namespace fingertip::studies
