#include "studies/run/curve_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "studies/config/units.h"
#include "studies/run/curve_text.h"

namespace fingertip::studies {

namespace {

using std::string_view;

/// What people and machines call the same.
constexpr std::pair<string_view, string_view> other_names[] = {
    {"force", "normal_force"},       {"force", "load"},           {"force", "kraft"},
    {"force", "standardkraft"},      {"force", "standard_force"}, {"position", "travel"},
    {"position", "extension"},       {"position", "stroke"},      {"position", "crosshead"},
    {"position", "displacement"},    {"position", "distance"},    {"position", "standardweg"},
    {"position", "standard_travel"}, {"position", "weg"},         {"time", "zeit"}};

/// How many titles have this name.
std::ptrdiff_t count_of(const std::vector<TableTitle>& titles, string_view name) {
  return std::ranges::count(titles, name, &TableTitle::name);
}

/// The name under which a quantity stands in these titles: its own, else another; empty: none.
string_view name_among(const std::vector<TableTitle>& titles, string_view quantity) {
  if (count_of(titles, quantity) > 0) return quantity;
  for (const auto& [known, other] : other_names)
    if (known == quantity && count_of(titles, other) > 0) return other;
  return {};
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
  const string_view here = name_among(titles, name);
  if (here.empty()) return {};
  const auto first = std::ranges::find(titles, here, &TableTitle::name);
  for (auto next = first + 1; next != titles.end(); ++next)
    if (next->name == here || (name == "force" && next->name == "normal_force"))
      problems_.add(table.header_line, next->written, "",
                    "stands for the same as '" + first->written + "'",
                    "leave one of the two columns out, or choose by a TOML file");
  return std::size_t(first - titles.begin());
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

void CurveColumns::refuse_header(string_view text) {
  Lines lines(text);
  auto first = lines.next();
  while (first && trimmed(first->text).front() == '#') first = lines.next();
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
  const bool is_row = number_in(cells.front()).has_value();
  constexpr std::size_t enough = 8;
  std::string header;
  for (std::size_t i = 0; i < std::min(enough, cells.size()); ++i)
    header += (i > 0 ? ", " : "") + shown(cells[i]);
  if (cells.size() > enough) header += fmt::format(" and {} more", cells.size() - enough);
  problems_.add(
      first->number, "", "",
      (is_row ? "the header is missing: the first line is '"
              : "the header has no pair of columns that can be used here, nor has any "
                "line below: the first is '") +
          header + "'",
      "name the columns in the first line, separated by comma, semicolon or tab: " + pairs +
          ", in any unit, or say which they are in a TOML file in place of this "
          "one: [[press]] (studies/manual/files.md)");
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
      const string_view here = name_among(titles, quantity);
      const auto at = std::ranges::find(titles, here, &TableTitle::name);
      return here.empty() ? titles.size() : std::size_t(at - titles.begin());
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

}  // namespace fingertip::studies
