#include "studies/measurements/curve_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <utility>

#include "studies/config/text/units.h"
#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline measurements {

namespace {

using std::string_view;

/// What people and machines call the same, in English, German, French, Spanish, Italian and
/// Chinese; in small letters without accents, with _ for blanks, and blanks on either side.
constexpr std::pair<string_view, string_view> other_names[] = {
    {"force",
     " normal_force standard_force compressive_force compression_force load "
     "compressive_load kraft standardkraft prufkraft normalkraft druckkraft "
     "last force_standard force_normale charge effort fuerza fuerza_estandar "
     "fuerza_normal carga forza forza_standard forza_normale carico 力 试验力 载荷 "
     "负荷 "},
    {"position",
     " travel standard_travel extension compressive_extension compression "
     "stroke crosshead crosshead_travel crosshead_position displacement "
     "compressive_displacement distance standardweg weg traversenweg "
     "verfahrweg hub verschiebung deplacement deplacement_standard "
     "deplacement_traverse allongement allongement_standard course "
     "desplazamiento alargamiento recorrido carrera posicion spostamento "
     "allungamento corsa posizione 位移 行程 变形 横梁位移 "},
    {"indentation",
     " indentation_depth penetration eindringtiefe eindruckung enfoncement "
     "indentacion penetracion indentazione penetrazione 压入深度 "},
    {"time",
     " test_time elapsed_time zeit prufzeit temps temps_d'essai tiempo "
     "tiempo_de_ensayo tempo tempo_di_prova 时间 "}};

/// Small letters without accents, of which titles of several languages are made.
std::string folded(string_view name) {
  constexpr std::pair<string_view, string_view> letters[] = {
      {"ÀÁÂÄàáâä", "a"}, {"ÈÉÊËèéêë", "e"}, {"ÌÍÎÏìíîï", "i"}, {"ÒÓÔÖòóôö", "o"},
      {"ÙÚÛÜùúûü", "u"}, {"Ññ", "n"},       {"Çç", "c"}};
  std::string text;
  while (!name.empty()) {
    std::size_t length = 1;
    string_view letter = name.substr(0, 1);
    for (const auto& [accented, plain] : letters)
      for (std::size_t at = 0; at < accented.size(); at += 2)  // two bytes each
        if (name.starts_with(accented.substr(at, 2))) letter = plain, length = 2;
    text += letter;
    name.remove_prefix(length);
  }
  return text;
}

/// Whether a title stands for a quantity.
bool is_called(const TableTitle& title, string_view quantity) {
  const std::string name = folded(title.name);
  if (name == quantity) return true;
  const auto known =
      std::ranges::find(other_names, quantity, [](const auto& each) { return each.first; });
  return known != std::end(other_names) &&
         known->second.find(' ' + name + ' ') != string_view::npos;
}

/// The column that a quantity stands in: under its own name, else the first of another; none: npos.
std::size_t place_of(const std::vector<TableTitle>& titles, string_view quantity) {
  auto found = std::ranges::find(titles, quantity, &TableTitle::name);
  if (found == titles.end())
    found = std::ranges::find_if(
        titles, [&](const TableTitle& title) { return is_called(title, quantity); });
  return found == titles.end() ? string_view::npos : std::size_t(found - titles.begin());
}

}  // namespace

const ColumnWish* CurveColumns::wish(string_view quantity) const {
  const auto found = std::ranges::find(source_.columns, quantity, &ColumnWish::quantity);
  return found == source_.columns.end() ? nullptr : &*found;
}

std::optional<std::size_t> CurveColumns::find(const TextTable& table, string_view name) {
  const auto& titles = table.titles;
  if (!source_.columns.empty()) {
    const ColumnWish* own = wish(name);
    if (own == nullptr) return {};
    return table.needed[std::size_t(own - source_.columns.data())];
  }
  const std::size_t first = place_of(titles, name);
  if (first == string_view::npos) return {};
  // Which of two positions is taken is told with those that are not; of two forces one may be
  // another cell's.
  for (std::size_t next = 0; next < titles.size(); ++next) {
    const bool same =
        name == "force" ? is_called(titles[next], name) : titles[next].name == titles[first].name;
    if (next == first || !same) continue;
    problems_.add(table.header_line, titles[next].written, "",
                  "stands for the same as '" + titles[first].written + "', column " +
                      std::to_string(first + 1),
                  fmt::format("leave one of the two out, or choose by a TOML file in place of this "
                              "one: [[press]], {} = {{column = {}}} or {{column = {}}}",
                              name, first + 1, next + 1));
    break;
  }
  return first;
}

