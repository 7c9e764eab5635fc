#include "studies/measurements/curve_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fingertip::studies::inline measurements {

namespace {

/// Share of the largest x that the rows must span to be told apart in bins.
constexpr double min_range = 1e-6;

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
  std::size_t rows = 0, line = 0;  ///< the line of its first row
  double x0 = 0.0, y0 = 0.0;       ///< of its first row: sums of differences keep all digits
  double weight = 0.0, x = 0.0, y = 0.0, time = 0.0;

  void add(const CurveRow& row, double row_weight) {
    if (rows++ == 0) x0 = row.x, y0 = row.y, line = row.line;
    weight += row_weight;
    x += row_weight * (row.x - x0);
    y += row_weight * (row.y - y0);
    time += row_weight * row.time;
  }
};

bool has_time(const std::vector<CurveRow>& rows) {
  return std::ranges::any_of(rows, [](const CurveRow& row) { return row.time != 0.0; });
}

/// Means of the rows of equal `bin`, weighed by their sigma, and the bins that have rows.
std::pair<calibration::Curve, std::vector<Bin>> means(const std::vector<CurveRow>& rows,
                                                      const std::vector<std::size_t>& bin,
                                                      bool with_time) {
  const bool known = rows.front().sigma > 0.0;
  const double least = std::ranges::min(rows, {}, &CurveRow::sigma).sigma;
  std::vector<Bin> bins(std::ranges::max(bin) + 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double ratio = known ? least / rows[i].sigma : 1.0;  // at most 1: no overflow
    bins[bin[i]].add(rows[i], ratio * ratio);
  }
  std::erase_if(bins, [](const Bin& each) { return each.rows == 0; });
  calibration::Curve curve;
  for (const Bin& each : bins) {
    curve.x.push_back(each.x0 + each.x / each.weight);
    curve.y.push_back(each.y0 + each.y / each.weight);
    if (known) curve.sigma.push_back(least / std::sqrt(each.weight));
    if (with_time) curve.time.push_back(each.time / each.weight);
  }
  return {curve, bins};
}

/// Whether the means of some thousand blocks of successive rows step back by at most `width`, and
/// single rows by twice that: of a million rows with noise some always lie far off.
bool climbs(const std::vector<CurveRow>& rows, double width, const Abscissa& abscissa,
            FileProblems& problems, std::size_t many = max_rows) {
  const std::size_t size = std::max<std::size_t>(1, rows.size() / (5 * many));
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
                      abscissa.shown(width), many, abscissa.shown(highest.x), highest.line),
          how_to_split(abscissa));
      return false;
    }
  }
  return true;
}

calibration::Curve averaged(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes,
                            std::size_t many) {
  const auto [least, largest] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double range = largest->x - least->x;
  if (!(range > min_range * std::abs(largest->x))) {
    problems.add(least->line, abscissa.name, abscissa.shown(least->x), "is the same in every row",
                 "write rows at different values");
    return {};
  }
  // An encoder may tremble by more than a bin: fewer are wider.
  constexpr std::size_t fewest_bins = 25;
  if (abscissa.is_travel)
    for (FileProblems none = problems;
         many / 2 >= fewest_bins && !climbs(rows, range / double(many), abscissa, none, many);)
      many /= 2;
  const double width = range / double(many);
  if (!climbs(rows, width, abscissa, problems, many)) return {};
  std::vector<std::size_t> bin;
  for (const CurveRow& row : rows)
    bin.push_back(std::min(std::size_t((row.x - least->x) / width), many - 1));
  const auto [curve, bins] = means(rows, bin, has_time(rows));
  const auto [fewest, most] = std::ranges::minmax_element(bins, {}, &Bin::rows);
  notes.push_back(
      fmt::format("{} rows are averaged in {} bins of equal {}, {} to {} rows each; {}",
                  rows.size(), bins.size(), abscissa.name, fewest->rows, most->rows,
                  rows.front().sigma > 0.0
                      ? "sigma of a mean supposes that the errors of its rows are independent"
                      : "without a column sigma every mean counts alike"));
  return curve;
}

}  // namespace

