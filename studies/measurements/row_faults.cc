/// Rows that cannot be what they say: in reverse order, odd, beyond a load cell's limit.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "studies/measurements/curve_rows.h"

namespace fingertip::studies::inline measurements {

namespace {

/// Fewer rows are no course that one of them could stand apart from.
constexpr std::size_t min_rows = 6;

double quantile(std::vector<double> values, double share) {
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

/// Rows whose number stands apart from both neighbours, which agree, by more than four usual steps
/// and 3 % of all numbers' range. A turning point or a corner does not. At the ends, of numbers
/// that climb, what lies back on the way; of others what stands twice as far off and the next two
/// do not.
enum class Ends { climb, stand, any };
std::vector<std::size_t> apart(const std::vector<double>& v, Ends ends) {
  constexpr double steps = 4.0, least_share = 0.03, agreement = 0.5;
  const std::size_t n = v.size();
  std::vector<double> step;
  for (std::size_t i = 1; i < n; ++i) step.push_back(std::abs(v[i] - v[i - 1]));
  const double usual = quantile(step, 0.75), range = quantile(v, 0.95) - quantile(v, 0.05),
               far = std::max(steps * usual, least_share * range);
  std::vector<std::size_t> found;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double before = v[i] - v[i - 1], after = v[i] - v[i + 1];
    const double size = std::min(std::abs(before), std::abs(after));
    if (before * after > 0.0 && size > far && std::abs(v[i + 1] - v[i - 1]) < agreement * size)
      found.push_back(i);
  }
  if (ends == Ends::any) return found;
  const auto alone = [&](std::size_t end, std::size_t next, std::size_t after) {
    const double size = std::abs(v[end] - v[next]);
    return size > 2.0 * far && std::abs(v[next] - v[after]) < 0.5 * agreement * size;
  };
  const double way = v[n - 2] >= v[1] ? 1.0 : -1.0;
  const auto back = [&](double by) { return ends == Ends::climb && way * by > far; };
  if (back(v[0] - v[1]) || alone(0, 1, 2)) found.insert(found.begin(), 0);
  if (back(v[n - 2] - v[n - 1]) || alone(n - 1, n - 2, n - 3)) found.push_back(n - 1);
  return found;
}

std::vector<double> numbers(const std::vector<CurveRow>& rows, double CurveRow::*number) {
  std::vector<double> values;
  for (const CurveRow& row : rows) values.push_back(row.*number);
  return values;
}

}  // namespace

void put_in_order(std::vector<CurveRow>& rows, const Abscissa& abscissa,
                  std::vector<std::string>& notes) {
  if (rows.size() < 3) return;
  // Means of blocks: rows may tremble.
  const std::size_t size = std::max<std::size_t>(1, rows.size() / max_rows);
  std::vector<CurveRow> means;
  for (std::size_t first = 0; first + size <= rows.size(); first += size) {
    CurveRow mean;
    for (std::size_t i = first; i < first + size; ++i)
      mean.x += rows[i].x / double(size), mean.y += rows[i].y / double(size);
    means.push_back(mean);
  }
  double way = 0.0, back = 0.0, early = 0.0, late = 0.0;
  for (std::size_t i = 1; i < means.size(); ++i) {
    way += std::abs(means[i].x - means[i - 1].x);
    back += std::max(0.0, means[i - 1].x - means[i].x);
  }
  for (std::size_t i = 0; i < means.size() / 2; ++i)
    early += std::abs(means[i].y), late += std::abs(means[means.size() - 1 - i].y);
  constexpr double nearly_all = 0.9;
  if (!(back > nearly_all * way) || !(early > late)) return;
  std::ranges::reverse(rows);
  notes.push_back(
      fmt::format("the rows begin with the largest {}: they are taken the other way round, as a "
                  "loading",
                  abscissa.name));
}

void leave_out_odd(std::vector<CurveRow>& rows, const Abscissa& abscissa, bool climb,
                   std::vector<std::string>& notes) {
  if (rows.size() < min_rows) return;
  std::vector<std::size_t> odd =
      apart(numbers(rows, &CurveRow::x), climb ? Ends::climb : Ends::any);
  std::ranges::copy(apart(numbers(rows, &CurveRow::y), climb ? Ends::stand : Ends::any),
                    std::back_inserter(odd));
  std::ranges::sort(odd);
  const auto same = std::ranges::unique(odd);
  odd.erase(same.begin(), same.end());
  if (odd.empty()) return;
  constexpr std::size_t one_in = 25, enough = 4;
  std::string where;
  for (std::size_t i = 0; i < std::min(enough, odd.size()); ++i)
    where += fmt::format("{}line {} ({})", i == 0 ? "" : ", ", rows[odd[i]].line,
                         abscissa.shown(rows[odd[i]].x));
  if (odd.size() > enough) where += ", ...";
  if (odd.size() > std::max<std::size_t>(2, rows.size() / one_in)) {
    notes.push_back(
        fmt::format("{} rows stand far from their neighbours, too many to be left out: "
                    "{}",
                    odd.size(), where));
    return;
  }
  notes.push_back(fmt::format("{} far from all others {} left out: {}",
                              odd.size() == 1 ? "a row" : fmt::format("{} rows", odd.size()),
                              odd.size() == 1 ? "is" : "are", where));
  for (auto row = odd.rbegin(); row != odd.rend(); ++row)
    rows.erase(rows.begin() + std::ptrdiff_t(*row));
}

void leave_out_clipped(std::vector<CurveRow>& rows, const Abscissa& abscissa,
                       std::vector<std::string>& notes) {
  constexpr std::size_t least = 4;
  constexpr double nearly_all = 0.7, steps = 4.0;
  if (rows.size() < min_rows + least) return;
  const double limit = std::ranges::max(rows, {}, &CurveRow::y).y;
  // From where on nearly all rows stand at the largest value.
  std::size_t first = rows.size(), equal = 0;
  for (std::size_t i = rows.size(); i-- > 0;) {
    if (rows[i].y != limit) continue;
    ++equal;
    if (double(equal) >= nearly_all * double(rows.size() - i)) first = i;
  }
  if (first >= rows.size() || first < min_rows) return;
  const std::size_t clipped = rows.size() - first;
  if (clipped < least) return;
  // What the forces before would have gained on that way, over the steps in which they are told.
  double step = INFINITY;
  for (std::size_t i = 1; i < first; ++i)
    if (const double size = std::abs(rows[i].y - rows[i - 1].y); size > 0.0)
      step = std::min(step, size);
  const std::size_t from = first / 2;
  const double slope = (rows[first - 1].y - rows[from].y) / (rows[first - 1].x - rows[from].x),
               way = rows.back().x - rows[first].x;
  if (!(slope * way > steps * step) || !(slope * way > 0.01 * std::abs(limit))) return;
  notes.push_back(fmt::format(
      "from line {} on, at {}, {} rows do not change while the {} does: a load cell at its limit; "
      "they are left out",
      rows[first].line, abscissa.shown(rows[first].x), clipped, abscissa.name));
  rows.resize(first);
}

std::optional<RestRows> rows_at_rest(const std::vector<CurveRow>& rows) {
  constexpr double still = 0.002, most = 0.9;  // of the way
  constexpr std::size_t least = 3;
  constexpr double times = 5.0;  // as many rows as such a step of the way has
  if (rows.size() < min_rows) return {};
  const auto [low, high] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double width = still * (high->x - low->x);
  std::size_t count = 1;
  while (count < rows.size() && std::abs(rows[count].x - rows.front().x) <= width) ++count;
  const auto far = std::ranges::find_if(rows, [&](const CurveRow& row) {
    return std::abs(row.x - rows.front().x) > most * (high->x - low->x);
  });
  const double usual = (double(far - rows.begin()) - double(count)) * still / most;
  if (count < least || double(count) < times * usual || count == rows.size()) return {};
  RestRows rest{count};
  for (std::size_t i = 0; i < count; ++i)
    rest.x += rows[i].x / double(count), rest.y += rows[i].y / double(count);
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) squares += std::pow(rows[i].y - rest.y, 2);
  rest.y_error = std::sqrt(squares / double(count * (count - 1)));
  return rest;
}

