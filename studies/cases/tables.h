/// CSV files with a row per run and depth.
#pragma once

#include "studies/cases/measures.h"
#include "studies/cases/planner.h"

namespace fingertip::studies {

/// The columns a table may have, by their heads.
std::vector<std::string> table_columns();

/// Writes variants.csv, transfer.csv and the tables that the case asks for into `folder`, those
/// that have rows. Cells are empty where a press did not get that far.
void write_tables(const Case& one, const RunResults& results, const std::filesystem::path& folder);

}  // namespace fingertip::studies
