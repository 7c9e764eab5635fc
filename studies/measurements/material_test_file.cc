#include "studies/measurements/material_test_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ranges>
#include <set>
#include <utility>

#include "calibration/files/toml_file.h"
#include "calibration/files/words.h"
#include "calibration/material_tests/law_model.h"
#include "calibration/material_tests/strain_grid.h"
#include "meshes/base/errors.h"
#include "studies/files/json_entry.h"
#include "studies/measurements/curve_rows.h"
#include "studies/measurements/material_test_table.h"
#include "studies/measurements/timed_test.h"

namespace fingertip::studies::inline measurements {

namespace {

namespace fs = std::filesystem;
using calibration::CurveRow;
using calibration::MaterialTest;
using calibration::StrainCurve;
using calibration::TestCourse;
using calibration::TestKind;
using meshes::InvalidInput;
using std::string_view;

/// Points of a curve that is averaged, where nothing else is said.
constexpr long usual_points = 200, max_points = 1000;
/// No rubber is stretched further, or to less than one over it: Ecoflex 00-10 breaks at 9.
constexpr double largest_stretch = 12.0;

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
  void to_si(const DescribedRows& read, std::vector<CurveRow>& rows) const;
  StrainCurve curve_of(const fs::path& path);
  void check_start(const fs::path& path, const std::vector<CurveRow>& rows, bool both) const;
  void check_signs(const fs::path& path, const std::vector<CurveRow>& rows) const;
  std::size_t take_off_rest(double rest, std::vector<CurveRow>& rows,
                            std::vector<std::string>& told);
  void read_zeros();
  void doubt_stretches();
  void convert(StrainCurve curve);
  void note(const fs::path& path, const std::string& sentence) {
    result_.notes.push_back(path.filename().string() + ": " + sentence);
  }
  void keep_known_compression();
  void read_published();

