#include "studies/measurements/material_test_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <set>
#include <utility>

#include "calibration/files/toml_file.h"
#include "calibration/material_tests/law_model.h"
#include "calibration/material_tests/strain_grid.h"
#include "meshes/base/errors.h"
#include "studies/files/json_entry.h"
#include "studies/measurements/material_test_table.h"
#include "studies/measurements/timed_test.h"

namespace fingertip::studies::inline measurements {

namespace {

namespace fs = std::filesystem;
using calibration::CurveRow;
using calibration::MaterialTest;
using calibration::TestCourse;
using calibration::TestKind;
using meshes::InvalidInput;
using std::string_view;

/// Points of a curve that is averaged, where nothing else is said.
constexpr long usual_points = 200, max_points = 1000;
/// Share of rows whose strain may step back.
constexpr double noise_share = 0.1;

const std::set<string_view> shared_keys = {
    "use",   "kind",   "deformation", "separator", "skip",   "header",   "decimal", "rows",
    "time",  "strain", "stress",      "sigma",     "area",   "length",   "speed",   "rate",
    "range", "points", "plates",      "diameter",  "height", "published"};
const std::set<string_view> about_keys = {"material", "source", "licence"};

/// One [[test]].
class TestReader {
 public:
  TestReader(const TestTable& test, MaterialTestFile& result) : test_(test), result_(result) {}

  void read();

 private:
  void read_kind();
  void read_sizes();
  /// Of the file, those that `rows` chooses.
  std::vector<CurveRow> rows_of(const fs::path& path);
  void read_slow(const std::vector<fs::path>& paths);
  void read_in_time(const fs::path& path);
  calibration::StrainCurve curve_of(const fs::path& path);
  void convert(calibration::StrainCurve curve);
  void keep_known_compression();
  void read_published();

