#include "studies/measurements/description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "meshes/base/errors.h"
#include "studies/config/text/named_folder.h"
#include "studies/config/text/units.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline measurements {

namespace fs = std::filesystem;
using meshes::InvalidInput;
using std::string_view;

void TestTable::refuse(string_view key, const std::string& value, const std::string& rule,
                       const std::string& remedy) const {
  const toml::node* at = find(key);
  const auto line = (at != nullptr ? at->source() : own_.source()).begin.line;
  throw InvalidInput({fmt::format("{}{}{}", place_, place_.empty() || key.empty() ? "" : ".", key),
                      value, rule, remedy, fmt::format("{}:{}", file_.string(), line)});
}

void TestTable::check_keys(const std::set<string_view>& known) const {
  for (const auto& [key, value] : own_)
    if (!known.contains(key.str()))
      refuse(key.str(), unquoted(toml_literal(value)), "no such key",
             "the keys are " + fmt::format("{}", fmt::join(known, ", ")));
}

std::optional<std::string> TestTable::text(string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value_exact<std::string>();
  if (!value) refuse(key, toml_literal(*node), "must be a text", "put it in quotes");
  return value;
}

long TestTable::whole(string_view key, long usual, long least, long most) const {
  const toml::node* node = find(key);
  if (node == nullptr) return usual;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < least || *value > most)
    refuse(key, toml_literal(*node),
           fmt::format("must be a whole number from {} to {}", least, most), "give one");
  return long(*value);
}

bool TestTable::flag(string_view key, bool usual) const {
  const toml::node* node = find(key);
  if (node == nullptr) return usual;
  const auto value = node->value_exact<bool>();
  if (!value) refuse(key, toml_literal(*node), "must be true or false", "write one of them");
  return *value;
}

std::vector<std::string> TestTable::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, value] : own_) names.emplace_back(key.str());
  return names;
}

std::optional<double> TestTable::number(string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = node->value<double>();
  if (!value || !std::isfinite(*value))
    refuse(key, toml_literal(*node), "must be a number", "write e.g. 0.5");
  return value;
}

std::optional<double> TestTable::quantity(string_view key, const std::string& unit,
                                          const std::string& example) const {
  const auto written = text(key);
  if (!written) return std::nullopt;
  return number_of(key, *written, unit, example);
}

double TestTable::number_of(string_view key, const std::string& written, const std::string& unit,
                            const std::string& example) const {
  double value = 0.0;
  try {
    value = parse_quantity(written, unit, example);
  } catch (const UnitError& error) {
    refuse(key, written, error.rule, error.remedy);
  }
  if (!(value > 0.0)) refuse(key, written, "must be positive", "write e.g. " + example);
  return value;
}

std::optional<std::array<double, 2>> TestTable::pair(string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* list = node->as_array();
  if (list != nullptr && list->size() == 2) {
    const auto from = list->at(0).value<double>(), to = list->at(1).value<double>();
    if (from && to && *from < *to) return std::array{*from, *to};
  }
  refuse(key, toml_literal(*node), "must be two numbers, the smaller one first",
         "write e.g. [0.0, 0.5]");
}

std::optional<TestTable> TestTable::table(string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (!node->is_table())
    refuse(key, toml_literal(*node), "must be a table", "write e.g. {column = 1, unit = \"kPa\"}");
  return TestTable(file_, *node->as_table(), place_ + "." + std::string(key));
}

fs::path TestTable::located(string_view key, const std::string& written) const {
  if (const auto found = studies::located(written, file_.parent_path())) return *found;
  refuse(key, written, "no environment variable " + variable_in(written) + " is set",
         "set it to the folder of the data");
}

std::vector<fs::path> TestTable::paths(string_view key) const {
  const toml::node* node = find(key);
  std::vector<fs::path> found;
  const auto add = [&](const toml::node& one) {
    const auto written = one.value_exact<std::string>();
    if (!written || written->empty())
      refuse(key, toml_literal(one), "must be the path of a file, or a list of paths",
             "put it in quotes");
    found.push_back(located(key, *written));
  };
  if (node != nullptr && node->is_array()) {
    for (const toml::node& one : *node->as_array()) add(one);
  } else if (node != nullptr) {
    add(*node);
  }
  if (found.empty()) refuse(key, "", "a test needs the path of its file", "give it");
  return found;
}

