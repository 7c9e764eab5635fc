#include "studies/measurements/timed_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline measurements {

using calibration::CurveRow;
using calibration::MaterialTest;
using calibration::StrainPath;
using calibration::TestCourse;
using meshes::InvalidInput;
using Rows = std::vector<CurveRow>;

namespace {

constexpr std::size_t max_corners = 10000;

void check_times(const std::filesystem::path& file, const Rows& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i].time > rows[i - 1].time))
      throw InvalidInput({fmt::format("{}:{}", file.string(), rows[i].line),
                          fmt::format("{:.6g} s after {:.6g} s", rows[i].time, rows[i - 1].time),
                          "times must increase from row to row",
                          "choose the rows of one test by rows = [first, last], or sort them"});
}

/// Rows evenly, the last among them.
std::vector<std::size_t> every_so_many(std::size_t rows, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t step = (rows + most - 1) / most;
  for (std::size_t i = (rows - 1) % step; i < rows; i += step) chosen.push_back(i);
  return chosen;
}

/// The rows nearest to equal steps of the logarithm of the time since `start`.
std::vector<std::size_t> by_decades(const Rows& rows, double start, std::size_t most) {
  const auto first = std::ranges::upper_bound(rows, start, {}, &CurveRow::time) - rows.begin();
  std::vector<std::size_t> chosen;
  if (std::size_t(first) >= rows.size()) return {rows.size() - 1};
  const double from = rows[std::size_t(first)].time - start, to = rows.back().time - start;
  for (std::size_t i = 0; i < most; ++i) {
    const double at = start + from * std::pow(to / from, double(i) / double(most - 1));
    const auto next = std::ranges::lower_bound(rows, at, {}, &CurveRow::time) - rows.begin();
    std::size_t row = std::min(std::size_t(next), rows.size() - 1);
    if (row > std::size_t(first) && at - rows[row - 1].time < rows[row].time - at) --row;
    if (chosen.empty() || row > chosen.back()) chosen.push_back(row);
  }
  return chosen;
}

/// Brought to the value at the test's rate and held until the last row.
StrainPath held_path(const TestTable& description, const StrainColumn& strain, Rows& rows,
                     const MaterialTest& test) {
  const double rest = rest_of(test.kind), held = strain.deformation(test.kind, *strain.value),
               ramp = test.rate ? std::abs(held - rest) / *test.rate : 0.0;
  const auto time = *description.table("time");
  if (time.word<bool>("from", {{"ramp", false}, {"hold", true}}, false))
    for (CurveRow& row : rows) row.time += ramp;
  if (rows.front().time < 0.0)
    time.refuse("column", fmt::format("{:.6g} s", rows.front().time),
                "times count from the start of the ramp, or of the hold, and are not negative",
                "choose rows, or write from = \"hold\"");
  return {{0.0, ramp, std::max(ramp, rows.back().time)}, {rest, held, held}};
}

void check_hold(const TestTable& description, const MaterialTest& test) {
  const double start = test.path.time.front(), held = test.path.held_from(rest_of(test.kind)),
               ramp = held - start, hold = test.path.time.back() - held;
  if (hold > 0.0 && hold >= ramp) return;
  description.refuse("kind", "relaxation",
                     fmt::format("the strain is held for {:.3g} s after a ramp of {:.3g} s, and a "
                                 "hold lasts at least as long as its ramp",
                                 hold, ramp),
                     "give a longer hold, the rate of a faster ramp, or kind = \"cycles\"");
}

/// Leaves out rows of a plateau without force, behind a pull, of a specimen that is never pressed;
/// how many there were.
std::size_t leave_out_slack(Rows& rows, const MaterialTest& test) {
  constexpr double nothing = 0.01;       // of the largest stress
  constexpr std::ptrdiff_t plateau = 3;  // rows
  if (test.course != TestCourse::cycles || test.kind == calibration::TestKind::simple_shear ||
      *std::ranges::min_element(test.path.deformation) < 1.0)
    return 0;
  const auto size = [](const CurveRow& row) { return std::abs(row.y); };
  const double largest = size(*std::ranges::max_element(rows, {}, size));
  const auto bears = [&](const CurveRow& row) { return size(row) > nothing * largest; };
  const std::size_t all = rows.size();
  for (auto from = std::ranges::find_if(rows, bears); from != rows.end();) {
    from = std::find_if_not(from, rows.end(), bears);
    const auto to = std::find_if(from, rows.end(), bears);
    from = to - from >= plateau ? rows.erase(from, to) : to;
  }
  return all - rows.size();
}

/// Of a file that begins with its second row: where the speed of its first step leads back to rest
/// within little more than a step, the pull began there. Else what its first row shows is sudden.
void add_start(const StrainColumn& strain, const Rows& rows, MaterialTest& test) {
  constexpr double max_steps = 1.5;
  const double rest = calibration::rest_of(test.kind),
               first = strain.deformation(test.kind, rows[0].x),
               way = strain.deformation(test.kind, rows[1].x) - first, steps = (first - rest) / way;
  if (!(steps > 0.0) || steps > max_steps) return;
  test.path.time.push_back(rows[0].time - steps * (rows[1].time - rows[0].time));
  test.path.deformation.push_back(rest);
}

}  // namespace

void put_in_time(const TestTable& description, const std::filesystem::path& file,
                 const StrainColumn& strain, bool has_sigma, Rows rows, std::size_t points,
                 MaterialTest& test, std::vector<std::string>& notes) {
  const std::string name = file.filename().string();
  check_times(file, rows);
  if (strain.value) {
    test.path = held_path(description, strain, rows, test);
  } else {
    const auto corners = every_so_many(rows.size(), max_corners);
    if (corners.size() < rows.size())
      notes.push_back(
          fmt::format("{}: the strain follows {} of {} rows", name, corners.size(), rows.size()));
    add_start(strain, rows, test);
    const auto add_corner = [&](const CurveRow& row) {
      test.path.time.push_back(row.time);
      test.path.deformation.push_back(strain.deformation(test.kind, row.x));
    };
    // The first row is where the course begins.
    if (corners.front() > 0) add_corner(rows.front());
    for (const std::size_t i : corners) add_corner(rows[i]);
  }
  if (test.course == TestCourse::relaxation) check_hold(description, test);
  if (const std::size_t left_out = leave_out_slack(rows, test); left_out > 0)
    notes.push_back(
        fmt::format("{}: {} rows without force between a pull and the next were left "
                    "out: the specimen is slack there",
                    name, left_out));
  std::vector<std::size_t> chosen = every_so_many(rows.size(), rows.size());
  if (chosen.size() > points) {
    chosen = test.course == TestCourse::relaxation
                 ? by_decades(rows, test.path.time.front(), points)
                 : every_so_many(rows.size(), points);
    notes.push_back(
        fmt::format("{}: stresses of {} of {} rows are fitted", name, chosen.size(), rows.size()));
  }
  for (const std::size_t i : chosen) {
    const CurveRow& row = rows[i];
    test.time.push_back(row.time);
    test.deformation.push_back(strain.value ? test.path.at(row.time)
                                            : strain.deformation(test.kind, row.x));
    test.stress.push_back(row.y);
    if (has_sigma) test.sigma.push_back(row.sigma);
  }
}

}  // namespace fingertip::studies::inline measurements
