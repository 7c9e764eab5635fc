/// Tables in CSV files: one line of names with units, then a line per row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fingertip::meshes::inline tables {

/// Numbers beyond it [SI] are damage: their squares and cubes must stay finite.
inline constexpr double largest_plausible = 1e60;

/// What to do about a table that this project has written and cannot read.
inline constexpr const char* write_table_again =
    "the file is truncated or damaged: run again what writes it";

/// A table that knows where its cells stand. Cells are kept as text.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;  ///< each as long as `names`
  std::filesystem::path file = {};
  std::vector<std::size_t> lines = {};  ///< of each row in `file`, counted from 1
  const char* remedy = write_table_again;
  std::size_t names_line = 0;  ///< in `file`, counted from 1

  bool empty() const { return rows.empty(); }
  bool has(const std::string& name) const;
  /// The column as numbers, NaN where a cell is empty; empty when the table is. Throws InvalidInput
  /// naming file, line and column for a column that does not exist and for cells that are no finite
  /// numbers up to `largest_plausible`.
  std::vector<double> numbers(const std::string& name) const;
  /// The same; all NaN when the column does not exist.
  std::vector<double> numbers_if_any(const std::string& name) const;
  /// The column as whole numbers from 0 to `count` - 1; throws InvalidInput like numbers.
  std::vector<std::size_t> indices(const std::string& name, std::size_t count) const;
  /// The column as text, empty where it does not exist.
  std::vector<std::string> texts(const std::string& name) const;
};

/// Cells are separated by commas; quotes may enclose them, "" stands for a quote; blanks around
/// cells, empty lines and lines that start with # are passed over. Throws InvalidInput naming file
/// and line when the file cannot be read, has no line of names, has two columns of one name, a row
/// of another length, or a last line without a line break, as truncated files do. A byte order mark
/// is passed over.
CsvTable read_csv(const std::filesystem::path& file);

/// The same of a table that people have written: the separator is the first of semicolon, tab and
/// comma that stands in the line of names; unless it is the comma, numbers may have decimal commas,
/// which become points; editors and spreadsheets may leave the last line open. Refusals end with
/// `remedy`.
CsvTable read_csv_of_people(const std::filesystem::path& file, const char* remedy);

}  // namespace fingertip::meshes::inline tables
