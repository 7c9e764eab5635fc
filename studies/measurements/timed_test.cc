#include "studies/measurements/timed_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "meshes/base/errors.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline measurements {

using calibration::MaterialTest;
using calibration::StrainPath;
using calibration::TestCourse;
using meshes::InvalidInput;

namespace {

constexpr std::size_t most_corners = 10000;

/// Seconds over the unit of the column.
double seconds_of(const TestTable& time) {
  return time.number_of("unit", "1 " + time.text("unit").value_or("s"), "s", "1 s");
}

void check_times(const std::filesystem::path& file, const TimedRows& rows) {
  for (std::size_t i = 1; i < rows.time.size(); ++i)
    if (!(rows.time[i] > rows.time[i - 1]))
      throw InvalidInput({fmt::format("{}:{}", file.string(), rows.lines[i]),
                          fmt::format("{:.6g} after {:.6g}", rows.time[i], rows.time[i - 1]),
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
std::vector<std::size_t> by_decades(const std::vector<double>& time, double start,
                                    std::size_t most) {
  const auto first = std::ranges::upper_bound(time, start) - time.begin();
  std::vector<std::size_t> chosen;
  if (std::size_t(first) >= time.size()) return {time.size() - 1};
  const double from = time[std::size_t(first)] - start, to = time.back() - start;
  for (std::size_t i = 0; i < most; ++i) {
    const double at = start + from * std::pow(to / from, double(i) / double(most - 1));
    const auto next = std::ranges::lower_bound(time, at) - time.begin();
    std::size_t row = std::min(std::size_t(next), time.size() - 1);
    if (row > std::size_t(first) && at - time[row - 1] < time[row] - at) --row;
    if (chosen.empty() || row > chosen.back()) chosen.push_back(row);
  }
  return chosen;
}

/// Brought to the value at the test's rate and held until the last row.
StrainPath held_path(const TestTable& description, const StrainColumn& strain, TimedRows& rows,
                     const MaterialTest& test) {
  const double rest = rest_of(test.kind), held = strain.deformation(test.kind, *strain.value),
               ramp = test.rate ? std::abs(held - rest) / *test.rate : 0.0;
  const auto time = *description.table("time");
  if (time.word<bool>("from", {{"ramp", false}, {"hold", true}}, false))
    for (double& value : rows.time) value += ramp;
  if (rows.time.front() < 0.0)
    time.refuse("column", fmt::format("{:.6g} s", rows.time.front()),
                "times count from the start of the ramp, or of the hold, and are not negative",
                "choose rows, or write from = \"hold\"");
  return {{0.0, ramp, std::max(ramp, rows.time.back())}, {rest, held, held}};
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

/// Rows of a plateau without force, behind a pull, of a specimen that is never pressed.
std::vector<bool> slack_rows(const TimedRows& rows, const MaterialTest& test) {
  constexpr double nothing = 0.01;    // of the largest stress
  constexpr std::size_t plateau = 3;  // rows
  const std::size_t n = rows.time.size();
  std::vector<bool> slack(n, false);
  if (test.course != TestCourse::cycles || test.kind == calibration::TestKind::simple_shear ||
      *std::ranges::min_element(test.path.deformation) < 1.0)
    return slack;
  const auto size = [](double stress) { return std::abs(stress); };
  const double largest = size(*std::ranges::max_element(rows.stress, {}, size));
  const auto bears = [&](double stress) { return size(stress) > nothing * largest; };
  for (auto from = std::ranges::find_if(rows.stress, bears); from != rows.stress.end();) {
    from = std::find_if_not(from, rows.stress.end(), bears);
    const auto to = std::find_if(from, rows.stress.end(), bears);
    if (std::size_t(to - from) >= plateau)
      std::fill(slack.begin() + (from - rows.stress.begin()),
                slack.begin() + (to - rows.stress.begin()), true);
    from = to;
  }
  return slack;
}

}  // namespace

void TimedRows::keep(std::size_t first, std::size_t end) {
  const auto cut = [&](auto& column) {
    if (column.empty()) return;
    column.resize(end);
    column.erase(column.begin(), column.begin() + std::ptrdiff_t(first));
  };
  for (std::vector<double>* column : {&time, &strain, &stress, &sigma}) cut(*column);
  cut(lines);
}

std::size_t TimedRows::drop(const std::function<bool(std::size_t)>& unwanted) {
  const std::size_t all = time.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all; ++i) {
    if (unwanted(i)) continue;
    for (std::vector<double>* column : {&time, &strain, &stress, &sigma})
      if (!column->empty()) (*column)[kept] = (*column)[i];
    lines[kept++] = lines[i];
  }
  keep(0, kept);
  return all - kept;
}

/// Of a file that begins with its second row: where the speed of its first step leads back to rest
/// within little more than a step, the pull began there. Else what its first row shows is sudden.
void add_start(const StrainColumn& strain, const TimedRows& rows, MaterialTest& test) {
  constexpr double most_steps = 1.5;
  const double rest = calibration::rest_of(test.kind),
               first = strain.deformation(test.kind, rows.strain[0]),
               way = strain.deformation(test.kind, rows.strain[1]) - first,
               steps = (first - rest) / way;
  if (!(steps > 0.0) || steps > most_steps) return;
  test.path.time.push_back(rows.time[0] - steps * (rows.time[1] - rows.time[0]));
  test.path.deformation.push_back(rest);
}

void put_in_time(const TestTable& description, const std::filesystem::path& file,
                 const StrainColumn& strain, const StressColumn& stress, TimedRows rows,
                 std::size_t points, MaterialTest& test, std::vector<std::string>& notes) {
  const std::string name = file.filename().string();
  const auto has_gap = [&](std::size_t i) {
    return std::ranges::any_of(
        std::array{&rows.time, &rows.strain, &rows.stress, &rows.sigma},
        [&](const auto* column) { return !column->empty() && std::isnan((*column)[i]); });
  };
  if (const std::size_t empty = rows.drop(has_gap); empty > 0)
    notes.push_back(fmt::format("{}: {} rows with empty cells were left out", name, empty));
  if (rows.time.size() < 2)
    description.refuse("path", name, "fewer than two rows are left",
                       "look at rows and the columns");
  check_times(file, rows);
  const double unit = seconds_of(*description.table("time"));
  for (double& value : rows.time) value *= unit;
  if (strain.value) {
    test.path = held_path(description, strain, rows, test);
  } else {
    const auto corners = every_so_many(rows.time.size(), most_corners);
    if (corners.size() < rows.time.size())
      notes.push_back(fmt::format("{}: the strain follows {} of {} rows", name, corners.size(),
                                  rows.time.size()));
    add_start(strain, rows, test);
    // The first row is where the course begins.
    if (corners.front() > 0) {
      test.path.time.push_back(rows.time.front());
      test.path.deformation.push_back(strain.deformation(test.kind, rows.strain.front()));
    }
    for (const std::size_t i : corners) {
      test.path.time.push_back(rows.time[i]);
      test.path.deformation.push_back(strain.deformation(test.kind, rows.strain[i]));
    }
  }
  if (test.course == TestCourse::relaxation) check_hold(description, test);
  const std::vector<bool> slack = slack_rows(rows, test);
  if (const auto left_out = rows.drop([&](std::size_t i) { return slack[i]; }); left_out > 0)
    notes.push_back(
        fmt::format("{}: {} rows without force between a pull and the next were left "
                    "out: the specimen is slack there",
                    name, left_out));
  std::vector<std::size_t> chosen = every_so_many(rows.time.size(), rows.time.size());
  if (chosen.size() > points) {
    chosen = test.course == TestCourse::relaxation
                 ? by_decades(rows.time, test.path.time.front(), points)
                 : every_so_many(rows.time.size(), points);
    notes.push_back(fmt::format("{}: stresses of {} of {} rows are fitted", name, chosen.size(),
                                rows.time.size()));
  }
  for (const std::size_t i : chosen) {
    test.time.push_back(rows.time[i]);
    test.deformation.push_back(strain.value ? test.path.at(rows.time[i])
                                            : strain.deformation(test.kind, rows.strain[i]));
    test.stress.push_back(stress.factor * rows.stress[i]);
    if (!rows.sigma.empty()) test.sigma.push_back(std::abs(stress.factor) * rows.sigma[i]);
  }
}

}  // namespace fingertip::studies::inline measurements
