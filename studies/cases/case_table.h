/// The table [case] of a case file, from TOML and back.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/cases/case_file.h"

namespace fingertip::studies {

/// Fills title, description, runs, tables, budgets and criteria of `target` from the table [case]
/// of `file`, runs and tables from the core case's where it names no run. Returns every problem
/// with its line.
std::vector<Problem> read_case_table(const std::filesystem::path& file, Case& target);

/// The same as TOML text, which read_case_table understands.
std::string case_toml(const Case& one);

}  // namespace fingertip::studies