  const TestTable& test_;
  MaterialTestFile& result_;
  MaterialTest found_;
  std::optional<double> area_, length_;
  std::optional<Plates> plates_;
  StrainColumn strain_;
  StressColumn stress_;
  std::optional<DescribedColumn> sigma_, time_;
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
  TestColumns columns{&strain_, &stress_, sigma_ ? &*sigma_ : nullptr, time_ ? &*time_ : nullptr};
  DescribedRows read = described_rows(text, path, layout_of(test_), columns, result_.notes);
  std::vector<CurveRow> rows = std::move(read.rows);
  if (const auto chosen = test_.pair("rows")) {
    const auto [first, last] = *chosen;
    if (!(first >= 1.0 && last <= double(rows.size())))
      test_.refuse("rows", fmt::format("{} to {}", first, last),
                   fmt::format("{} has {} rows of data", path.filename().string(), rows.size()),
                   "count them from 1, without the header");
    rows = {rows.begin() + std::ptrdiff_t(first) - 1, rows.begin() + std::ptrdiff_t(last)};
  }
  const auto range = test_.pair("range");
  std::erase_if(rows, [&](const CurveRow& row) {
    return range && (row.x < (*range)[0] || row.x > (*range)[1]);
  });
  const auto has_gap = [](const CurveRow& row) {
    return std::isnan(row.time + row.x + row.y + row.sigma);
  };
  if (const std::size_t empty = std::erase_if(rows, has_gap); empty > 0)
    note(path, fmt::format("{} rows with empty cells were left out", empty));
  if (rows.size() < 2)
    test_.refuse("path", path.filename().string(), "fewer than two rows are left",
                 "look at rows, range and the columns");
  to_si(read, rows);
  return rows;
}

/// Their zeros taken off, in SI; forces over the area.
void TestReader::to_si(const DescribedRows& read, std::vector<CurveRow>& rows) const {
  const double area = stress_.area.value_or(1.0),
               x = zero_in(strain_.described.zero, rows.front().x, read.strain),
               y = zero_in(stress_.described.zero, rows.front().y, read.stress);
  for (CurveRow& row : rows) {
    row.x = read.strain.factor * (row.x - x);
    row.y = read.stress.factor * (row.y - y) / area;
    row.sigma *= std::abs(read.sigma.factor) / area;
    row.time *= read.time.factor;
  }
}

/// Strains as distances from rest in the way in which the test goes, stresses as they grow with
/// them: faults of rows are found as those of presses. `both`: of a test that goes both ways the
/// strains stay.
StrainCurve TestReader::curve_of(const fs::path& path) {
  std::vector<CurveRow> rows = rows_of(path);
  std::vector<std::string> told;
  const Abscissa abscissa{"strain", strain_.si(), 1.0, true};
  leave_out_odd(rows, abscissa, true, told);
  const double rest = strain_.at_rest();
  const auto [low, high] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double below = rest - low->x, above = high->x - rest;
  constexpr double one_sided = 0.1;
  const bool both = std::min(below, above) > one_sided * std::max(below, above);
  const double way = above >= below ? 1.0 : -1.0;
  for (CurveRow& row : rows) row.x = way * (row.x - rest), row.y *= way;
  if (!both) put_in_order(rows, abscissa, told);
  if (both && rows.front().x > rows.back().x) std::ranges::reverse(rows);
  check_start(path, rows, both);
  // What a single row tells has its noise.
  if (stress_.described.zero.by == ColumnZero::By::first_row)
    found_.stress_zero_error = noise_of(rows);
  check_signs(path, rows);
  if (!both) {
    const std::size_t at_rest = take_off_rest(0.0, rows, told);
    if (at_rest > 0) rows.erase(rows.begin(), rows.begin() + std::ptrdiff_t(at_rest) - 1);
    calibration::LoadingHistory course;
    rows = loading(std::move(rows), abscissa, course, told);
    leave_out_clipped(rows, abscissa, told);
  }
  FileProblems problems(path);
  const auto points = std::size_t(test_.whole("points", usual_points, 2, max_points));
  const calibration::Curve curve =
      fingertip::studies::measurements::curve_of(rows, abscissa, problems, told, points);
  problems.throw_if_any();
  for (const std::string& sentence : told) note(path, sentence);
  StrainCurve found;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    found.push_back(
        {rest + way * curve.x[i], way * curve.y[i], curve.sigma.empty() ? 0.0 : curve.sigma[i]});
  return found;
}

/// A displacement counts from rest.
void TestReader::check_start(const fs::path& path, const std::vector<CurveRow>& rows,
                             bool both) const {
  constexpr double far = 0.5;  // of the way
  const auto [low, high] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double nearest = std::min(std::abs(low->x), std::abs(high->x)), way = high->x - low->x;
  const bool chosen = test_.has("rows") || test_.has("range") ||
                      strain_.described.zero.by != ColumnZero::By::nothing;
  if (strain_.measure != StrainMeasure::displacement || both || chosen || !(nearest > far * way))
    return;
  test_.refuse("strain", path.filename().string(),
               fmt::format("its displacement begins {:.4g} mm from rest and goes on by {:.4g} mm",
                           1e3 * nearest, 1e3 * way),
               "where its zero is elsewhere, write zero = \"first row\" in strain, or the number "
               "at rest");
}

/// Stress grows with strain from rest on, whatever its zero.
void TestReader::check_signs(const fs::path& path, const std::vector<CurveRow>& rows) const {
  double mean = 0.0, together = 0.0;
  for (const CurveRow& row : rows) mean += row.x / double(rows.size());
  for (const CurveRow& row : rows) together += (row.x - mean) * row.y;
  if (together > 0.0) return;
  test_.refuse(
      "stress", path.filename().string(),
      "falls where the strain grows from rest on, in the sense of this test: in tension both are "
      "positive, in compression negative",
      "turn one of them about: sign = -1 in stress or in strain");
}

/// Rows at the strain `rest`, before anything moves, tell the zero of the stress, unless it is
/// described. How many there are.
std::size_t TestReader::take_off_rest(double rest, std::vector<CurveRow>& rows,
                                      std::vector<std::string>& told) {
  constexpr double near = 0.02, matters = 0.002;
  const auto found = rows_at_rest(rows);
  const auto by = stress_.described.zero.by;
  if (!found || (by != ColumnZero::By::nothing && by != ColumnZero::By::fit)) return 0;
  double range = 0.0, most = 0.0;
  for (const CurveRow& row : rows)
    range = std::max(range, std::abs(row.x - rest)), most = std::max(most, std::abs(row.y));
  if (std::abs(found->x - rest) > near * range) return 0;
  for (CurveRow& row : rows) row.y -= found->y;
  found_.stress_zero_known = true;
  found_.stress_zero_sought = false;
  found_.stress_zero_error = found->y_error;
  if (std::abs(found->y) > matters * most)
    told.push_back(
        fmt::format("{} rows at rest tell the stress {:.4g} Pa, {} of the largest: "
                    "it is taken off as the load cell's zero",
                    found->count, found->y, calibration::percent(std::abs(found->y) / most)));
  return found->count;
}

/// To stretch, shear or J, increasing.
void TestReader::convert(StrainCurve curve) {
  for (CurveRow& row : curve) row.x = strain_.deformation(found_.kind, row.x);
  if (found_.kind == TestKind::simple_shear) {
    std::erase_if(curve, [](const CurveRow& row) { return row.x <= 0.0; });
    if (curve.empty())
      test_.refuse("strain", found_.name, "a shear is positive, and all of these are negative",
                   "write sign = -1 in strain and in stress, or kind = \"uniaxial\" of a "
                   "compression");
  }
  std::ranges::stable_sort(curve, {}, &CurveRow::x);
  for (const CurveRow& row : curve) {
    if (!found_.deformation.empty() && row.x == found_.deformation.back()) continue;
    found_.deformation.push_back(row.x);
    found_.stress.push_back(row.y);
    if (sigma_) found_.sigma.push_back(row.sigma);
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
  time_ = described_column(time, "time", "s", "s", {"from"});
  if (time.has("from") && !strain_.value)
    time.refuse("from", time.text("from").value_or(""), "the strain's column tells when it is held",
                "leave it out");
  const long usual = found_.course == TestCourse::relaxation ? usual_points : max_points;
  std::vector<CurveRow> rows = rows_of(path);
  std::vector<std::string> told;
  if (!strain_.value) {
    leave_out_odd(rows, {"strain", strain_.si(), 1.0, false}, false, told);
    take_off_rest(strain_.at_rest(), rows, told);
  }
  for (const std::string& sentence : told) note(path, sentence);
  if (found_.course == TestCourse::relaxation && !found_.stress_zero_known)
    note(path,
         "no row before the ramp tells the load cell's zero: its stress counts as it stands; "
         "write zero in stress where it is known");
  put_in_time(test_, path, strain_, sigma_.has_value(), std::move(rows),
              std::size_t(test_.whole("points", usual, 2, max_points)), found_, result_.notes);
}

/// Stretches that no rubber bears are told, with what they may come from.
void TestReader::doubt_stretches() {
  if (found_.kind == TestKind::volumetric) return;
  const auto [least, most] = std::ranges::minmax(found_.all_deformations());
  const bool is_shear = found_.kind == TestKind::simple_shear;
  if (most <= largest_stretch && (is_shear || least >= 1.0 / largest_stretch)) return;
  found_.doubts.push_back(fmt::format(
      "{} goes to the stretches {:.3g} to {:.3g}, which no rubber bears (1/{:.0f} to {:.0f}): is "
      "its "
      "strain in per cent, then write unit = \"%\" in strain; or is it a displacement, or a "
      "stretch told as strain?",
      found_.name, least, most, largest_stretch, largest_stretch));
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

/// What is told of the zeros of strain and stress.
void TestReader::read_zeros() {
  using enum ColumnZero::By;
  found_.stress_zero_known = stress_.described.zero.by != nothing;
  found_.stress_zero_sought = stress_.described.zero.by == fit;
  found_.strain_zero_sought = strain_.described.zero.by == fit;
  if (found_.kind == TestKind::volumetric &&
      (found_.stress_zero_sought || found_.strain_zero_sought))
    test_.refuse("kind", "volumetric", "zeros are sought of tests that change the shape",
                 "give the zero, or leave it out");
  if (found_.strain_zero_sought && found_.course != TestCourse::slow)
    test_.refuse("strain", "zero = \"fit\"", "is sought of tests without times",
                 "give the zero, or leave it out");
}

void TestReader::read() {
  read_kind();
  const std::vector<fs::path> paths = test_.paths("path");
  found_.name = test_.text("name").value_or(paths.front().stem().string());
  read_sizes();
  strain_ = strain_column(test_, found_.kind, length_, found_.course == TestCourse::relaxation);
  stress_ = stress_column(test_, area_);
  found_.measure = stress_.measure;
  read_zeros();
  if (const auto table = test_.table("sigma"))
    sigma_ = described_column(*table, "sigma", stress_.si(), stress_.area ? "N" : "kPa");
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
  doubt_stretches();
  if (found_.kind == TestKind::uniaxial && test_.has("height") && found_.deformation.front() >= 1.0)
    result_.notes.push_back(found_.name +
                            ": is read as a tension, though the height is that of a cylinder "
                            "between plates (compression is negative: sign = -1)");
  const bool held = test_.word<bool>("use", {{"fit", false}, {"predict", true}}, false);
  found_.licence = result_.licence;
  read_published();
  (held ? result_.validation : result_.fitted).push_back(found_);
  // Fitted ones come first.
  result_.stuck.insert(held ? result_.stuck.end()
                            : result_.stuck.begin() + std::ptrdiff_t(result_.fitted.size()) - 1,
                       plates_);
}

/// One curve, or the mean of specimens, whose scatter goes along.
void TestReader::read_slow(const std::vector<fs::path>& paths) {
  std::vector<StrainCurve> curves;
  for (const fs::path& path : paths) curves.push_back(curve_of(path));
  if (curves.size() == 1) {
    convert(curves.front());
  } else {
    if (sigma_)
      test_.refuse("sigma", sigma_->column, "a mean of specimens has no sigma of its own",
                   "leave sigma out");
    const long points = test_.whole("points", usual_points, 2, max_points);
    const auto mean = mean_curve(curves, std::size_t(points));
    if (!mean)
      test_.refuse("path", fmt::format("{} files", curves.size()),
                   "the specimens have no strain in common", "compare their columns");
    found_.specimens = factors_of(curves, *mean);
    const auto [least, most] = std::ranges::minmax(found_.specimens);
    result_.notes.push_back(fmt::format(
        "{}: the mean of {} specimens, at {} equal steps of the strain that all reach; their "
        "stresses are {:.3g} to {:.3g} of it, a scatter of {}, which its intervals have",
        found_.name, curves.size(), points, least, most,
        calibration::percent(calibration::scatter_of(found_.specimens))));
    convert(*mean);
  }
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
