#include "studies/run/curve_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fingertip::studies {

namespace {

/// Share of the largest x that the rows must span to be told apart in bins.
constexpr double least_range = 1e-6;

std::string how_to_split(const Abscissa& abscissa) {
  return abscissa.name == "indentation" || abscissa.is_travel
             ? "keep one loading: split loading and unloading into files of their own"
             : "sort the rows by " + abscissa.name;
}

/// Strictly increasing, or the first step back and every equal pair before it.
bool increase(const std::vector<CurveRow>& rows, const Abscissa& abscissa, FileProblems& problems) {
  bool fine = true;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const CurveRow &row = rows[i], &before = rows[i - 1];
    if (row.x > before.x) continue;
    fine = false;
    const std::string where = fmt::format("{} in line {}", abscissa.shown(before.x), before.line);
    if (row.x < before.x) {
      problems.add(row.line, abscissa.name, abscissa.shown(row.x),
                   "must increase from row to row, and falls here from " + where,
                   how_to_split(abscissa));
      break;
    }
    const bool same = row.y == before.y && row.sigma == before.sigma;
    problems.add(
        row.line, abscissa.name, abscissa.shown(row.x),
        same ? "the row repeats " + where : "has a second value, another one than at " + where,
        same ? "delete one of the two rows"
             : "average repeated measurements (sigma over the root of their number), or "
               "give each a file of its own");
  }
  return fine;
}

struct Bin {
  std::size_t rows = 0;
  double x0 = 0.0, y0 = 0.0;  ///< of its first row: sums of differences keep all digits
  double weight = 0.0, x = 0.0, y = 0.0, time = 0.0;

  void add(const CurveRow& row, double row_weight) {
    if (rows++ == 0) x0 = row.x, y0 = row.y;
    weight += row_weight;
    x += row_weight * (row.x - x0);
    y += row_weight * (row.y - y0);
    time += row_weight * row.time;
  }
};

bool has_time(const std::vector<CurveRow>& rows) {
  return std::ranges::any_of(rows, [](const CurveRow& row) { return row.time != 0.0; });
}

calibration::Curve means(const std::vector<CurveRow>& rows, double first, double width,
                         std::vector<std::string>& notes, const std::string& name) {
  const bool known = rows.front().sigma > 0.0;
  const double least = std::ranges::min(rows, {}, &CurveRow::sigma).sigma;
  std::vector<Bin> bins(most_rows);
  for (const CurveRow& row : rows) {
    const auto bin = std::size_t((row.x - first) / width);
    const double ratio = known ? least / row.sigma : 1.0;  // at most 1: no overflow
    bins[std::min(bin, most_rows - 1)].add(row, ratio * ratio);
  }
  std::erase_if(bins, [](const Bin& bin) { return bin.rows == 0; });
  calibration::Curve curve;
  for (const Bin& bin : bins) {
    curve.x.push_back(bin.x0 + bin.x / bin.weight);
    curve.y.push_back(bin.y0 + bin.y / bin.weight);
    if (known) curve.sigma.push_back(least / std::sqrt(bin.weight));
    if (has_time(rows)) curve.time.push_back(bin.time / bin.weight);
  }
  const auto [fewest, most] = std::ranges::minmax_element(bins, {}, &Bin::rows);
  notes.push_back(
      fmt::format("{} rows are averaged in {} bins of equal {}, {} to {} rows each; {}",
                  rows.size(), bins.size(), name, fewest->rows, most->rows,
                  known ? "sigma of a mean supposes that the errors of its rows are independent"
                        : "without a column sigma every mean counts alike"));
  return curve;
}