CurveColumn CurveColumns::column(const TextTable& table, std::size_t index,
                                 const Quantity& quantity) {
  const TableTitle& title = table.titles[index];
  const std::string name(quantity.name), si(quantity.unit);
  const ColumnWish* own = wish(quantity.name);
  const bool told = own != nullptr && !own->unit.empty();
  CurveColumn result{index, title.written, told ? own->unit : title.unit.value_or(""), 1.0,
                     si == "s"};
  const std::string remedy = "name the column for instance '" + name + " [" + si + "]'";
  const bool clock =
      result.is_clock && !table.rows.empty() && result.unit != "s" &&
      (!title.unit || title.unit->find(':') != std::string::npos || title.unit->empty());
  if (clock && !told) {
    result.unit = "s";  // as h:min:s it was read
  } else if (!told && !title.unit) {
    problems_.add(table.header_line, title.written, "",
                  "the unit is missing: it stands in brackets at the end", remedy);
  } else if (si == "1") {
    if (result.unit != "1")
      problems_.add(table.header_line, title.written, "",
                    "a number without dimension is marked [1]",
                    remedy + " (divide percents by 100)");
  } else {
    try {
      result.factor = parse_quantity("1 " + result.unit, si, si);
    } catch (const UnitError& error) {
      problems_.add(table.header_line, title.written, "", error.rule, remedy);
    }
  }
  if (own != nullptr) result.factor *= own->sign;
  return result;
}

namespace {

/// Where the numbers of a file begin, and the line that stands for their titles.
struct Beginning {
  std::optional<Line> titles, row;
};

/// How many cells of a line are numbers, with any separator and any decimals.
std::ptrdiff_t numbers_in(string_view line) {
  std::ptrdiff_t most = 0;
  std::vector<string_view> cells;
  for (const char separator : {';', '\t', ',', ' '}) {
    split(line, separator, cells);
    most = std::max(most, std::ranges::count_if(cells, [](string_view cell) {
                      std::string text(cell);
                      std::ranges::replace(text, ',', '.');
                      return number_in(text).has_value() || time_in(cell).has_value();
                    }));
  }
  return most;
}

/// The last line above the first row that has a word; a row of units leaves the one above.
Beginning beginning_of(string_view text) {
  Beginning found;
  Lines lines(text);
  const auto has_word = [](string_view line) {
    std::size_t letters = 0;
    for (const char c : line) {
      letters =
          std::isalpha(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0 ? letters + 1 : 0;
      if (letters >= 4) return true;
    }
    return false;
  };
  while (const auto line = lines.next()) {
    if (trimmed(line->text).front() == '#') continue;
    if (numbers_in(line->text) >= 2) {
      found.row = line;
      break;
    }
    if (!found.titles || has_word(line->text)) found.titles = line;
  }
  return found;
}

}  // namespace

void CurveColumns::refuse_header(string_view text) {
  const Beginning found = beginning_of(text);
  const std::optional<Line> first = found.titles ? found.titles : found.row;
  if (!first) {
    problems_.add(0, "", "", "the file holds no table",
                  "write a header such as 'indentation [mm], force [mN]' and rows of numbers");
    return;
  }
  std::string pairs;
  for (const CurveQuantities& pair : allowed_)
    pairs += fmt::format("{}'{} [{}]' and '{} [{}]'", pairs.empty() ? "" : ", or ", pair.x.name,
                         pair.x.unit, pair.y.name, pair.y.unit);
  char separator = ',';
  for (const char known : {'\t', ',', ';'})
    if (first->text.find(known) != first->text.npos) separator = known;
  std::vector<string_view> cells;
  split(first->text, separator, cells);
  constexpr std::size_t enough = 8;
  std::string header;
  for (std::size_t i = 0; i < std::min(enough, cells.size()); ++i)
    header += (i > 0 ? ", " : "") + shown(cells[i]);
  if (cells.size() > enough) header += fmt::format(" and {} more", cells.size() - enough);
  problems_.add(
      first->number, "", "",
      (!found.titles ? "the header is missing: the first line is '"
                     : "the header has no pair of columns that can be used here, nor has any other "
                       "line: " +
                           (found.row ? fmt::format("above the numbers, which begin in line {}, "
                                                    "stands '",
                                                    found.row->number)
                                      : "no numbers follow, it is '")) +
          header + "'",
      "name the columns in the first line, separated by comma, semicolon or tab: " + pairs +
          ", in any unit, or say which they are in a TOML file in place of this "
          "one: [[press]], force = {column = 3, unit = \"N\"} (studies/manual/files.md)");
}

TextTables CurveColumns::tables(string_view text) {
  TableLayout layout = source_.layout;
  if (!source_.columns.empty()) {
    std::vector<std::string> columns;
    for (const ColumnWish& each : source_.columns) columns.push_back(each.column);
    DescribedColumns choose(columns);
    if (choose.all_numbered()) layout.has_names = false;
    TextTables found = tables_in(text, layout, std::ref(choose), problems_);
    if (found.tables.empty()) choose.refuse(problems_, "compare the file with its description");
    return found;
  }
  const auto choose = [this](const std::vector<TableTitle>& titles, std::size_t) {
    std::vector<std::size_t> needed;
    const auto place = [&](string_view quantity) {
      return std::min(place_of(titles, quantity), titles.size());
    };
    for (const CurveQuantities& pair : allowed_) {
      needed = {place(pair.x.name), place(pair.y.name)};
      if (std::ranges::max(needed) < titles.size()) break;
      needed.clear();
    }
    if (needed.empty()) return needed;
    for (const char* further : {"sigma", "force_error", "time"})
      if (const std::size_t at = place(further); at < titles.size()) needed.push_back(at);
    return needed;
  };
  return tables_in(text, layout, choose, problems_);
}

}  // namespace fingertip::studies::inline measurements
