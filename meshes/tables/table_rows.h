/// Tables of structs in CSV files, by the names that file_fields.h gives their members.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/tables/csv_table.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline tables {

/// How many cells a value takes: a vector or pair one for each of its parts.
template <typename Value>
inline constexpr std::size_t cells_of = 1;
template <typename Value, std::size_t count>
inline constexpr std::size_t cells_of<std::array<Value, count>> = count;
template <>
inline constexpr std::size_t cells_of<Eigen::Vector3d> = 3;

/// The name of one column of a field: of a vector "endpoint_x [m]", unless it has a name for each.
template <typename Row, typename Member>
std::string column_name(const Field<Row, Member>& field, std::size_t part) {
  using Value = std::remove_cvref_t<std::invoke_result_t<Member, Row&>>;
  std::string_view names = field.name;
  const bool is_vector = cells_of<Value> == 3 && names.find(',') == names.npos;
  for (std::size_t i = 0; !is_vector && i < part; ++i) names.remove_prefix(names.find(',') + 1);
  std::string name(names.substr(0, names.find(',')));
  if (is_vector) name += std::string("_") + "xyz"[part];
  return field.unit.empty() ? name : name + " [" + std::string(field.unit) + "]";
}

/// Calls use(field, part, value_of) for each column; value_of(row) is a reference to its
/// value.
template <typename Row, typename Use>
void for_each_column(const Use& use) {
  const auto columns_of = [&](const auto& field) {
    using Value = std::remove_cvref_t<std::invoke_result_t<decltype(field.member), Row&>>;
    if constexpr (cells_of<Value> == 1) {
      use(
          field, 0, [&](auto& row) -> auto& { return std::invoke(field.member, row); });
    } else {
      for (std::size_t part = 0; part < cells_of<Value>; ++part)
        use(
            field, part, [&](auto& row) -> auto& { return std::invoke(field.member, row)[part]; });
    }
  };
  for_each_field<Row>(columns_of);
}

/// Names of the columns, in their order; those alone that every file has when `always`.
template <typename Row>
std::vector<std::string> column_names(bool always = false) {
  std::vector<std::string> names;
  for_each_column<Row>([&](const auto& field, std::size_t part, const auto&) {
    if (!always || field.presence == Presence::always) names.push_back(column_name(field, part));
  });
  return names;
}

/// A text as a cell holds it: in quotes where it needs them.
inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

/// A value as a cell: nothing for what is unknown, 1 and 0 for true and false, the name of an
/// enumerator.
template <typename Value>
std::string cell_of(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>)
    return std::isfinite(value) ? to_text(value) : "";
  else if constexpr (std::is_enum_v<Value>)
    return std::string(name(value));
  else if constexpr (std::is_integral_v<Value>)
    return std::to_string(value);
  else
    return csv_cell(value);
}

/// Writes the table atomically; a column that is there if known, where one of the rows knows it.
template <typename Row>
void write_rows(const std::vector<Row>& rows, const std::filesystem::path& file) {
  write_atomically(file, [&](std::ostream& out) {
    std::vector<bool> shown;
    const char* separator = "";
    for_each_column<Row>([&](const auto& field, std::size_t part, const auto& value_of) {
      shown.push_back(field.presence != Presence::if_known ||
                      std::any_of(rows.begin(), rows.end(),
                                  [&](const Row& row) { return !cell_of(value_of(row)).empty(); }));
      if (shown.back()) out << std::exchange(separator, ",") << column_name(field, part);
    });
    for (const Row& row : rows) {
      std::size_t place = 0;
      separator = "\n";
      for_each_column<Row>([&](const auto&, std::size_t, const auto& value_of) {
        if (shown[place++]) out << std::exchange(separator, ",") << cell_of(value_of(row));
      });
    }
    out << '\n';
  });
}

/// Puts a column's cells where they belong. Throws InvalidInput naming file, line and column.
template <typename Row, typename ValueOf>
void read_column(const CsvTable& table, const std::string& column, const ValueOf& value_of,
                 std::vector<Row>& rows) {
  using Value = std::remove_cvref_t<decltype(value_of(rows.front()))>;
  const auto refuse = [&](std::size_t row, const std::string& text, const std::string& rule) {
    throw InvalidInput(
        {table.file.string() + ":" + std::to_string(table.lines[row]) + ", " + column, text, rule,
         "the file is damaged: run again what writes it"});
  };
  if constexpr (std::is_arithmetic_v<Value>) {
    const std::vector<double> numbers = table.numbers(column);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double number = numbers[i];
      if constexpr (!std::is_floating_point_v<Value>)
        if (!(number == std::floor(number) && std::abs(number) <= 1e15) ||
            (std::is_unsigned_v<Value> && number < 0.0))
          refuse(i, std::isnan(number) ? "" : to_text(number), "must be a whole number");
      value_of(rows[i]) = Value(number);
    }
  } else {
    const std::vector<std::string> texts = table.texts(column);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if constexpr (std::is_enum_v<Value>) {
        const auto found = enumerator<Value>(texts[i]);
        if (!found) refuse(i, texts[i], "must be a word that the program writes");
        value_of(rows[i]) = *found;
      } else {
        value_of(rows[i]) = texts[i];
      }
    }
  }
}

/// What is wrong with the names of the columns: one that every file has is missing.
template <typename Row>
std::vector<Violation> missing_columns(const CsvTable& table) {
  std::vector<Violation> missing;
  for (const std::string& column : column_names<Row>(true))
    if (!table.names.empty() && !table.has(column))
      missing.push_back({table.file.string(), "", "the column '" + column + "' is missing",
                         "run again what writes it"});
  return missing;
}

/// The rows, with the columns there are.
template <typename Row>
std::vector<Row> known_rows(const CsvTable& table) {
  std::vector<Row> rows(table.rows.size());
  for_each_column<Row>([&](const auto& field, std::size_t part, const auto& value_of) {
    const std::string column = column_name(field, part);
    if (table.has(column)) read_column(table, column, value_of, rows);
  });
  return rows;
}

/// The rows. Throws InvalidInput naming file and column for each that is missing, and the line,
/// too, for a cell that holds something else.
template <typename Row>
std::vector<Row> rows_of(const CsvTable& table) {
  if (const std::vector<Violation> missing = missing_columns<Row>(table); !missing.empty())
    throw InvalidInput(missing);
  return known_rows<Row>(table);
}
template <typename Row>
std::vector<Row> read_rows(const std::filesystem::path& file) {
  return rows_of<Row>(read_csv(file));
}

/// A member of every row, numbers as doubles.
template <typename Row, typename Member>
auto column(const std::vector<Row>& rows, Member member) {
  using Value = std::remove_cvref_t<std::invoke_result_t<Member, const Row&>>;
  std::vector<std::conditional_t<std::is_arithmetic_v<Value>, double, Value>> values;
  values.reserve(rows.size());
  for (const Row& row : rows) values.emplace_back(std::invoke(member, row));
  return values;
}

}  // namespace fingertip::meshes::inline tables