/// Whether the means of some thousand blocks of successive rows step back by at most `width`, and
/// single rows by twice that: of a million rows with noise some always lie far off.
bool climbs(const std::vector<CurveRow>& rows, double width, const Abscissa& abscissa,
            FileProblems& problems) {
  const std::size_t size = std::max<std::size_t>(1, rows.size() / (5 * most_rows));
  CurveRow highest;  // x: the largest mean; line: where its block begins
  highest.x = -std::numeric_limits<double>::infinity();
  for (std::size_t first = 0; first < rows.size(); first += size) {
    const std::size_t end = std::min(first + size, rows.size());
    double mean = 0.0;
    for (std::size_t i = first; i < end; ++i) mean += rows[i].x / double(end - first);
    if (mean > highest.x) highest = {mean, 0.0, 0.0, rows[first].line};
    for (std::size_t i = first; i < end; ++i) {
      const bool back = mean < highest.x - width || rows[i].x < highest.x - 2.0 * width;
      if (!back) continue;
      problems.add(
          rows[i].line, abscissa.name, abscissa.shown(rows[i].x),
          fmt::format("must increase, up to noise of {} (1/{} of its range), and has "
                      "already been {} at line {}",
                      abscissa.shown(width), most_rows, abscissa.shown(highest.x), highest.line),
          how_to_split(abscissa));
      return false;
    }
  }
  return true;
}

calibration::Curve averaged(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes) {
  const auto [least, largest] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double range = largest->x - least->x;
  const double width = range / double(most_rows);
  if (!(range > least_range * std::abs(largest->x))) {
    problems.add(least->line, abscissa.name, abscissa.shown(least->x), "is the same in every row",
                 "write rows at different values");
    return {};
  }
  if (!climbs(rows, width, abscissa, problems)) return {};
  return means(rows, least->x, width, notes, abscissa.name);
}

}  // namespace

namespace {

/// Integral of the force over the travel, from the first row on, by trapezes.
double work(const std::vector<CurveRow>& rows) {
  double sum = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    sum += 0.5 * (rows[i].y + rows[i - 1].y - 2.0 * rows.front().y) * (rows[i].x - rows[i - 1].x);
  return sum;
}

}  // namespace

std::vector<CurveRow> loading(std::vector<CurveRow> rows, std::vector<std::string>& notes) {
  if (rows.empty()) return rows;
  // The first row that deep: the noise of a hold must not choose the turn.
  const auto [least, largest] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double close = largest->x - (largest->x - least->x) / double(most_rows);
  const auto turn = std::ranges::find_if(rows, [&](const CurveRow& row) { return row.x >= close; });
  auto last = turn;
  while (last + 1 != rows.end() && (last + 1)->x > last->x) ++last;
  const std::size_t count = std::size_t(last - rows.begin()) + 1;
  // Where the machine goes back.
  const auto back = std::find_if(rows.begin() + std::ptrdiff_t(count), rows.end(),
                                 [&](const CurveRow& row) { return row.x < close; });
  if (count < rows.size()) {
    const double around = work(rows);
    const std::size_t returned = std::size_t(rows.end() - back);
    rows.resize(count);
    const double done = work(rows);
    notes.push_back(
        returned > 0 && done > 0.0
            ? fmt::format("the loading, {} rows, is fitted and the unloading, {} rows, is not; the "
                          "loop takes {:.2g} % of the work of the loading",
                          count, returned, 100.0 * around / done)
            : "rows after the largest position, a hold, are left out");
  }
  return rows;
}

std::string Abscissa::shown(double si) const {
  return fmt::format("{:.6g} {}", si / factor, unit);
}

calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes) {
  const auto falls = [](const CurveRow& a, const CurveRow& b) { return b.x <= a.x; };
  const bool trembles = abscissa.is_travel && std::ranges::adjacent_find(rows, falls) != rows.end();
  if (rows.size() > most_rows || trembles) return averaged(rows, abscissa, problems, notes);
  calibration::Curve curve;
  if (!increase(rows, abscissa, problems)) return curve;
  for (const CurveRow& row : rows) {
    curve.x.push_back(row.x);
    curve.y.push_back(row.y);
    if (row.sigma > 0.0) curve.sigma.push_back(row.sigma);
    if (has_time(rows)) curve.time.push_back(row.time);
  }
  return curve;
}

}  // namespace fingertip::studies
