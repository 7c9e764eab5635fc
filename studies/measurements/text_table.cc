#include "studies/measurements/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "studies/config/text/units.h"

namespace fingertip::studies::inline measurements {

namespace {

using std::string_view;

bool is_unit(string_view text) {
  for (const char* si : {"m", "N", "s", "Pa", "Hz"}) {
    try {
      parse_quantity("1 " + std::string(text), si, si);
      return true;
    } catch (const UnitError&) {  // of another dimension, or none
    }
  }
  return text == "1" || text == "%";
}

/// "(mm)" or "[mm]" as "mm".
string_view bare(string_view cell) {
  const bool enclosed = cell.size() >= 2 && ((cell.front() == '(' && cell.back() == ')') ||
                                             (cell.front() == '[' && cell.back() == ']'));
  return enclosed ? trimmed(cell.substr(1, cell.size() - 2)) : cell;
}

bool is_words(string_view cell) {
  std::string letters;
  for (const char c : cell) {
    if (c >= '0' && c <= '9' && letters.empty()) return false;
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte) != 0 || byte >= 0x80) letters += char(std::tolower(byte));
  }
  return letters.size() >= 3 && letters != "nan" && letters != "inf" && letters != "infinity";
}

/// Runs of two blanks or more, or tabs, else single ones: a unit in brackets belongs to its name.
void split_titles_at_blanks(string_view line, std::vector<string_view>& cells, bool wide) {
  cells.clear();
  line = trimmed(line);
  std::size_t begin = 0, depth = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && (line[i] == '[' || line[i] == '(')) ++depth;
    if (i < line.size() && (line[i] == ']' || line[i] == ')') && depth > 0) --depth;
    const auto blank = [&](std::size_t k) {
      return k >= line.size() || line[k] == ' ' || line[k] == '\t';
    };
    if (!blank(i) || (depth > 0 && i < line.size())) continue;
    if (wide && i < line.size() && line[i] == ' ' && !blank(i + 1)) continue;
    std::size_t next = i;
    while (next < line.size() && blank(next)) ++next;
    const bool opens = next < line.size() && (line[next] == '[' || line[next] == '(');
    if (opens && !wide) {
      i = next - 1;
      continue;
    }
    cells.push_back(trimmed(line.substr(begin, i - begin)));
    begin = next;
    i = std::max(i, next == 0 ? 0 : next - 1);
    if (next >= line.size()) break;
  }
}

class TableFinder {
 public:
  TableFinder(string_view text, const TableLayout& layout, const ChooseColumns& choose,
              FileProblems& problems)
      : text_(text), layout_(layout), choose_(choose), problems_(problems) {
    separators_ =
        layout.separator ? std::vector{*layout.separator} : std::vector{';', '\t', ',', ' '};
  }
  TextTables found();

 private:
  bool begins_table(const Line& line);
  bool begins_numbered(const Line& line);
  bool holds_units();
  void read_row(const Line& line);
  bool cannot_be_row(const TextTable& table, const Line& line) const;
  void add_row(const Line& line);
  void add_cells(TextTable& table, std::size_t line, std::vector<std::string> cells);
  void end_table();
  void find_style(TextTable& table);
  void tell();

  string_view text_;
  const TableLayout& layout_;
  const ChooseColumns& choose_;
  FileProblems& problems_;
  std::vector<char> separators_;
  std::vector<string_view> cells_;
  bool first_is_words_ = false;   ///< in rows
  std::size_t words_in_row_ = 0;  ///< in rows
  std::vector<std::string> passed_;
  struct Odd {
    std::size_t line;
    std::string text;
    std::vector<std::string> cells;
  };
  std::vector<Odd> odd_;       ///< since the last row
  std::size_t last_line_ = 0;  ///< that was a row, or odd
  std::size_t above_ = 0;
  bool commas_ = false, thousands_ = false;
  TextTables result_;
};

/// Whether the line holds the titles.
bool TableFinder::begins_table(const Line& line) {
  for (const char separator : separators_) {
    for (const bool wide : {true, false}) {
      if (separator != ' ' && !wide) continue;
      if (separator == ' ')
        split_titles_at_blanks(line.text, cells_, wide);
      else
        split(line.text, separator, cells_);
      TextTable table;
      for (const string_view cell : cells_) table.titles.push_back(title_of(cell));
      table.needed = choose_(table.titles, line.number);
      if (table.needed.empty()) continue;
      end_table();
      table.header_line = line.number;
      table.separator = separator;
      result_.tables.push_back(std::move(table));
      return true;
    }
  }
  return false;
}

