#include "studies/measurements/text_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <iterator>

#include "studies/config/text/units.h"

namespace fingertip::studies::inline measurements {

namespace {

using std::string_view;

/// Of whatever dimension.
bool is_unit(string_view text) {
  return std::ranges::any_of(std::array{"m", "N", "s", "Pa", "Hz", "1", "kg", "V", "m/s", "1/s"},
                             [&](const char* si) { return unit_size(text, si).has_value(); });
}

/// Of names such as "XForce_mN": short words are no units there.
bool is_written_behind(string_view text) {
  constexpr string_view units[] = {"N",  "mN", "uN", "kN", "m",   "mm",  "um", "nm",
                                   "cm", "s",  "ms", "Pa", "kPa", "MPa", "gf", "kgf"};
  return std::ranges::find(units, text) != std::end(units);
}

/// In any style, or a time.
bool is_number(string_view cell) {
  return time_in(cell) || std::ranges::any_of(number_styles, [&](NumberStyle style) {
           return number_in(cell, style).has_value();
         });
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
  void take_titles(TextTable& table);
  void begin_again(std::size_t header_line);
  bool holds_units();
  bool is_below_titles(const Line& line);
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
  string_view header_;         ///< above numbered columns
  std::vector<Line> last_above_;  ///< the line at hand and two before it, until a table begins
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
          return is_number(cells_[column]);
        });
    if (!numbers) continue;
    table.separator = separator;
    take_titles(table);
    result_.tables.push_back(std::move(table));
    return true;
  }
  return false;
}

/// Of numbered columns the titles and units that stand right above the first row.
void TableFinder::take_titles(TextTable& table) {
  std::vector<string_view> cells;
  const auto words = [&](string_view line) {
    split(line, table.separator, cells);
    while (cells.size() > table.titles.size() && cells.back().empty()) cells.pop_back();
    return cells.size() == table.titles.size() && std::ranges::none_of(cells, [](string_view cell) {
             return number_in(cell) || time_in(cell);
           });
  };
  std::vector<std::optional<std::string>> units(table.titles.size());
  std::size_t taken = 1;
  auto line = last_above_.rbegin() + 1;
  if (line == last_above_.rend() || !words(line->text)) return;
  const auto none_or_unit = [](string_view cell) { return cell.empty() || is_unit(bare(cell)); };
  if (std::ranges::all_of(table.needed, [&](std::size_t i) { return none_or_unit(cells[i]); })) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!cells[i].empty()) units[i] = std::string(bare(cells[i]));
    if (std::next(line) != last_above_.rend() && words(std::next(line)->text))
      ++line, ++taken;
    else
      cells.assign(units.size(), "");
  }
  above_ -= std::min(above_, taken);
  table.header_line = line->number;
  header_ = trimmed(line->text);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    TableTitle title = title_of(cells[i]);
    if (units[i]) title.unit = units[i];
    if (title.written.empty()) title.written = table.titles[i].written;
    table.titles[i] = std::move(title);
  }
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

/// Whether a line between titles and rows has no number where they have theirs: channels, symbols.
bool TableFinder::is_below_titles(const Line& line) {
  const TextTable& table = result_.tables.back();
  if (!table.rows.empty() || table.header_line == 0 || cells_.size() != table.titles.size())
    return false;
  const auto has_number = [&](std::size_t column) { return is_number(cells_[column]); };
  if (line.number > table.header_line + 4 || std::ranges::any_of(table.needed, has_number))
    return false;
  passed_.push_back(fmt::format("line {}, '{}'", line.number, shown(trimmed(line.text))));
  return true;
}

void TableFinder::read_row(const Line& line) {
  TextTable& table = result_.tables.back();
  split(line.text, table.separator, cells_);
  while (cells_.size() > table.titles.size() && cells_.back().empty()) cells_.pop_back();
  if (holds_units() || is_below_titles(line)) return;
  if (table.rows.empty())
    first_is_words_ = is_words(cells_.front());
  else if (!first_is_words_ && is_words(cells_.front())) {
    passed_.push_back(fmt::format("line {}, '{}'", line.number, shown(trimmed(line.text))));
    ++words_in_row_;
    return;
  }
  if (words_in_row_ >= 2 && !layout_.has_names) begin_again(table.header_line);
  words_in_row_ = 0;
  add_row(line);
}

/// A further table of numbered columns.
void TableFinder::begin_again(std::size_t header_line) {
  end_table();
  const TextTable before = result_.tables.back();
  TextTable& next = result_.tables.emplace_back();
  next.titles = before.titles, next.needed = before.needed, next.separator = before.separator;
  next.header_line = header_line;
  words_in_row_ = 0;
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
    const string_view content = trimmed(line->text);
    const bool comment = content.front() == '#';
    if (result_.tables.empty()) {
      if (last_above_.size() == 3) last_above_.erase(last_above_.begin());
      last_above_.push_back({comment ? trimmed(content.substr(1)) : line->text, line->number});
    }
    if (line->number <= layout_.skip) continue;
    if (comment) {
      result_.comments.push_back(*line);
      continue;
    }
    // What spreadsheets write for their like.
    if (content.starts_with("sep=") && content.size() == 5 && result_.tables.empty()) {
      if (!layout_.separator) separators_ = {content.back()};
      continue;
    }
    const bool none = result_.tables.empty();
    if (numbered && !none && !header_.empty() && content == header_) {
      begin_again(line->number);
      continue;
    }
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
  const string_view cell = trimmed(own);
  TableTitle title{shown(written), "", {}};
  const auto call = [&](string_view name) {
    for (const char c : trimmed(name))
      title.name += c == ' ' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  };
  // Of several brackets the last that hold a unit, else the last.
  const auto first = cell.find_first_of("[(");
  for (auto open = first; open != cell.npos; open = cell.find_first_of("[(", open + 1)) {
    const auto close = std::min(cell.find(cell[open] == '[' ? ']' : ')', open), cell.size());
    // Of a channel, "Load(Linear:Load)".
    if (cell.substr(open, close - open).find(':') != cell.npos) continue;
    const string_view inside = trimmed(cell.substr(open + 1, close - open - 1));
    if (is_unit(inside) || !title.unit || !is_unit(*title.unit)) title.unit = inside;
  }
  const auto in = cell.rfind(" in ");
  const bool behind_in = in != cell.npos && is_unit(trimmed(cell.substr(in + 4)));
  const auto slash = behind_in ? cell.npos : cell.substr(0, first).find('/');
  if (title.unit && !behind_in && (slash == cell.npos || is_unit(*title.unit))) {
    call(cell.substr(0, first));
  } else if (slash != cell.npos) {
    title.unit = trimmed(cell.substr(slash + 1));
    call(cell.substr(0, slash));
  } else {
    // "Weg in mm", "Force, N", "Force_mN"
    auto end = cell.size();
    for (const string_view between : {" in ", ", ", "_"}) {
      const auto at = cell.rfind(between);
      if (at == cell.npos) continue;
      const string_view behind = trimmed(cell.substr(at + between.size()));
      if (between == "_" ? !is_written_behind(behind) : !is_unit(behind)) continue;
      title.unit = behind;
      end = at;
      break;
    }
    call(cell.substr(0, end));
  }
  return title;
}

std::optional<double> unit_size(string_view unit, const std::string& si) {
  const string_view text = trimmed(unit);
  if (text == "1" || text == "-") return si == "1" ? std::optional(1.0) : std::nullopt;
  try {
    return parse_quantity("1 " + std::string(text), si, si);
  } catch (const UnitError&) {  // of another dimension, or none
    return {};
  }
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
