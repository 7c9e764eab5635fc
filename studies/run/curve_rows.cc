#include "studies/run/curve_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

namespace {

/// Share of the largest x that the rows must span to be told apart in bins.
constexpr double least_range = 1e-6;

std::string how_to_split(const Abscissa& abscissa) {
  return abscissa.name == "indentation"
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
  double weight = 0.0, x = 0.0, y = 0.0;

  void add(const CurveRow& row, double row_weight) {
    if (rows++ == 0) x0 = row.x, y0 = row.y;
    weight += row_weight;
    x += row_weight * (row.x - x0);
    y += row_weight * (row.y - y0);
  }
};

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
  if (!(range > least_range * largest->x)) {
    problems.add(least->line, abscissa.name, abscissa.shown(least->x), "is the same in every row",
                 "write rows at different values");
    return {};
  }
  if (!climbs(rows, width, abscissa, problems)) return {};
  return means(rows, least->x, width, notes, abscissa.name);
}

}  // namespace

std::string Abscissa::shown(double si) const {
  return fmt::format("{:.6g} {}", si / factor, unit);
}

calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes) {
  if (rows.size() > most_rows) return averaged(rows, abscissa, problems, notes);
  calibration::Curve curve;
  if (!increase(rows, abscissa, problems)) return curve;
  for (const CurveRow& row : rows) {
    curve.x.push_back(row.x);
    curve.y.push_back(row.y);
    if (row.sigma > 0.0) curve.sigma.push_back(row.sigma);
  }
  return curve;
}

}  // namespace fingertip::studies
