#include "studies/run/material_test_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <toml++/toml.h>

#include "calibration/toml_depth.h"
#include "meshes/csv_table.h"
#include "meshes/errors.h"
#include "meshes/text_file.h"
#include "studies/config/units.h"
#include "studies/config/value_reader.h"
#include "studies/run/digest.h"
#include "studies/run/plate_factor.h"
#include "studies/run/strain_grid.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;
using calibration::MaterialTest;
using calibration::StressMeasure;
using calibration::TestKind;
using meshes::InvalidInput;
using std::string_view;

/// Points of a curve that is averaged, where nothing else is said.
constexpr long usual_points = 200, most_points = 1000;
/// Share of rows whose strain may step back.
constexpr double noise_share = 0.1;
constexpr const char* lay_out = "compare the file with its [data] table";

const std::set<string_view> shared_keys = {
    "use",   "kind", "separator", "skip",  "header", "decimal", "rows",   "strain",   "stress",
    "sigma", "area", "length",    "speed", "range",  "points",  "plates", "diameter", "height"};
const std::set<string_view> about_keys = {"material", "source", "licence"};

/// One table of the file; says where things stand.
class TestTable {
 public:
  TestTable(const fs::path& file, const toml::table& own, std::string place,
            const toml::table* common = nullptr)
      : file_(file), own_(own), place_(std::move(place)), common_(common) {}

  [[noreturn]] void refuse(string_view key, const std::string& value, const std::string& rule,
                           const std::string& remedy) const {
    const toml::node* at = find(key);
    const auto line = (at != nullptr ? at->source() : own_.source()).begin.line;
    throw InvalidInput({fmt::format("{}:{}: {}{}{}", file_.string(), line, place_,
                                    place_.empty() || key.empty() ? "" : ".", key),
                        value, rule, remedy});
  }

  void check_keys(const std::set<string_view>& known) const {
    for (const auto& [key, value] : own_)
      if (!known.contains(key.str()))
        refuse(key.str(), unquoted(toml_literal(value)), "no such key",
               "the keys are " + fmt::format("{}", fmt::join(known, ", ")));
  }

  bool has(string_view key) const { return find(key) != nullptr; }

  std::optional<std::string> text(string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto value = node->value_exact<std::string>();
    if (!value) refuse(key, toml_literal(*node), "must be a text", "put it in quotes");
    return value;
  }

  long whole(string_view key, long usual, long least, long most) const {
    const toml::node* node = find(key);
    if (node == nullptr) return usual;
    const auto value = node->value_exact<std::int64_t>();
    if (!value || *value < least || *value > most)
      refuse(key, toml_literal(*node),
             fmt::format("must be a whole number from {} to {}", least, most), "give one");
    return long(*value);
  }

  bool flag(string_view key, bool usual) const {
    const toml::node* node = find(key);
    if (node == nullptr) return usual;
    const auto value = node->value_exact<bool>();
    if (!value) refuse(key, toml_literal(*node), "must be true or false", "write one of them");
    return *value;
  }

  /// Positive, in the SI unit.
  std::optional<double> quantity(string_view key, const std::string& unit,
                                 const std::string& example) const {
    const auto written = text(key);
    if (!written) return std::nullopt;
    return number_of(key, *written, unit, example);
  }

