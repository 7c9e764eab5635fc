#include "meshes/press/press_response.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>

#include "meshes/tables/table_rows.h"

namespace fingertip::meshes::inline press {

namespace {

[[noreturn]] void refuse(const CsvTable& table, std::size_t row, const std::string& column,
                         const std::string& value, const std::string& rule) {
  throw InvalidInput({table.file.string() + ":" + std::to_string(table.lines[row]) + ", " + column,
                      value, rule, "correct the file, or run again what writes it"});
}

/// Indentation and force, which every row must have; also of people's own files.
void check_needed(const CsvTable& table) {
  for (const char* title : {"indentation [m]", "normal_force [N]"}) {
    if (!table.has(title))
      throw InvalidInput({table.file.string() + ":1", table.names.front(),
                          std::string("the column '") + title + "' is missing",
                          "the first line must name the columns with their units, as in "
                          "'indentation [m],normal_force [N]'"});
    const std::vector<double> values = table.numbers(title);
    for (std::size_t row = 0; row < values.size(); ++row)
      if (std::isnan(values[row])) refuse(table, row, title, "", "must not be empty");
  }
}

bool is_given(double value) {
  return !std::isnan(value);
}

/// A row after one of a program: its stage is that one's or a later one, and time goes on.
void check_stage(const CsvTable& table, std::size_t row, const PressSample& before,
                 const PressSample& now) {
  if (!(now.stage >= before.stage))
    refuse(table, row, "stage", is_given(now.stage) ? to_text(now.stage) : "",
           "stages must be given in every row or none, and not decrease from row to row");
  if (is_given(now.time) && is_given(before.time) && !(now.time > before.time))
    refuse(table, row, "time [s]", to_text(now.time), "times must increase from row to row");
}

/// Slopes of the monotone cubic through (x, y): Fritsch & Carlson, SIAM J. Numer. Anal. 17 (1980)
/// 238, with the weighted harmonic mean of Fritsch & Butland (1984) inside and one-sided
/// differences at the ends.
std::vector<double> monotone_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t last = x.size() - 1;
  std::vector<double> slope(x.size(), 0.0);
  const auto secant = [&](std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
  for (std::size_t i = 1; i < last; ++i) {
    const double left = secant(i - 1), right = secant(i);
    if (left * right <= 0.0) continue;
    const double w1 = 2.0 * (x[i + 1] - x[i]) + (x[i] - x[i - 1]);
    const double w2 = (x[i + 1] - x[i]) + 2.0 * (x[i] - x[i - 1]);
    slope[i] = (w1 + w2) / (w1 / left + w2 / right);
  }
  // A parabola through the end leaves, limited so that the curve stays monotone.
  const auto end_slope = [&](double outer, double inner_slope) {
    const double parabola = 1.5 * outer - 0.5 * inner_slope;
    if (parabola * outer <= 0.0) return 0.0;
    return std::abs(parabola) > 3.0 * std::abs(outer) ? 3.0 * outer : parabola;
  };
  slope[0] = end_slope(secant(0), last > 1 ? slope[1] : secant(0));
  slope[last] = end_slope(secant(last - 1), last > 1 ? slope[last - 1] : secant(0));
  return slope;
}

}  // namespace

void PressSample::set_contact(double radius, double peak) {
  contact_radius = radius;
  contact_area = std::numbers::pi * radius * radius;
  mean_pressure = contact_area > 0.0 ? normal_force / contact_area : 0.0;
  max_pressure = peak;
}

bool PressSample::is_beside(const PressSample& other) const {
  constexpr double same = 1e-9;
  for (double PressSample::*place : {&PressSample::stage, &PressSample::indentation,
                                     &PressSample::lateral_displacement, &PressSample::twist}) {
    const double here = is_given(this->*place) ? this->*place : 0.0,
                 there = is_given(other.*place) ? other.*place : 0.0;
    if (std::abs(here - there) > same * std::abs(here)) return false;
  }
  return true;
}

void PressSample::set_errors(const RelativeErrors& relative) {
  constexpr double left = 1e-7;  // by solvers of what vanishes
  constexpr double coupling = 0.125;
  const auto share = [](double error) {
    return std::isfinite(error) ? error : unknown;
  };  // of none
  const double normal = std::abs(normal_force), aside = force().head<2>().norm(),
               moment = torque().norm(), arm = contact_radius * (normal + aside),
               spin = is_given(spin_torque) ? std::min(std::abs(spin_torque), moment) : 0.0;
  const double off = share(relative.normal), off_aside = share(relative.aside),
               moved = spin > 0.0 ? relative.centre * spin / contact_radius : 0.0;
  force_error = off * normal;
  lateral_force_error = torque_error = unknown;
  double more_aside = 0.0;
  if (aside > left * normal) {
    lateral_force_error = std::hypot(off_aside * aside, off * coupling * normal, moved);
    more_aside = std::max(off_aside - off, 0.0) * aside + moved;
  }
  if (moment > left * arm) {
    const bool pushed = torque().head<2>().norm() > left * arm;
    const double across = pushed ? std::sqrt(moment * moment - spin * spin) + arm : 0.0;
    torque_error =
        std::hypot(share(relative.spin) * spin, off * across, relative.lever * more_aside);
  }
}

void PressSample::set_pressure_error(double profile) {
  pressure_error = (force_error / std::abs(normal_force) + profile) * max_pressure;
}

std::span<const PressSample> PressResponse::pressing() const {
  const auto follows =
      std::ranges::adjacent_find(samples_, [](const PressSample& before, const PressSample& now) {
        return before.indentation >= now.indentation || before.stage < now.stage;
      });
  const auto end = follows == samples_.end() ? follows : follows + 1;
  return {samples_.data(), std::size_t(end - samples_.begin())};
}

std::span<const PressSample> PressResponse::sliding() const {
  const bool program = !samples_.empty() && is_given(samples_.front().stage);
  return program ? std::span<const PressSample>() : std::span(samples_).subspan(pressing().size());
}

std::span<const PressSample> PressResponse::following() const {
  return std::span(samples_).subspan(pressing().size() + sliding().size());
}

double PressResponse::deepest() const {
  double most = 0.0;
  for (const PressSample& sample : samples_) most = std::max(most, sample.indentation);
  return most;
}

double PressResponse::normal_force_at(double indentation) const {
  if (!(indentation >= 0.0 && indentation <= depth())) {
    throw std::out_of_range("no force is known at an indentation of " + to_text(indentation) +
                            " m: the response ends at " + to_text(depth()) + " m");
  }
  std::vector<double> x{0.0}, y{0.0};
  for (const PressSample& sample : pressing()) {
    if (sample.indentation <= 0.0) continue;
    x.push_back(sample.indentation);
    y.push_back(sample.normal_force);
  }
  if (x.size() == 1) return 0.0;
  const std::vector<double> slope = monotone_slopes(x, y);
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, indentation);
  const std::size_t i = std::size_t(above - x.begin()) - 1;
  const double h = x[i + 1] - x[i], t = (indentation - x[i]) / h, s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * y[i] + t * h * slope[i]) +
         t * t * ((1.0 + 2.0 * s) * y[i + 1] - s * h * slope[i + 1]);
}