/// Whether the line is the first with numbers in all needed columns.
bool TableFinder::begins_numbered(const Line& line) {
  for (const char separator : separators_) {
    split(line.text, separator, cells_);
    TextTable table;
    for (std::size_t i = 1; i <= cells_.size(); ++i)
      table.titles.push_back({fmt::format("column {}", i), std::to_string(i), {}});
    table.needed = choose_(table.titles, line.number);
    const bool numbers =
        !table.needed.empty() && std::ranges::all_of(table.needed, [&](std::size_t column) {
          return time_in(cells_[column]) ||
                 std::ranges::any_of(number_styles, [&](NumberStyle style) {
                   return number_in(cells_[column], style).has_value();
                 });
        });
    if (!numbers) continue;
    table.separator = separator;
    result_.tables.push_back(std::move(table));
    return true;
  }
  return false;
}

/// Whether the first line below the titles tells units; titles take them.
bool TableFinder::holds_units() {
  TextTable& table = result_.tables.back();
  if (!table.rows.empty() || table.header_line == 0 || cells_.size() != table.titles.size())
    return false;
  bool some = false;
  for (const std::size_t column : table.needed) {
    const string_view cell = bare(cells_[column]);
    if (number_in(cell) || time_in(cell)) return false;
    some = some || (!cell.empty() && is_unit(cell));
  }
  if (!some) return false;
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (!table.titles[i].unit && !cells_[i].empty())
      table.titles[i].unit = std::string(bare(cells_[i]));
  return true;
}

void TableFinder::read_row(const Line& line) {
  TextTable& table = result_.tables.back();
  split(line.text, table.separator, cells_);
  while (cells_.size() > table.titles.size() && cells_.back().empty()) cells_.pop_back();
  if (holds_units()) return;
  if (table.rows.empty())
    first_is_words_ = is_words(cells_.front());
  else if (!first_is_words_ && is_words(cells_.front())) {
    passed_.push_back(fmt::format("line {}, '{}'", line.number, shown(trimmed(line.text))));
    ++words_in_row_;
    return;
  }
  if (words_in_row_ >= 2 && table.header_line == 0) {
    end_table();
    const TextTable before = table;
    TextTable& next = result_.tables.emplace_back();
    next.titles = before.titles, next.needed = before.needed, next.separator = before.separator;
  }
  words_in_row_ = 0;
  add_row(line);
}

/// Whether `cells_` have a gap where a row has its values, or are no row and stand apart. What is
/// filled up to a place and no further may be a row that is cut.
bool TableFinder::cannot_be_row(const TextTable& table, const Line& line) const {
  const bool apart = line.number > last_line_ + 1, of_a_row = cells_.size() == table.titles.size();
  const auto first_empty = std::ranges::find(cells_, string_view());
  const bool gap =
      std::any_of(first_empty, cells_.end(), [](string_view cell) { return !cell.empty(); });
  if (!of_a_row) return apart || gap;
  const bool lacks_value =
      std::any_of(table.needed.begin(),
                  table.needed.begin() + std::min<std::ptrdiff_t>(2, std::ssize(table.needed)),
                  [&](std::size_t column) { return cells_[column].empty(); });
  return lacks_value && (apart || gap || first_empty == cells_.begin());
}

/// `cells_` as the next one; what cannot be a row is one, and wrong, where another follows.
void TableFinder::add_row(const Line& line) {
  TextTable& table = result_.tables.back();
  std::vector<std::string> cells(cells_.begin(), cells_.end());
  const bool odd = !table.rows.empty() && cannot_be_row(table, line);
  last_line_ = line.number;
  if (odd) {
    odd_.push_back({line.number,
                    fmt::format("line {}, '{}'", line.number, shown(trimmed(line.text))),
                    std::move(cells)});
    return;
  }
  for (Odd& earlier : odd_) add_cells(table, earlier.line, std::move(earlier.cells));
  odd_.clear();
  add_cells(table, line.number, std::move(cells));
}

/// What is left below the rows.
void TableFinder::end_table() {
  for (Odd& below : odd_) passed_.push_back(std::move(below.text));
  odd_.clear();
}

void TableFinder::add_cells(TextTable& table, std::size_t line, std::vector<std::string> cells) {
  if (cells.size() != table.titles.size()) {
    const bool comma = table.separator == ',' && cells.size() == 2 * table.titles.size();
    problems_.add(line, "", "",
                  fmt::format("has {} cells, the {} {} {}", cells.size(),
                              table.header_line > 0 ? "header" : "first row", table.titles.size(),
                              table.header_line > 0 ? "titles" : "cells"),
                  comma ? "write decimals with a point, or separate cells by semicolons"
                        : "give every row a cell per title; the file may be truncated");
    return;
  }
  table.rows.push_back(std::move(cells));
  table.lines.push_back(line);
}

void TableFinder::find_style(TextTable& table) {
  std::size_t most = 0;
  const std::size_t cells = table.rows.size() * table.needed.size();
  for (const NumberStyle& style : number_styles) {
    if (layout_.decimal_comma && *layout_.decimal_comma != (style.decimal == ',')) continue;
    std::size_t numbers = 0;
    for (const auto& row : table.rows)
      for (const std::size_t column : table.needed)
        numbers += number_in(row[column], style).has_value() ? 1 : 0;
    if (numbers > most) most = numbers, table.style = style;
    if (most == cells) break;
  }
  commas_ = commas_ || (table.style.decimal == ',' && !layout_.decimal_comma);
  thousands_ = thousands_ || table.style.thousands != 0;
}