  double number_of(string_view key, const std::string& written, const std::string& unit,
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

  /// Two numbers in order.
  std::optional<std::array<double, 2>> pair(string_view key) const {
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

  /// The choice of that name.
  template <typename Choice>
  Choice word(string_view key, const std::vector<std::pair<string_view, Choice>>& choices,
              std::optional<Choice> usual = std::nullopt) const {
    const auto written = text(key);
    if (!written && usual) return *usual;
    std::string names;
    for (const auto& [name, choice] : choices) {
      if (written == name) return choice;
      names += (names.empty() ? "" : ", ") + std::string(name);
    }
    refuse(key, written.value_or(""), "must be one of " + names, "give one of them");
  }

  std::optional<TestTable> table(string_view key) const {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_table())
      refuse(key, toml_literal(*node), "must be a table",
             "write e.g. {column = 1, unit = \"kPa\"}");
    return TestTable(file_, *node->as_table(), place_ + "." + std::string(key));
  }

  std::vector<fs::path> paths(string_view key) const {
    const toml::node* node = find(key);
    std::vector<fs::path> found;
    const auto add = [&](const toml::node& one) {
      const auto written = one.value_exact<std::string>();
      if (!written || written->empty())
        refuse(key, toml_literal(one), "must be the path of a file, or a list of paths",
               "put it in quotes");
      found.push_back(file_.parent_path() / *written);
    };
    if (node != nullptr && node->is_array()) {
      for (const toml::node& one : *node->as_array()) add(one);
    } else if (node != nullptr) {
      add(*node);
    }
    if (found.empty()) refuse(key, "", "a test needs the path of its file", "give it");
    return found;
  }

  /// The name of the column in the header, or its number.
  std::string column() const {
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

 private:
  const toml::node* find(string_view key) const {
    const toml::node* node = own_.get(key);
    return node == nullptr && common_ != nullptr ? common_->get(key) : node;
  }

  const fs::path& file_;
  const toml::table& own_;
  std::string place_;
  const toml::table* common_;
};

enum class StrainMeasure { stretch, engineering, logarithmic, displacement, shear, ratio, change };

/// What the numbers of a column mean.
struct StrainColumn {
  std::string column;
  StrainMeasure measure = StrainMeasure::stretch;
  double factor = 1.0, length = 1.0;

  double deformation(TestKind kind, double value) const {
    const double strain = factor * value;
    switch (measure) {
      case StrainMeasure::engineering:
      case StrainMeasure::change: return 1.0 + strain;
      case StrainMeasure::logarithmic: return std::exp(strain);
      case StrainMeasure::displacement:
        return (kind == TestKind::simple_shear ? 0.0 : 1.0) + strain / length;
      default: return strain;
    }
  }
};

struct StressColumn {
  std::string column;
  StressMeasure measure = StressMeasure::nominal;
  double factor = 1.0;  ///< Pa over the file's unit, with the sign
};

double sign_of(const TestTable& table) {
  const long sign = table.whole("sign", 1, -1, 1);
  if (sign == 0) table.refuse("sign", "0", "must be 1 or -1", "write sign = -1 to turn it about");
  return double(sign);
}

TestTable needed(const TestTable& test, string_view key, const char* example) {
  const auto table = test.table(key);
  if (!table) test.refuse(key, "", "a test needs it", std::string("write e.g. ") + example);
  return *table;
}

StrainColumn strain_column(const TestTable& test, TestKind kind, std::optional<double> length) {
  const TestTable table = needed(test, "strain", "strain = {column = 1, is = \"stretch\"}");
  table.check_keys({"column", "is", "unit", "sign"});
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
  StrainColumn result{table.column(), table.word("is", known), sign_of(table), 1.0};
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

std::vector<double> numbers(const meshes::CsvTable& table, const std::string& column) {
  if (!column.starts_with('#')) return table.numbers(column);
  const std::size_t place = std::stoul(column.substr(1));
  if (place > table.names.size())
    throw InvalidInput(
        {table.file.string(), column.substr(1),
         fmt::format("the number of a column is at most that of the table, {}", table.names.size()),
         lay_out});
  return table.numbers(table.names[place - 1]);
}

/// One [[test]].
class TestReader {
 public:
  TestReader(const TestTable& test, MaterialTestFile& result) : test_(test), result_(result) {}

  void read();

 private:
  void read_sizes();
  StrainCurve curve_of(const fs::path& path);
  void convert(const StrainCurve& curve);
  void keep_known_compression();

  const TestTable& test_;
  MaterialTestFile& result_;
  MaterialTest found_;
  std::optional<double> area_, length_;
  std::optional<Plates> plates_;
  StrainColumn strain_;
  StressColumn stress_;
  std::optional<StressColumn> sigma_;
};

void TestReader::read_sizes() {
  const auto diameter = test_.quantity("diameter", "m", "50 mm"),
             height = test_.quantity("height", "m", "30 mm");
  area_ = test_.quantity("area", "m^2", "18 mm^2");
  length_ = test_.quantity("length", "m", "33 mm");
  if (!area_ && diameter) area_ = 0.25 * std::numbers::pi * *diameter * *diameter;
  if (!length_) length_ = height;
  const auto speed = test_.quantity("speed", "m/s", "10 mm/min");
  if (speed && !length_)
    test_.refuse("speed", test_.text("speed").value_or(""),
                 "the rate of strain is speed over length", "give length or height");
  if (speed) found_.rate = *speed / *length_;
  if (!test_.word<bool>("plates", {{"slip", false}, {"stick", true}}, false)) return;
  if (found_.kind != TestKind::uniaxial || !diameter || !height)
    test_.refuse("plates", "stick",
                 "plates hold a cylinder of a uniaxial test with diameter and height",
                 "give both, or leave plates out");
  plates_ = Plates{*diameter, *height};
}

StrainCurve TestReader::curve_of(const fs::path& path) {
  meshes::CsvFormat format;
  format.separator = test_.word<char>(
      "separator", {{"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"whitespace", ' '}}, ',');
  format.decimal_comma = test_.word<bool>("decimal", {{"point", false}, {"comma", true}}, false);
  if (format.decimal_comma && format.separator == ',')
    test_.refuse("decimal", "comma", "commas cannot separate cells and decimals alike",
                 "give another separator");
  format.skip = std::size_t(test_.whole("skip", 0, 0, 1000000));
  format.has_names = test_.flag("header", true);
  format.complete = false;
  format.remedy = lay_out;
  const meshes::CsvTable table = meshes::read_csv(path, format);
  StrainCurve curve{numbers(table, strain_.column), numbers(table, stress_.column), {}};
  if (sigma_) curve.sigma = numbers(table, sigma_->column);
  if (const auto rows = test_.pair("rows")) {
    if (!((*rows)[0] >= 1.0 && (*rows)[1] <= double(curve.strain.size())))
      test_.refuse(
          "rows", fmt::format("{} to {}", (*rows)[0], (*rows)[1]),
          fmt::format("{} has {} rows of data", path.filename().string(), curve.strain.size()),
          "count them from 1, without the header");
    curve.keep(std::size_t((*rows)[0]) - 1, std::size_t((*rows)[1]));
  }
  const std::size_t all = curve.strain.size();
  const CurveCleaning removed = clean(curve, test_.pair("range"));
  if (curve.strain.size() < 2)
    test_.refuse("path", path.filename().string(), "fewer than two points are left",
                 "look at rows, range and the columns");
  if (double(removed.backward) > noise_share * double(all))
    test_.refuse("path", path.filename().string(),
                 fmt::format("the strain steps back in {} of {} rows: the curve turns back",
                             removed.backward, all),
                 "choose one branch by rows = [first, last]");
  if (removed.backward + removed.empty > 0)
    result_.notes.push_back(
        fmt::format("{}: {} rows where the strain steps back and {} empty ones were left out",
                    path.filename().string(), removed.backward, removed.empty));
  return curve;
}

/// To stretch, shear or J, increasing.
void TestReader::convert(const StrainCurve& curve) {
  struct Point {
    double deformation, stress, sigma;
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < curve.strain.size(); ++i)
    points.push_back({strain_.deformation(found_.kind, curve.strain[i]),
                      stress_.factor * curve.stress[i],
                      sigma_ ? std::abs(sigma_->factor) * curve.sigma[i] : 0.0});
  if (found_.kind == TestKind::simple_shear)
    std::erase_if(points, [](const Point& point) { return point.deformation <= 0.0; });
  std::ranges::stable_sort(points, {}, &Point::deformation);
  for (const Point& point : points) {
    if (!found_.deformation.empty() && point.deformation == found_.deformation.back()) continue;
    found_.deformation.push_back(point.deformation);
    found_.stress.push_back(point.stress);
    if (sigma_) found_.sigma.push_back(point.sigma);
  }
}

void TestReader::keep_known_compression() {
  std::size_t deep = 0;
  while (deep < found_.deformation.size() &&
         found_.deformation[deep] < 1.0 - deepest_stuck_compression)
    ++deep;
  if (deep == 0) return;
  for (std::vector<double>* column : {&found_.deformation, &found_.stress, &found_.sigma})
    if (!column->empty()) column->erase(column->begin(), column->begin() + std::ptrdiff_t(deep));
  result_.notes.push_back(
      fmt::format("{}: {} points beyond {:.0f} % of compression were left out: there the force "
                  "between stuck plates is not known",
                  found_.name, deep, 100.0 * deepest_stuck_compression));
}

void TestReader::read() {
  std::vector<std::pair<string_view, TestKind>> kinds;
  for (const TestKind kind : values(TestKind())) kinds.emplace_back(name(kind), kind);
  found_.kind = test_.word("kind", kinds);
  const std::vector<fs::path> paths = test_.paths("path");
  found_.name = test_.text("name").value_or(paths.front().stem().string());
  read_sizes();
  strain_ = strain_column(test_, found_.kind, length_);
  stress_ = stress_column(test_, area_);
  found_.measure = stress_.measure;
  if (const auto table = test_.table("sigma")) {
    table->check_keys({"column", "unit"});
    sigma_ = stress_;
    sigma_->column = table->column();
  }
  std::vector<StrainCurve> curves;
  for (const fs::path& path : paths) {
    curves.push_back(curve_of(path));
    found_.source += (found_.source.empty() ? "" : ", ") + path.filename().string() + " (SHA-256 " +
                     sha256(meshes::read_text(path)) + ")";
  }
  const bool many = curves.size() > 1 || test_.has("points") ||
                    curves.front().strain.size() > std::size_t(usual_points);
  const long points = test_.whole("points", usual_points, 2, most_points);
  if (many && sigma_)
    test_.refuse("sigma", sigma_->column, "a curve that is averaged has no sigma of its own",
                 "leave sigma out");
  const auto mean = many ? mean_curve(curves, std::size_t(points)) : curves.front();
  if (!mean)
    test_.refuse("path", fmt::format("{} files", curves.size()),
                 "the repeats have no strain in common", "compare their columns");
  if (many)
    result_.notes.push_back(fmt::format("{}: {} file(s), {} stresses at equal steps of the strain",
                                        found_.name, curves.size(), points));
  convert(*mean);
  if (plates_) keep_known_compression();
  const auto broken = found_.violations();
  if (!broken.empty())
    test_.refuse("strain", broken.front().key + " = " + broken.front().value, broken.front().rule,
                 broken.front().remedy);
  const bool held = test_.word<bool>("use", {{"fit", false}, {"predict", true}}, false);
  found_.licence = result_.licence;
  (held ? result_.held_back : result_.fitted).push_back(found_);
  // Fitted ones come first.
  result_.stuck.insert(held ? result_.stuck.end()
                            : result_.stuck.begin() + std::ptrdiff_t(result_.fitted.size()) - 1,
                       plates_);
}

toml::table parsed(const fs::path& file) {
  const std::string text = meshes::read_text(file);
  if (calibration::nests_too_deep(text))
    throw InvalidInput({file.string(), "", "a key has hundreds of dotted parts", "mend the file"});
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw InvalidInput({fmt::format("{}:{}", file.string(), error.source().begin.line), "",
                        "not valid TOML: " + std::string(error.description()), "mend the line"});
  }
}

}  // namespace

MaterialTestFile read_material_tests(const fs::path& file) {
  const toml::table root = parsed(file);
  MaterialTestFile result;
  const TestTable whole(file, root, "");
  whole.check_keys({"about", "data", "test"});
  if (const auto about = whole.table("about")) {
    about->check_keys(about_keys);
    result.material = about->text("material").value_or("");
    result.source = about->text("source").value_or("");
    result.licence = about->text("licence").value_or("");
  }
  if (const auto data = whole.table("data")) data->check_keys(shared_keys);
  const toml::array* tests = root["test"].as_array();
  if (tests == nullptr || tests->empty())
    whole.refuse("test", "", "the file names no test", "write [[test]] with path and kind");
  std::set<string_view> known = shared_keys;
  known.insert({"name", "path"});
  std::size_t count = 0;
  for (const toml::node& node : *tests) {
    if (!node.is_table())
      whole.refuse("test", "", "every test is a table", "write [[test]] above its keys");
    const TestTable test(file, *node.as_table(), fmt::format("test[{}]", ++count),
                         root["data"].as_table());
    test.check_keys(known);
    TestReader(test, result).read();
  }
  if (result.fitted.empty())
    whole.refuse("test", "", "at least one test is fitted", "write use = \"fit\"");
  return result;
}

}  // namespace fingertip::studies