std::string TestTable::column() const {
  const toml::node* node = find("column");
  if (node != nullptr) {
    if (const auto number = node->value_exact<std::int64_t>()) {
      if (*number >= 1) return "#" + std::to_string(*number);
    } else if (const auto name = node->value_exact<std::string>()) {
      return *name;
    }
  }
  refuse("column", node == nullptr ? "" : toml_literal(*node),
         "must be a column's name in the header, or its number from 1", "write e.g. column = 2");
}

void each_table(const std::filesystem::path& file, const toml::table& root, const std::string& name,
                const std::string& needs, const std::set<std::string_view>& shared,
                const std::function<void(const TestTable&)>& take) {
  const TestTable whole(file, root, "");
  if (const auto data = whole.table("data")) data->check_keys(shared);
  const toml::array* tables = root[name].as_array();
  if (tables == nullptr || tables->empty())
    whole.refuse(name, "", "the file names no " + name, "write [[" + name + "]] with " + needs);
  std::set<std::string_view> known = shared;
  known.insert({"name", "path"});
  std::size_t count = 0;
  for (const toml::node& node : *tables) {
    if (!node.is_table())
      whole.refuse(name, "", "every " + name + " is a table",
                   "write [[" + name + "]] above its keys");
    const TestTable own(file, *node.as_table(), fmt::format("{}[{}]", name, ++count),
                        root["data"].as_table());
    own.check_keys(known);
    take(own);
  }
}

TableLayout layout_of(const TestTable& table) {
  TableLayout layout;
  if (table.has("separator"))
    layout.separator = table.word<char>(
        "separator", {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"whitespace", ' '}});
  if (table.has("decimal"))
    layout.decimal_comma = table.word<bool>("decimal", {{"point", false}, {"comma", true}});
  if (layout.decimal_comma.value_or(false) && layout.separator == ',')
    table.refuse("decimal", "comma", "commas cannot separate cells and decimals alike",
                 "give another separator");
  layout.skip = std::size_t(table.whole("skip", 0, 0, 1000000));
  layout.has_names = table.flag("header", true);
  return layout;
}

TestTable needed(const TestTable& test, string_view key, const char* example) {
  const auto table = test.table(key);
  if (!table) test.refuse(key, "", "a test needs it", std::string("write e.g. ") + example);
  return *table;
}

double sign_of(const TestTable& table) {
  const long sign = table.whole("sign", 1, -1, 1);
  if (sign == 0) table.refuse("sign", "0", "must be 1 or -1", "write sign = -1 to turn it about");
  return double(sign);
}

