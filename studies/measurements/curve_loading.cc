/// The loading among the rows of a measured travel, with holds and the way back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "studies/measurements/curve_rows.h"

namespace fingertip::studies::inline measurements {

namespace {

/// Integral of the force over the travel, from the first row on, by trapezes.
double work(const std::vector<CurveRow>& rows) {
  double sum = 0.0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    sum += 0.5 * (rows[i].y + rows[i - 1].y - 2.0 * rows.front().y) * (rows[i].x - rows[i - 1].x);
  return sum;
}

double largest_force(const std::vector<CurveRow>& rows) {
  return std::ranges::max(rows, {}, &CurveRow::y).y;
}

/// Rows from `first` up to, without, `end`, in which the machine stands still.
struct Hold {
  std::size_t first = 0, end = 0;
};

/// Times as many rows as usual, and rows, that make a hold.
constexpr std::size_t hold_share = 5, hold_rows = 10;

/// The first row of a hold at which the machine stands where it does in the middle of it: the
/// loading's last one, or where it comes to rest.
std::size_t arrival(const std::vector<CurveRow>& rows, const Hold& hold) {
  std::vector<double> xs;
  for (std::size_t i = hold.first; i < hold.end; ++i) xs.push_back(rows[i].x);
  const auto half = xs.begin() + std::ptrdiff_t(xs.size() / 2);
  std::ranges::nth_element(xs, half);
  std::size_t row = hold.first;
  while (rows[row].x < *half) ++row;
  while (row > 0 && rows[row - 1].x >= *half) --row;
  return row;
}

/// Holds among rows on the way up: stretches of rows within a bin.
std::vector<Hold> holds_in(const std::vector<CurveRow>& rows, double width) {
  std::vector<Hold> stretches;
  for (std::size_t first = 0; first < rows.size();) {
    double least = rows[first].x, largest = least;
    std::size_t end = first + 1;
    for (; end < rows.size(); ++end) {
      least = std::min(least, rows[end].x), largest = std::max(largest, rows[end].x);
      if (largest - least > width) break;
    }
    stretches.push_back({first, end});
    first = end;
  }
  std::vector<std::size_t> counts;
  for (const Hold& each : stretches) counts.push_back(each.end - each.first);
  if (counts.empty()) return {};
  const auto middle = counts.begin() + std::ptrdiff_t(counts.size() / 2);
  std::ranges::nth_element(counts, middle);
  const std::size_t usual = *middle, min_count = std::max(hold_rows, hold_share * usual);
  std::erase_if(stretches, [&](const Hold& h) { return h.end - h.first < min_count; });
  // At its begin the machine still moves.
  for (Hold& hold : stretches) hold.first = arrival(rows, hold);
  // Dense rows on the way are no hold.
  std::erase_if(stretches, [&](const Hold& hold) {
    const std::size_t quarter = std::max<std::size_t>(1, (hold.end - hold.first) / 4);
    double advance = 0.0;
    for (std::size_t i = 0; i < quarter; ++i)
      advance += (rows[hold.end - 1 - i].x - rows[hold.first + i].x) / double(quarter);
    return advance > 0.25 * width;
  });
  return stretches;
}

/// Mean force of so many rows, the last of them being row `last`.
double mean_force(const std::vector<CurveRow>& rows, std::size_t last, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += rows[last - i].y / double(count);
  return sum;
}

/// The row at which the machine has arrived and the force begins to fall; of dense rows the mean of
/// so few that the loading hardly goes on in them.
double force_on_arrival(const std::vector<CurveRow>& rows, std::size_t arrival) {
  constexpr std::size_t dense = 1000;
  return mean_force(rows, arrival, std::min(arrival + 1, 1 + rows.size() / dense));
}

constexpr std::size_t max_shown = 100;

/// Force over the time since the machine has arrived, thinned to what a figure shows: evenly in the
/// logarithm of time, in which a force falls evenly.
void keep_hold(const std::vector<CurveRow>& rows, std::size_t arrival, std::size_t end,
               calibration::LoadingHistory& course) {
  course.held_time.clear(), course.held_y.clear();
  const double span = rows[end - 1].time - rows[arrival].time;
  double next = 0.0;
  for (std::size_t i = arrival; i < end; ++i) {
    const double time = rows[i].time - rows[arrival].time;
    if (time < next && i + 1 < end) continue;
    course.held_time.push_back(time);
    course.held_y.push_back(rows[i].y);
    next = std::max(time * std::pow(1e4, 1.0 / max_shown), time + 1e-4 * span);
  }
}

void tell_hold(const std::vector<CurveRow>& rows, const Hold& hold, Holds use,
               calibration::LoadingHistory& course, std::vector<std::string>& notes) {
  const std::size_t begin = arrival(rows, hold), count = hold.end - hold.first;
  const double start = force_on_arrival(rows, begin) - rows.front().y,
               end = mean_force(rows, hold.end - 1, std::max<std::size_t>(1, count / 10)) -
                     rows.front().y,
               time = rows[hold.end - 1].time - rows[begin].time;
  std::string text =
      fmt::format("a hold, {} rows from line {}, is {}", count, rows[hold.first].line,
                  use == Holds::kept ? "fitted" : "not fitted");
  const bool pressed = start > 0.05 * largest_force(rows);
  if (pressed) {
    const double fall = 1.0 - end / start;
    text += fmt::format("; in it the force {} by {}", fall < 0.0 ? "rises" : "falls",
                        calibration::percent(std::abs(fall)));
    if (std::isnan(course.relaxation) || time >= course.hold_time) {
      course.relaxation = fall, course.hold_time = time;
      if (time > 0.0) keep_hold(rows, begin, hold.end, course);
    }
  }
  if (time > 0.0) text += fmt::format(" in {:.3g} s", time);
  notes.push_back(text);
}

std::string loop_words(const calibration::LoadingHistory& course, const Abscissa& abscissa) {
  if (course.loop >= 0.0)
    return "the loop takes " + calibration::percent(course.loop) + " of the work of the loading";
  return fmt::format(
      "the way back lies above the loading, by {} of its work: not the rubber, which gives "
      "back no more than it took, but {} of play or lag of the machine's travel",
      calibration::percent(-course.loop), abscissa.shown(course.play));
}

/// The unloading, thinned to what a figure shows.
void keep_way_back(const std::vector<CurveRow>& rows, std::size_t first,
                   calibration::LoadingHistory& course) {
  const std::size_t step = std::max<std::size_t>(1, (rows.size() - first) / max_shown);
  for (std::size_t i = first; i < rows.size(); i += step) {
    course.back_x.push_back(rows[i].x);
    course.back_y.push_back(rows[i].y);
  }
}

/// What goes back by more than noise, a twentieth of all, and returns to where it has been. Where
/// most rows do, they are no cycles but in no order, which the reader is told as it stands.
void leave_out_cycles(std::vector<CurveRow>& rows, double width, const Abscissa& abscissa,
                      std::vector<std::string>& notes) {
  constexpr double least_left = 0.2, least_way = 10.0;  // of `width`
  std::vector<CurveRow> first_time;
  double highest = rows.front().x;
  std::size_t turn = 1;  // rows up to the highest one
  bool away = false;
  for (const CurveRow& row : rows) {
    const bool goes_back = row.x < highest - least_way * width;
    if (goes_back && !away) first_time.resize(turn);
    away = goes_back || (away && row.x <= highest);
    if (away) continue;
    first_time.push_back(row);
    if (row.x > highest) highest = row.x, turn = first_time.size();
  }
  const std::size_t left_out = rows.size() - first_time.size();
  if (left_out == 0 || double(first_time.size()) < least_left * double(rows.size())) return;
  notes.push_back(
      fmt::format("of cycles the first loading to every {} is fitted: {} rows of ways "
                  "back and returns are not",
                  abscissa.name, left_out));
  rows = std::move(first_time);
}

}  // namespace

std::vector<CurveRow> loading(std::vector<CurveRow> rows, const Abscissa& abscissa,
                              calibration::LoadingHistory& course, std::vector<std::string>& notes,
                              Holds use) {
  if (rows.empty()) return rows;
  // The first row that deep: the noise of a hold must not choose the turn.
  const auto [least, largest] = std::ranges::minmax_element(rows, {}, &CurveRow::x);
  const double width = (largest->x - least->x) / double(max_rows), close = largest->x - width;
  const auto turn = std::ranges::find_if(rows, [&](const CurveRow& row) { return row.x >= close; });
  auto last = turn;
  while (last + 1 != rows.end() && (last + 1)->x > last->x) ++last;
  const std::size_t count = std::size_t(last - rows.begin()) + 1;
  // Where the machine goes back.
  const auto back = std::find_if(rows.begin() + std::ptrdiff_t(count), rows.end(),
                                 [&](const CurveRow& row) { return row.x < close; });
  const Hold at_end{count, std::size_t(back - rows.begin())};
  if (at_end.end - at_end.first >= 2)
    tell_hold(rows, at_end, use, course, notes);
  else if (use == Holds::left_out && count < rows.size() && back == rows.end())
    notes.emplace_back("rows after the largest position, a hold, are left out");
  if (back != rows.end()) {
    // Of cycles the first.
    auto lowest = back, next = back;
    for (; next != rows.end() && next->x <= lowest->x + 2.0 * width; ++next)
      if (next->x < lowest->x) lowest = next;
    const double around = work({rows.begin(), lowest + 1});
    const std::vector<CurveRow> up(rows.begin(), rows.begin() + std::ptrdiff_t(count));
    const double done = work(up);
    keep_way_back(rows, at_end.end, course);
    if (done > 0.0) {
      course.loop = around / done;
      // A way back that is shifted by the play leaves an area of play times force.
      if (around < 0.0) course.play = -around / (largest_force(rows) - rows.front().y);
      notes.push_back(
          fmt::format("the loading, {} rows, is fitted and the unloading, {} rows, is not; {}",
                      count, rows.size() - at_end.end, loop_words(course, abscissa)));
    }
  }
  const std::vector<Hold> holds =
      holds_in({rows.begin(), rows.begin() + std::ptrdiff_t(count)}, width);
  for (const Hold& hold : holds) tell_hold(rows, hold, use, course, notes);
  if (use == Holds::left_out) {
    rows.resize(count);
    for (auto hold = holds.rbegin(); hold != holds.rend(); ++hold)
      rows.erase(rows.begin() + std::ptrdiff_t(hold->first),
                 rows.begin() + std::ptrdiff_t(hold->end));
    leave_out_cycles(rows, width, abscissa, notes);
    return rows;
  }
  rows.resize(at_end.end);
  int number = 0;
  const auto mark = [&](const Hold& hold) {
    ++number;
    for (std::size_t i = hold.first; i < hold.end; ++i) rows[i].hold = number;
  };
  std::ranges::for_each(holds, mark);
  mark(at_end);
  return rows;
}

}  // namespace fingertip::studies::inline measurements
