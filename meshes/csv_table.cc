#include "meshes/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "meshes/errors.h"
#include "meshes/press_response.h"
#include "meshes/text_file.h"

namespace fingertip::meshes {

namespace {

namespace fs = std::filesystem;

constexpr const char* run_again = "the file is truncated or damaged: run again what writes it";

[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& column,
                         const std::string& value, const std::string& rule) {
  std::string place = file.string() + ":" + std::to_string(line);
  if (!column.empty()) place += ", " + column;
  throw InvalidInput({place, value, rule, run_again});
}

void strip(std::string& cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!cell.empty() && blank(cell.back())) cell.pop_back();
  cell.erase(cell.begin(), std::find_if_not(cell.begin(), cell.end(), blank));
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) strip(cell);
  return cells;
}

/// A cell as an error message shows it.
std::string shown(const std::string& cell) {
  constexpr std::size_t enough = 40;
  return cell.size() <= enough ? cell : cell.substr(0, enough) + "...";
}

double parse(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::string& cell = table.rows[row][column];
  if (cell.empty()) return unknown;
  double value = 0.0;
  const char* const end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !(std::abs(value) <= largest_plausible))
    refuse(table.file, table.lines[row], table.names[column], shown(cell),
           "must be a finite number, or nothing");
  return value;
}

std::size_t index_of(const CsvTable& table, const std::string& name) {
  return std::size_t(std::ranges::find(table.names, name) - table.names.begin());
}

void check_names(const CsvTable& table, std::size_t line) {
  std::set<std::string> seen;
  for (const std::string& name : table.names)
    if (!seen.insert(name).second)
      refuse(table.file, line, "", shown(name), "a column's name must occur once");
}

}  // namespace

bool CsvTable::has(const std::string& name) const {
  return index_of(*this, name) < names.size();
}

std::vector<std::string> CsvTable::texts(const std::string& name) const {
  const std::size_t column = index_of(*this, name);
  std::vector<std::string> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(column < names.size() ? row[column] : "");
  return values;
}

std::vector<double> CsvTable::numbers(const std::string& name) const {
  const std::size_t column = index_of(*this, name);
  if (column == names.size() && !rows.empty())
    refuse(file, lines.front(), "", "", "the column '" + name + "' is missing");
  std::vector<double> values;
  values.reserve(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) values.push_back(parse(*this, row, column));
  return values;
}

std::vector<std::size_t> CsvTable::indices(const std::string& name, std::size_t count) const {
  const std::vector<double> values = numbers(name);
  std::vector<std::size_t> whole;
  whole.reserve(values.size());
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!(values[row] >= 0.0 && values[row] < double(count) &&
          values[row] == std::floor(values[row])))
      refuse(file, lines[row], name, shown(rows[row][index_of(*this, name)]),
             "must be a whole number from 0 to below " + std::to_string(count));
    whole.push_back(std::size_t(values[row]));
  }
  return whole;
}

std::vector<double> CsvTable::numbers_if_any(const std::string& name) const {
  return has(name) ? numbers(name) : std::vector<double>(rows.size(), unknown);
}

CsvTable read_csv(const fs::path& file) {
  const std::string text = read_text(file);
  CsvTable table;
  table.file = file;
  std::size_t line = 0;
  for (std::size_t start = 0; start < text.size();) {
    ++line;
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos)
      refuse(file, line, "", shown(text.substr(start)), "the last line must end with a line break");
    std::string content = text.substr(start, end - start);
    start = end + 1;
    strip(content);
    if (content.empty() || content.front() == '#') continue;
    std::vector<std::string> cells = split(content);
    if (table.names.empty()) {
      table.names = std::move(cells);
      check_names(table, line);
    } else if (cells.size() == table.names.size()) {
      table.rows.push_back(std::move(cells));
      table.lines.push_back(line);
    } else {
      refuse(file, line, "", std::to_string(cells.size()) + " cells",
             "every row must have as many cells as the first line has names (" +
                 std::to_string(table.names.size()) + ")");
    }
  }
  if (table.names.empty())
    refuse(file, 1, "", "", "the file is empty: its first line must name the columns");
  return table;
}

}  // namespace fingertip::meshes