  const TestTable& test_;
  MaterialTestFile& result_;
  MaterialTest found_;
  std::optional<double> area_, length_;
  std::optional<Plates> plates_;
  StrainColumn strain_;
  StressColumn stress_;
  std::optional<StressColumn> sigma_;
};

/// A kind of deformation, or a course in time, which names that apart.
void TestReader::read_kind() {
  std::vector<std::pair<string_view, TestKind>> kinds;
  for (const TestKind kind : values(TestKind())) kinds.emplace_back(name(kind), kind);
  const auto kind = test_.text("kind");
  for (const TestCourse course : {TestCourse::relaxation, TestCourse::cycles})
    if (kind == name(course)) found_.course = course;
  if (found_.course == TestCourse::slow) {
    if (!kind ||
        std::ranges::find(kinds, *kind, [](const auto& k) { return k.first; }) == kinds.end())
      test_.refuse("kind", kind.value_or(""),
                   fmt::format("must be one of {}, relaxation, cycles",
                               fmt::join(kinds | std::views::keys, ", ")),
                   "give one of them");
    for (const char* key : {"time", "deformation"})
      if (test_.has_own(key))
        test_.refuse(key, "", "belongs to tests of the kinds relaxation and cycles",
                     "write kind = \"cycles\" and deformation = \"uniaxial\", or leave it out");
    found_.kind = test_.word("kind", kinds);
    return;
  }
  std::erase_if(kinds, [](const auto& k) { return k.second == TestKind::volumetric; });
  found_.kind = test_.word("deformation", kinds, std::optional(TestKind::uniaxial));
  for (const char* key : {"range", "plates"})
    if (test_.has_own(key))
      test_.refuse(key, "", "belongs to tests without times",
                   "choose rows by rows = [first, last], and plates that slip");
}

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
  found_.rate = test_.quantity("rate", "1/s", "0.01 1/s");
  if (speed && found_.rate)
    test_.refuse("rate", test_.text("rate").value_or(""), "speed tells the rate, too",
                 "leave one of the two out");
  if (speed) found_.rate = *speed / *length_;
  if (found_.course != TestCourse::slow) return;
  if (!test_.word<bool>("plates", {{"slip", false}, {"stick", true}}, false)) return;
  if (found_.kind != TestKind::uniaxial || !diameter || !height)
    test_.refuse("plates", "stick",
                 "plates hold a cylinder of a uniaxial test with diameter and height",
                 "give both, or leave plates out");
  plates_ = Plates{*diameter, *height};
}

std::vector<CurveRow> TestReader::rows_of(const fs::path& path) {
  const FileText text = text_of(path);
  found_.source += (found_.source.empty() ? "" : ", ") + path.filename().string() + " (SHA-256 " +
                   text.sha256 + ")";
  TestColumns columns{strain_.column, stress_.column, sigma_ ? sigma_->column : "", {}};
  if (found_.course != TestCourse::slow) columns.time = test_.table("time")->column();
  std::vector<CurveRow> rows = described_rows(text, path, layout_of(test_), columns, result_.notes);
  const auto chosen = test_.pair("rows");
  if (!chosen) return rows;
  const auto [first, last] = *chosen;
  if (!(first >= 1.0 && last <= double(rows.size())))
    test_.refuse("rows", fmt::format("{} to {}", first, last),
                 fmt::format("{} has {} rows of data", path.filename().string(), rows.size()),
                 "count them from 1, without the header");
  return {rows.begin() + std::ptrdiff_t(first) - 1, rows.begin() + std::ptrdiff_t(last)};
}

calibration::StrainCurve TestReader::curve_of(const fs::path& path) {
  calibration::StrainCurve curve = rows_of(path);
  const std::size_t all = curve.size();
  const calibration::CurveCleaning removed = clean(curve, test_.pair("range"));
  if (curve.size() < 2)
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
void TestReader::convert(calibration::StrainCurve curve) {
  for (CurveRow& row : curve) row.x = strain_.deformation(found_.kind, row.x);
  if (found_.kind == TestKind::simple_shear)
    std::erase_if(curve, [](const CurveRow& row) { return row.x <= 0.0; });
  std::ranges::stable_sort(curve, {}, &CurveRow::x);
  for (const CurveRow& row : curve) {
    if (!found_.deformation.empty() && row.x == found_.deformation.back()) continue;
    found_.deformation.push_back(row.x);
    found_.stress.push_back(stress_.factor * row.y);
    if (sigma_) found_.sigma.push_back(std::abs(sigma_->factor) * row.sigma);
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

void TestReader::read_in_time(const fs::path& path) {
  const TestTable time = needed(test_, "time", "time = {column = 1, unit = \"s\"}");
  time.check_keys({"column", "unit", "from"});
  if (time.has("from") && !strain_.value)
    time.refuse("from", time.text("from").value_or(""), "the strain's column tells when it is held",
                "leave it out");
  const long usual = found_.course == TestCourse::relaxation ? usual_points : max_points;
  put_in_time(test_, path, strain_, stress_, sigma_.has_value(), rows_of(path),
              std::size_t(test_.whole("points", usual, 2, max_points)), found_, result_.notes);
}

/// Sums of squares in a file of JSON, where others published them.
void TestReader::read_published() {
  const auto table = test_.table("published");
  if (!table) return;
  const auto unit = table->text("unit");
  if (!unit) table->refuse("unit", "", "sums of squares need their unit", "write unit = \"kPa^2\"");
  const double factor = table->number_of("unit", "1 " + *unit, "Pa^2", "1 kPa^2");
  const JsonEntry file = read_entry(table->paths("path").front());
  for (const std::string& law : table->keys()) {
    if (law == "path" || law == "unit") continue;
    const std::string place = table->text(law).value_or("");
    if (!calibration::law_named(law) || place.empty())
      table->refuse(law, place, "must be a law and its place in the file",
                    "write e.g. yeoh-3 = \"material/yeoh/sum of squares\"");
    JsonEntry entry = file;
    for (const auto part : std::views::split(place, '/'))
      entry = entry.need(std::string(part.begin(), part.end()));
    const double sum = factor * entry.number();
    if (!(sum > 0.0 && std::isfinite(sum)))
      table->refuse(law, place, "the sum of squares there is not positive", "look at the file");
    found_.published[law] = sum;
  }
}

void TestReader::read() {
  read_kind();
  const std::vector<fs::path> paths = test_.paths("path");
  found_.name = test_.text("name").value_or(paths.front().stem().string());
  read_sizes();
  strain_ = strain_column(test_, found_.kind, length_, found_.course == TestCourse::relaxation);
  stress_ = stress_column(test_, area_);
  found_.measure = stress_.measure;
  if (const auto table = test_.table("sigma")) {
    table->check_keys({"column", "unit"});
    sigma_ = stress_;
    sigma_->column = table->column();
  }
  if (found_.course == TestCourse::slow)
    read_slow(paths);
  else if (paths.size() == 1)
    read_in_time(paths.front());
  else
    test_.refuse("path", fmt::format("{} files", paths.size()), "tests in time are not averaged",
                 "give each file a [[test]] of its own");
  const auto broken = found_.violations();
  if (!broken.empty())
    test_.refuse("strain", broken.front().key + " = " + broken.front().value, broken.front().rule,
                 broken.front().remedy);
  const bool held = test_.word<bool>("use", {{"fit", false}, {"predict", true}}, false);
  found_.licence = result_.licence;
  read_published();
  (held ? result_.validation : result_.fitted).push_back(found_);
  // Fitted ones come first.
  result_.stuck.insert(held ? result_.stuck.end()
                            : result_.stuck.begin() + std::ptrdiff_t(result_.fitted.size()) - 1,
                       plates_);
}

void TestReader::read_slow(const std::vector<fs::path>& paths) {
  std::vector<calibration::StrainCurve> curves;
  for (const fs::path& path : paths) curves.push_back(curve_of(path));
  const bool many =
      curves.size() > 1 || test_.has("points") || curves.front().size() > std::size_t(usual_points);
  const long points = test_.whole("points", usual_points, 2, max_points);
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
}

/// How tests without times count beside others.
void note_rates(MaterialTestFile& file) {
  const auto slow = [](const MaterialTest& test) { return test.course == TestCourse::slow; };
  if (std::ranges::all_of(file.fitted, slow)) return;
  for (const auto* list : {&file.fitted, &file.validation})
    for (const MaterialTest& test : *list)
      if (slow(test) && test.kind != TestKind::volumetric)
        file.notes.push_back(
            test.rate ? fmt::format("{}: a relaxation counts at its rate, {:.3g} 1/s", test.name,
                                    *test.rate)
                      : fmt::format("{}: without speed or rate it counts as after long times",
                                    test.name));
}

}  // namespace

MaterialTestFile read_material_tests(const fs::path& file) {
  const toml::table root = calibration::parsed_toml(file, "mend the file");
  MaterialTestFile result;
  const TestTable whole(file, root, "");
  whole.check_keys({"about", "data", "test"});
  if (const auto about = whole.table("about")) {
    about->check_keys(about_keys);
    result.material = about->text("material").value_or("");
    result.source = about->text("source").value_or("");
    result.licence = about->text("licence").value_or("");
  }
  each_table(file, root, "test", "path and kind", shared_keys,
             [&](const TestTable& test) { TestReader(test, result).read(); });
  if (result.fitted.empty())
    whole.refuse("test", "", "at least one test is fitted", "write use = \"fit\"");
  note_rates(result);
  return result;
}

}  // namespace fingertip::studies::inline measurements