namespace {

ColumnZero zero_of(const TestTable& table, const std::string& si, const std::string& example) {
  if (!table.has("zero")) return {};
  if (!table.is_text("zero")) return {ColumnZero::By::number, *table.number("zero")};
  const std::string written = *table.text("zero");
  if (written == "first row") return {ColumnZero::By::first_row};
  if (written == "fit") return {ColumnZero::By::fit};
  try {
    return {ColumnZero::By::quantity, parse_quantity(written, si, example)};
  } catch (const UnitError& error) {
    table.refuse(
        "zero", written,
        "must be \"first row\", \"fit\", a number of the column or a quantity: " + error.rule,
        "write e.g. zero = \"first row\", or zero = \"" + example + "\"");
  }
}

/// "10 um", of a count.
bool has_number(string_view unit) {
  return !unit.empty() && unit != "1" &&
         (std::isdigit(static_cast<unsigned char>(unit.front())) != 0 || unit.front() == '.');
}

std::optional<double> described_size(const std::string& unit, const std::string& si) {
  if (!has_number(unit)) return unit_size(unit, si);
  try {
    return parse_quantity(unit, si, si);
  } catch (const UnitError&) {  // of another dimension, or none
    return {};
  }
}

/// What a unit measures, for people; empty: it is none.
std::string dimension_of(const std::string& unit) {
  constexpr std::pair<const char*, const char*> dimensions[] = {
      {"m", "a length"},      {"N", "a force"},   {"Pa", "a stress"}, {"s", "a time"},
      {"1", "a bare number"}, {"kg", "a mass"},   {"V", "a voltage"}, {"m/s", "a speed"},
      {"1/s", "a rate"},      {"m^2", "an area"}, {"J", "an energy"}, {"K", "a temperature"}};
  for (const auto& [si, what] : dimensions)
    if (unit_size(unit, si)) return what;
  return {};
}

bool same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

/// Of a mass, the force of its weight [N].
std::optional<double> weight_of(const std::string& unit) {
  constexpr double gravity = 9.80665;
  const auto mass = unit_size(unit, "kg");
  return mass ? std::optional(gravity * *mass) : std::nullopt;
}

/// How to say what a column of another dimension is.
std::string way_out(const std::string& file, const std::string& quantity, const std::string& si,
                    const std::string& remedy) {
  const std::string what = dimension_of(file);
  if (what.empty() && si != "1")
    return fmt::format(
        "say what a count is: {0} = {{column = ..., unit = \"{1}\"}}, or scale = 0.0125 "
        "with unit = \"{2}\"",
        quantity, si == "m" ? "10 um" : "0.0125 " + si, si);
  if (si == "N" && what == "a mass")
    return fmt::format(
        "where it is the force of its weight, name the column '{0} [{1}]', or describe "
        "it: {0} = {{column = ..., unit = \"{1}\"}}",
        quantity, file.starts_with("k") ? "kgf" : "gf");
  if (quantity == "strain" && what == "a length")
    return "a length is a strain over the length at rest: is = \"displacement\", with length = "
           "\"...\" of the test";
  if (quantity == "strain" && si == "m")
    return "write is = \"engineering\", or stretch, or choose the column of the displacement";
  if (quantity == "stress" && what == "a force")
    return "write is = \"force\", with the area of the test";
  if (quantity == "stress" && what == "a stress") return "write is = \"nominal\", or true";
  if (si != "1" && (what == "a voltage" || what == "a bare number"))
    return fmt::format("say what a count is: {} = {{column = ..., scale = 0.0125, unit = \"{}\"}}",
                       quantity, si);
  return remedy;
}

}  // namespace

DescribedColumn described_column(const TestTable& table, const std::string& quantity,
                                 const std::string& si, const std::string& example,
                                 const std::set<string_view>& further) {
  std::set<string_view> keys = {"column", "unit", "scale", "sign"};
  keys.insert(further.begin(), further.end());
  table.check_keys(keys);
  DescribedColumn found{quantity, table.column(), table.text("unit").value_or("")};
  found.sign = sign_of(table);
  found.scale = table.number("scale").value_or(1.0);
  if (!(found.scale > 0.0))
    table.refuse("scale", fmt::format("{}", found.scale), "must be positive: units of a count",
                 "write sign = -1 to turn a column about");
  if (!found.unit.empty() && !(described_size(found.unit, si).value_or(0.0) > 0.0)) {
    const std::string what = dimension_of(found.unit);
    table.refuse("unit", found.unit,
                 what.empty()
                     ? "is not a unit"
                     : fmt::format("is {}, and {} is {} here", what, quantity, dimension_of(si)),
                 way_out(found.unit, quantity, si, "write e.g. unit = \"" + example + "\""));
  }
  if (keys.contains("zero")) found.zero = zero_of(table, si, "1 " + example);
  return found;
}

