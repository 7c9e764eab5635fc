/// Columns of quantities in tables that people have written.
#pragma once

#include <string>

#include "meshes/tables/csv_table.h"

namespace fingertip::studies::inline config::inline shapes {

/// What to do about a line that is no row (meshes::read_csv_of_people).
inline constexpr const char* separate_alike =
    "separate the cells of all lines alike, by commas, semicolons or tabs; decimals have a point, "
    "or a comma where semicolons or tabs separate";

/// Refuses the line of names; `head` is one that would do, "r [mm],z [mm]".
[[noreturn]] void refuse_names(const meshes::CsvTable& table, const std::string& value,
                               const std::string& rule, const std::string& remedy);
/// "write r [mm],z [mm], separated by commas, semicolons or tabs".
std::string write_names(const std::string& head);

/// The column `r [mm]` and the SI amount of its unit.
struct QuantityColumn {
  std::string name;  ///< empty: there is none
  double unit = 1.0;
};
/// Throws InvalidInput with the file's line for a unit of another dimension than `si`.
QuantityColumn quantity_column(const meshes::CsvTable& table, const std::string& symbol,
                               const std::string& si, const std::string& head);
/// A length, which must be there.
QuantityColumn length_column(const meshes::CsvTable& table, const std::string& symbol,
                             const std::string& head);

}  // namespace fingertip::studies::inline config::inline shapes
