#include "studies/measurements/material_test_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "meshes/base/errors.h"
#include "meshes/tables/csv_table.h"
#include "studies/config/text/units.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline measurements {

namespace fs = std::filesystem;
using calibration::StressMeasure;
using calibration::TestKind;
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
  if (!written.starts_with('$')) return file_.parent_path() / written;
  const auto slash = std::min(written.find('/'), written.size());
  const std::string variable = written.substr(1, slash - 1);
  const char* const folder = std::getenv(variable.c_str());
  if (folder == nullptr || *folder == '\0')
    refuse(key, written, "no environment variable " + variable + " is set",
           "set it to the folder of the data");
  return fs::path(folder) / written.substr(std::min(slash + 1, written.size()));
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

double sign_of(const TestTable& table) {
  const long sign = table.whole("sign", 1, -1, 1);
  if (sign == 0) table.refuse("sign", "0", "must be 1 or -1", "write sign = -1 to turn it about");
  return double(sign);
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

double StrainColumn::deformation(TestKind kind, double number) const {
  const double strain = factor * number;
  switch (measure) {
    case StrainMeasure::engineering:
    case StrainMeasure::change: return 1.0 + strain;
    case StrainMeasure::logarithmic: return std::exp(strain);
    case StrainMeasure::displacement: return rest_of(kind) + strain / length;
    default: return strain;
  }
}

StrainColumn strain_column(const TestTable& test, TestKind kind, std::optional<double> length,
                           bool may_hold) {
  const TestTable table =
      needed(test, "strain",
             may_hold ? "strain = {value = 0.5, is = \"engineering\"}, or column = 2"
                      : "strain = {column = 1, is = \"stretch\"}");
  std::set<string_view> keys = {"column", "is", "unit", "sign"};
  if (may_hold) keys.insert("value");
  table.check_keys(keys);
  using enum StrainMeasure;
  std::vector<std::pair<string_view, StrainMeasure>> known;
  if (kind == TestKind::simple_shear)
    known = {{"shear", shear}, {"displacement", displacement}};
  else if (kind == TestKind::volumetric)
    known = {{"volume-ratio", ratio}, {"volume-change", change}};
  else
    known = {{"stretch", stretch},
             {"engineering", engineering},
             {"logarithmic", logarithmic},
             {"displacement", displacement}};
  StrainColumn result;
  result.value = table.number("value");
  if (!result.value) result.column = table.column();
  if (result.value && table.has("column"))
    table.refuse("value", "beside column", "a strain is a column or a value", "leave one out");
  result.measure = table.word("is", known);
  result.factor = sign_of(table);
  if (result.measure == displacement) {
    if (!length)
      test.refuse("length", "", "a displacement needs the length (or height) that it belongs to",
                  "write e.g. length = \"33 mm\"");
    result.length = *length;
    const auto unit = table.text("unit").value_or("");
    result.factor *= table.number_of("unit", "1 " + unit, "m", "1 mm");
  } else if (const auto unit = table.text("unit")) {
    if (*unit != "1" && *unit != "%")
      table.refuse("unit", *unit, "a strain has the unit 1 or %", "leave it out, or write %");
    if (*unit == "%") result.factor *= 0.01;
  }
  return result;
}

StressColumn stress_column(const TestTable& test, std::optional<double> area) {
  const TestTable table =
      needed(test, "stress", "stress = {column = 2, is = \"nominal\", unit = \"kPa\"}");
  table.check_keys({"column", "is", "unit", "sign"});
  enum class Measure { nominal, cauchy, force, pressure };
  const Measure measure = table.word<Measure>("is", {{"nominal", Measure::nominal},
                                                     {"true", Measure::cauchy},
                                                     {"force", Measure::force},
                                                     {"pressure", Measure::pressure}});
  const bool force = measure == Measure::force;
  const auto unit = table.text("unit");
  if (!unit)
    table.refuse("unit", "", "a stress or force needs its unit", "write e.g. unit = \"kPa\"");
  StressColumn result{table.column(),
                      measure == Measure::cauchy ? StressMeasure::cauchy : StressMeasure::nominal,
                      sign_of(table)};
  result.factor *=
      table.number_of("unit", "1 " + *unit, force ? "N" : "Pa", force ? "1 N" : "1 kPa");
  if (measure == Measure::pressure) result.factor = -result.factor;
  if (force) {
    if (!area)
      test.refuse("area", "", "a force needs the area at rest that it acts on",
                  "write e.g. area = \"18 mm^2\", or diameter");
    result.factor /= *area;
  }
  return result;
}

std::vector<calibration::CurveRow> described_rows(const FileText& text, const fs::path& file,
                                                  TableLayout layout, const TestColumns& columns,
                                                  std::vector<std::string>& notes) {
  using calibration::CurveRow;
  constexpr const char* remedy = "compare the file with its [data] table";
  std::vector<std::string> names;
  std::vector<double CurveRow::*> members;
  for (const auto& [name, member] : {std::pair(columns.stress, &CurveRow::y),
                                     {columns.strain, &CurveRow::x},
                                     {columns.sigma, &CurveRow::sigma},
                                     {columns.time, &CurveRow::time}})
    if (!name.empty()) names.push_back(name), members.push_back(member);
  DescribedColumns choose(names);
  if (choose.all_numbered()) layout.has_names = false;
  FileProblems problems(file);
  const TextTables found = tables_in(text.text, layout, std::ref(choose), problems);
  if (found.tables.empty()) choose.refuse(problems, remedy);
  if (found.tables.size() > 1)
    problems.add(found.tables[1].header_line, "", "", "a second table begins here",
                 "give each test a file of its own");
  problems.throw_if_any();
  for (const std::string& note : found.notes)
    notes.push_back(file.filename().string() + ": " + note);
  const TextTable& table = found.tables.front();
  std::vector<CurveRow> rows(table.rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row].line = table.lines[row];
    for (std::size_t i = 0; i < members.size(); ++i) {
      const std::size_t column = table.needed[i];
      const std::string& cell = table.rows[row][column];
      const double value = table.number(row, column).value_or(INFINITY);
      rows[row].*members[i] = cell.empty() ? meshes::unknown : value;
      if (!cell.empty() && !(std::abs(value) <= meshes::largest_plausible))
        problems.add(table.lines[row], table.titles[column].written, shown(cell),
                     "must be a finite number, or nothing", remedy);
    }
  }
  problems.throw_if_any();
  return rows;
}

}  // namespace fingertip::studies::inline measurements