void TableFinder::tell() {
  std::vector<std::string>& notes = result_.notes;
  if (commas_) notes.emplace_back("numbers are read with decimal commas");
  if (thousands_) notes.emplace_back("numbers are read with separators of thousands");
  if (above_ > 0 && !result_.tables.empty() && result_.tables.front().header_line > 0)
    notes.push_back(fmt::format("{} above the table {} not read",
                                above_ == 1 ? "1 line" : fmt::format("{} lines", above_),
                                above_ == 1 ? "is" : "are"));
  constexpr std::size_t enough = 4;
  const std::size_t count = passed_.size();
  if (count == 0) return;
  passed_.resize(std::min(count, enough));
  notes.push_back(fmt::format("{} among or below the rows {} not read: {}{}",
                              count == 1 ? "1 line" : fmt::format("{} lines", count),
                              count == 1 ? "is no row and is" : "are no rows and are",
                              fmt::join(passed_, "; "), count > enough ? "; ..." : ""));
}

TextTables TableFinder::found() {
  Lines lines(text_);
  const bool numbered = !layout_.has_names;
  while (const auto line = lines.next()) {
    if (line->number <= layout_.skip) continue;
    const string_view content = trimmed(line->text);
    if (content.front() == '#') {
      result_.comments.push_back(*line);
      continue;
    }
    // What spreadsheets write for their like.
    if (content.starts_with("sep=") && content.size() == 5 && result_.tables.empty()) {
      if (!layout_.separator) separators_ = {content.back()};
      continue;
    }
    const bool none = result_.tables.empty();
    if (numbered ? none && begins_numbered(*line)
                 : (none || is_words(content)) && begins_table(*line)) {
      if (numbered) read_row(*line);
      continue;
    }
    if (none)
      ++above_;
    else
      read_row(*line);
  }
  end_table();
  for (TextTable& table : result_.tables) find_style(table);
  tell();
  return std::move(result_);
}

}  // namespace

TableTitle title_of(string_view written) {
  // Typographers' and East Asian brackets and apostrophes.
  std::string own(written);
  for (const auto& [other, usual] : {std::pair<string_view, char>("\xEF\xBC\x88", '('),
                                     {"\xEF\xBC\x89", ')'},
                                     {"\xE2\x80\x99", '\''}})
    for (std::size_t at = 0; (at = own.find(other, at)) != own.npos; ++at)
      own.replace(at, other.size(), 1, usual);
  const string_view cell = own;
  TableTitle title{shown(written), "", {}};
  const std::size_t end = cell.find_first_of("[(/");
  for (const char c : trimmed(cell.substr(0, end)))
    title.name += c == ' ' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  if (end == cell.npos) {
    // "Weg in mm", "Force, N"
    for (const string_view between : {" in ", ", "}) {
      const auto at = cell.rfind(between);
      if (at == cell.npos || !is_unit(trimmed(cell.substr(at + between.size())))) continue;
      title.unit = trimmed(cell.substr(at + between.size()));
      title.name.resize(trimmed(cell.substr(0, at)).size());
      break;
    }
    return title;
  }
  const char open = cell[end], close = open == '[' ? ']' : ')';
  if (open == '/') {
    title.unit = trimmed(cell.substr(end + 1));
    return title;
  }
  const auto from = cell.rfind(open);
  if (cell.back() == close) title.unit = trimmed(cell.substr(from + 1, cell.size() - from - 2));
  return title;
}

std::optional<double> time_in(string_view cell) {
  if (const auto seconds = number_in(cell)) return seconds;
  if (cell.find(':') == cell.npos) return {};
  // A date before the time of day.
  if (const auto date = cell.find_last_of(" T"); date != cell.npos) cell.remove_prefix(date + 1);
  if (cell.ends_with('Z')) cell.remove_suffix(1);
  double total = 0.0;
  for (int parts = 0; parts < 3; ++parts) {
    const auto end = cell.find(':');
    std::string part(trimmed(cell.substr(0, end)));
    std::ranges::replace(part, ',', '.');
    const auto number = number_in(part);
    if (!number || !(*number >= 0.0) || !std::isfinite(*number)) return {};
    total = 60.0 * total + *number;
    if (end == cell.npos) return parts > 0 ? std::optional(total) : std::nullopt;
    cell.remove_prefix(end + 1);
  }
  return {};
}

std::optional<double> TextTable::number(std::size_t row, std::size_t column) const {
  const string_view cell = rows[row][column];
  if (const auto number = number_in(cell, style)) return number;
  return time_in(cell);
}

TextTables tables_in(string_view text, const TableLayout& layout, const ChooseColumns& choose,
                     FileProblems& problems) {
  return TableFinder(text, layout, choose, problems).found();
}

}  // namespace fingertip::studies::inline measurements