namespace {

/// Least squares of y = value + slope x.
struct StraightLine {
  double value = 0.0, slope = 0.0, left = 0.0;  ///< left: sum of squares
  double value_error = INFINITY;                ///< standard error, one number more being known
};
StraightLine line_through(const Eigen::ArrayXd& x, const Eigen::ArrayXd& y) {
  const double n = double(x.size()), mean = x.mean(), spread = (x - mean).square().sum();
  StraightLine line;
  line.slope = spread > 0.0 ? ((x - mean) * (y - y.mean())).sum() / spread : 0.0;
  line.value = y.mean() - line.slope * mean;
  line.left = (y - line.value - line.slope * x).square().sum();
  if (spread > 0.0)
    line.value_error =
        std::sqrt(line.left / std::max(1.0, n - 3.0) * (1.0 / n + mean * mean / spread));
  return line;
}

}  // namespace

bool zero_shows(const std::vector<CurveRow>& rows) {
  constexpr std::size_t least = 5, places = 60;
  constexpr double low_share = 0.3, surely = 4.0, matters = 0.002, stands = 0.5;
  if (rows.size() < 2 * least) return false;
  const auto [lowest, highest] = std::ranges::minmax_element(rows, {}, &CurveRow::y);
  const double rise = highest->y - lowest->y, most = lowest->y + low_share * rise;
  const auto end = std::find_if(rows.begin() + least, rows.end(),
                                [&](const CurveRow& row) { return row.y > most; });
  const std::vector<CurveRow> low(rows.begin(), end == rows.end() ? end : end + 1);
  Eigen::ArrayXd x(Eigen::Index(low.size())), y = x;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x(i) = low[std::size_t(i)].x, y(i) = low[std::size_t(i)].y;
  const double begin = x(0), way = x(x.size() - 1) - begin;
  StraightLine best{.left = INFINITY};
  double touched = begin;
  for (std::size_t place = 1; place < places; ++place) {
    const double touch = begin + way * double(place) / double(places);
    if ((x <= touch).count() < Eigen::Index(least)) continue;
    for (const double power : {1.0, 1.5, 2.0}) {
      const StraightLine line = line_through(((x - touch).max(0.0) / way).pow(power), y);
      if (line.left < best.left) best = line, touched = touch;
    }
  }
  const double zero = std::abs(best.value);
  if (!(zero > surely * best.value_error) || !(zero > matters * rise)) return false;
  // Before touch forces stand; of a press that begins in contact they rise from the first row on.
  const Eigen::Index before = (x <= touched).count();
  const double change = line_through(x.head(before), y.head(before)).slope * (touched - begin);
  return std::abs(change) < stands * zero;
}

}  // namespace fingertip::studies::inline measurements