double PressResponse::relative_error_at(double indentation) const {
  constexpr double same = 1e-9;  // [m]
  double before = unknown;
  for (const PressSample& sample : pressing()) {
    const double relative = sample.force_error / std::abs(sample.normal_force);
    if (!std::isfinite(relative)) continue;
    if (std::abs(sample.indentation - indentation) <= same) return relative;
    if (sample.indentation > indentation) return std::fmax(before, relative);
    before = relative;
  }
  return before;
}

void PressResponse::write_csv(const std::filesystem::path& file) const {
  std::vector<PressSample> rows = samples_;
  for (double PressSample::*moved : {&PressSample::lateral_displacement, &PressSample::twist})
    if (std::ranges::none_of(rows,
                             [&](const PressSample& row) { return std::abs(row.*moved) > 0.0; }))
      for (PressSample& row : rows) row.*moved = unknown;
  write_rows(rows, file);
}

PressResponse PressResponse::read_csv(const std::filesystem::path& file) {
  return of(meshes::read_csv(file));
}

PressResponse PressResponse::of(const CsvTable& table) {
  check_needed(table);
  std::vector<PressSample> samples = known_rows<PressSample>(table);
  for (std::size_t row = 1; row < samples.size(); ++row) {
    const PressSample &before = samples[row - 1], &now = samples[row];
    const bool program = is_given(before.stage) || is_given(now.stage);
    if (program) check_stage(table, row, before, now);
    if (program && now.stage > samples.front().stage) continue;
    const bool slides =
        now.indentation == before.indentation &&
        (std::abs(now.lateral_displacement) > std::abs(before.lateral_displacement) ||
         std::abs(now.twist) > std::abs(before.twist));
    if (now.indentation <= before.indentation && !slides) {
      refuse(table, row, "indentation [m]", to_text(now.indentation),
             "indentations must increase from row to row (or lateral displacements or twists at "
             "full depth)");
    }
  }
  return PressResponse(std::move(samples));
}

double relative_force_error(const PressResponse& response, const PressResponse& reference,
                            double indentation) {
  const double expected = reference.normal_force_at(indentation);
  return (response.normal_force_at(indentation) - expected) / expected;
}

double relative_l2_force_error(const PressResponse& response, const PressResponse& reference,
                               double from, double to) {
  constexpr int intervals = 200;
  double difference = 0.0, size = 0.0;
  for (int i = 0; i <= intervals; ++i) {
    const double at = i == intervals ? to : from + (to - from) * i / intervals;
    const double weight = i == 0 || i == intervals ? 0.5 : 1.0;
    const double expected = reference.normal_force_at(at);
    const double defect = response.normal_force_at(at) - expected;
    difference += weight * defect * defect;
    size += weight * expected * expected;
  }
  return std::sqrt(difference / size);
}

}  // namespace fingertip::meshes::inline press