double noise_of(const std::vector<CurveRow>& rows) {
  constexpr std::size_t min_rows = 8;
  if (rows.size() < min_rows) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 3; i < rows.size(); ++i) {
    const double third = rows[i].y - rows[i - 3].y - 3.0 * (rows[i - 1].y - rows[i - 2].y);
    sum += third * third;
  }
  return std::sqrt(sum / (20.0 * double(rows.size() - 3)));
}

std::string Abscissa::shown(double si) const {
  return fmt::format("{:.6g}{}{}", si / factor, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
}

calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes,
                            std::size_t many) {
  const auto falls = [](const CurveRow& a, const CurveRow& b) { return b.x <= a.x; };
  const bool trembles = abscissa.is_travel && std::ranges::adjacent_find(rows, falls) != rows.end();
  if (rows.size() > many || trembles) return averaged(rows, abscissa, problems, notes, many);
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

namespace {

constexpr std::size_t max_hold_values = 40;

/// Times increase, as they must where forces depend on them.
bool goes_on(const std::vector<CurveRow>& rows, FileProblems& problems) {
  const auto back = std::ranges::adjacent_find(
      rows, [](const CurveRow& a, const CurveRow& b) { return b.time <= a.time; });
  if (back == rows.end()) return true;
  problems.add(
      (back + 1)->line, "time", fmt::format("{:.12g} s", (back + 1)->time),
      fmt::format("must increase from row to row; line {} has {:.12g} s", back->line, back->time),
      "correct it: of a rubber that relaxes forces depend on time");
  return false;
}

/// Numbers rows [first, end) of a hold so that those of one bin have the same.
void number_hold(const std::vector<CurveRow>& rows, std::size_t first, std::size_t end,
                 std::vector<std::size_t>& bin) {
  const std::size_t count = end - first, start = bin[first - 1] + 1;
  const double begin = rows[first - 1].time, step = rows[first].time - begin;
  const double decades = std::log1p((rows[end - 1].time - begin) / step);
  for (std::size_t i = first; i < end; ++i) {
    const double share = std::log1p((rows[i].time - begin) / step) / decades;
    bin[i] =
        start + (count <= max_hold_values
                     ? i - first
                     : std::min(max_hold_values - 1, std::size_t(share * double(max_hold_values))));
  }
}

}  // namespace

TimedCurve curve_in_time(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                         FileProblems& problems, std::vector<std::string>& notes) {
  TimedCurve result;
  std::vector<CurveRow> way;
  std::ranges::copy_if(rows, std::back_inserter(way),
                       [](const CurveRow& row) { return row.hold == 0; });
  const auto [least, largest] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double first = least->x, width = (largest->x - first) / double(max_rows);
  const auto falls = [](const CurveRow& a, const CurveRow& b) { return b.x <= a.x; };
  const bool dense = way.size() > max_rows || std::ranges::adjacent_find(way, falls) != way.end();
  if (!(width > 0.0)) {
    problems.add(least->line, abscissa.name, abscissa.shown(first), "is the same in every row",
                 "write rows at different values");
    return result;
  }
  if (!goes_on(rows, problems) || (dense && !climbs(way, width, abscissa, problems))) return result;
  // Rows of one bin follow each other, whatever an encoder trembles.
  std::vector<std::size_t> bin(rows.size(), 0);
  std::size_t place = 0;  // of the way, in widths
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].hold > 0) {
      std::size_t end = i;
      while (end < rows.size() && rows[end].hold == rows[i].hold) ++end;
      number_hold(rows, i, end, bin);
      i = end - 1;
      continue;
    }
    const std::size_t here = std::max(place, std::size_t((rows[i].x - first) / width));
    const bool next = !dense || here > place || rows[i - 1].hold > 0;
    bin[i] = bin[i - 1] + (next ? 1 : 0);
    place = here;
  }
  const auto [curve, bins] = means(rows, bin, true);
  result.curve = curve;
  result.curve.in_time = true;
  for (const Bin& each : bins) result.lines.push_back(each.line);
  if (bins.size() < rows.size())
    notes.push_back(fmt::format(
        "{} rows are averaged in {} bins, of equal {} on the way, of growing time in holds{}",
        rows.size(), bins.size(), abscissa.name,
        rows.front().sigma > 0.0 ? "" : "; without a column sigma every mean counts alike"));
  return result;
}

}  // namespace fingertip::studies::inline measurements
