#include "meshes/tables/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline tables {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& column,
                         const std::string& value, const std::string& rule,
                         const char* remedy = write_table_again) {
  std::string place = file.string() + ":" + std::to_string(line);
  if (!column.empty()) place += ", " + column;
  throw InvalidInput({place, value, rule, remedy});
}

void strip(std::string& cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!cell.empty() && blank(cell.back())) cell.pop_back();
  cell.erase(cell.begin(), std::find_if_not(cell.begin(), cell.end(), blank));
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
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

/// What separates the cells of a line of names.
char separator_in(const std::string& names) {
  for (const char separator : {';', '\t'})
    if (names.find(separator) != std::string::npos) return separator;
  return ',';
}

double parse(const CsvTable& table, std::size_t row, std::size_t column) {
  const std::string& cell = table.rows[row][column];
  if (cell.empty()) return unknown;
  double value = 0.0;
  const char* const end = cell.data() + cell.size();
  const auto [stop, error] = std::from_chars(cell.data(), end, value);
  if (error != std::errc() || stop != end || !(std::abs(value) <= largest_plausible))
    refuse(table.file, table.lines[row], table.names[column], shown(cell),
           "must be a finite number, or nothing", table.remedy);
  return value;
}

std::size_t index_of(const CsvTable& table, const std::string& name) {
  return std::size_t(std::ranges::find(table.names, name) - table.names.begin());
}

void check_names(const CsvTable& table, std::size_t line) {
  std::set<std::string> seen;
  for (const std::string& name : table.names)
    if (!seen.insert(name).second)
      refuse(table.file, line, "", shown(name), "a column's name must occur once", table.remedy);
}

CsvTable read(const fs::path& file, bool of_people, const char* remedy) {
  const std::string text = read_text(file);
  CsvTable table;
  table.file = file;
  table.remedy = remedy;
  char separator = ',';
  std::size_t line = 0;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  for (std::size_t start = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
       start < text.size();) {
    ++line;
    std::size_t end = text.find('\n', start);
    if (end == std::string::npos && !of_people)
      refuse(file, line, "", shown(text.substr(start)), "the last line must end with a line break",
             remedy);
    end = std::min(end, text.size());
    const std::string whole = text.substr(start, end - start);
    start = end + 1;
    std::string content = whole;
    strip(content);
    if (content.empty() || content.front() == '#') continue;
    const bool titles = table.names.empty();
    if (titles && of_people) separator = separator_in(content);
    if (separator == '\t') content = whole;  // the first and the last cell may be empty
    if (!titles && separator != ',') std::ranges::replace(content, ',', '.');
    std::vector<std::string> cells = split(content, separator);
    if (titles) {
      table.names = std::move(cells);
      table.names_line = line;
      check_names(table, line);
    } else if (cells.size() == table.names.size()) {
      table.rows.push_back(std::move(cells));
      table.lines.push_back(line);
    } else {
      refuse(file, line, "", std::to_string(cells.size()) + " cells",
             "every row must have as many cells as the first line has names (" +
                 std::to_string(table.names.size()) + ")",
             remedy);
    }
  }
  if (table.names.empty())
    refuse(file, 1, "", "", "the file is empty: its first line must name the columns", remedy);
  return table;
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
    refuse(file, lines.front(), "", "", "the column '" + name + "' is missing", remedy);
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
             "must be a whole number from 0 to below " + std::to_string(count), remedy);
    whole.push_back(std::size_t(values[row]));
  }
  return whole;
}

std::vector<double> CsvTable::numbers_if_any(const std::string& name) const {
  return has(name) ? numbers(name) : std::vector<double>(rows.size(), unknown);
}

CsvTable read_csv(const fs::path& file) {
  return read(file, false, write_table_again);
}

CsvTable read_csv_of_people(const fs::path& file, const char* remedy) {
  return read(file, true, remedy);
}

}  // namespace fingertip::meshes::inline tables