std::optional<ColumnUnit> unit_of(const DescribedColumn* described, const TableTitle& title,
                                  const std::string& si, std::size_t line,
                                  const std::string& remedy, FileProblems& problems,
                                  std::vector<std::string>& notes) {
  const std::string own = title.unit.value_or(""),
                    told = described == nullptr ? "" : described->unit,
                    quantity = described == nullptr ? title.name : described->quantity;
  const double counts = described == nullptr ? 1.0 : described->scale * described->sign;
  const bool is_unit = !own.empty() && !dimension_of(own).empty();
  const auto size = is_unit ? unit_size(own, si) : std::nullopt;
  const auto refuse = [&](const std::string& rule, const std::string& what_to_do) {
    problems.add(line, title.written, "", rule, what_to_do);
    return std::nullopt;
  };
  if (!told.empty()) {
    const double wanted = *described_size(told, si);
    const ColumnUnit found{told, counts * wanted};
    const auto weight = weight_of(own);
    if (!is_unit || (size && same(*size, wanted)) || (si == "N" && weight && same(*weight, wanted)))
      return found;
    if (has_number(told) || described->scale != 1.0) {
      notes.push_back(fmt::format("'{}' names the unit [{}]; by the description a number is {} {}",
                                  title.written, own, described->scale, told));
      return found;
    }
    return refuse(fmt::format("the file says [{}] and its description unit = \"{}\"", own, told),
                  fmt::format("leave unit out where the file is right; where its header is wrong, "
                              "overrule it: unit = \"1 {}\"",
                              told));
  }
  if (size) return ColumnUnit{own, counts * *size};
  if (own.empty() || (si == "1" && !is_unit)) return std::nullopt;
  if (!is_unit) return refuse("[" + own + "] is not a unit", way_out(own, quantity, si, remedy));
  return refuse(fmt::format("the file says [{}], {}, and {} is {} here", own, dimension_of(own),
                            quantity, dimension_of(si)),
                way_out(own, quantity, si, remedy));
}

double zero_in(const ColumnZero& zero, double first, const ColumnUnit& unit) {
  switch (zero.by) {
    case ColumnZero::By::first_row: return first;
    case ColumnZero::By::number: return zero.value;
    case ColumnZero::By::quantity: return zero.value / std::abs(unit.factor);
    default: return 0.0;
  }
}

DescribedColumns::DescribedColumns(std::vector<std::string> columns)
    : columns_(std::move(columns)) {}

bool DescribedColumns::all_numbered() const {
  return std::ranges::all_of(columns_, [](const std::string& c) { return c.starts_with('#'); });
}

std::vector<std::size_t> DescribedColumns::operator()(const std::vector<TableTitle>& titles,
                                                      std::size_t line) {
  std::vector<std::size_t> found;
  std::string missing;
  bool twice = false;
  for (const std::string& column : columns_) {
    std::vector<std::size_t> places;
    if (column.starts_with('#')) {
      const std::size_t place = std::stoul(column.substr(1));
      if (place <= titles.size()) places.push_back(place - 1);
    } else {
      const std::string plain = title_of(column).name;
      for (const bool as_written : {true, false})
        for (std::size_t i = 0; i < titles.size() && (as_written || places.size() != 1); ++i)
          if (as_written ? titles[i].written == column : titles[i].name == plain)
            places.push_back(i);
    }
    std::ranges::sort(places);
    const auto same = std::ranges::unique(places);
    places.erase(same.begin(), same.end());
    if (places.size() == 1)
      found.push_back(places.front());
    else if (missing.empty())
      missing = column, twice = places.size() > 1;
  }
  if (missing.empty()) return found;
  const bool closer = found.size() + (twice ? 1 : 0) > most_ || titles_.empty();
  if (!closer) return {};
  most_ = found.size() + (twice ? 1 : 0);
  line_ = line, missing_ = missing, twice_ = twice;
  titles_.clear();
  for (const TableTitle& title : titles) titles_ += (titles_.empty() ? "" : ", ") + title.written;
  return {};
}

void DescribedColumns::refuse(FileProblems& problems, const std::string& remedy) const {
  const bool number = missing_.starts_with('#');
  problems.add(line_, "", "",
               number ? fmt::format("column {} is missing or holds no number", missing_.substr(1))
               : twice_
                   ? fmt::format("the column '{}' is there twice", missing_)
                   : fmt::format("the column '{}' is missing: the line that comes closest "
                                 "is '{}'",
                                 missing_.empty() ? columns_.front() : missing_, shown(titles_)),
               twice_ ? "give its number" : remedy);
}

}  // namespace fingertip::studies::inline measurements
