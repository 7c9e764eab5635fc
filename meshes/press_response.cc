#include "meshes/press_response.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::meshes {

namespace {

struct Column {
  std::string_view title;
  double PressSample::*value;
};

constexpr std::array<Column, 11> columns{{
    {"indentation [m]", &PressSample::indentation},
    {"normal_force [N]", &PressSample::normal_force},
    {"lateral_force_x [N]", &PressSample::lateral_force_x},
    {"lateral_force_y [N]", &PressSample::lateral_force_y},
    {"torque_x [N m]", &PressSample::torque_x},
    {"torque_y [N m]", &PressSample::torque_y},
    {"torque_z [N m]", &PressSample::torque_z},
    {"contact_radius [m]", &PressSample::contact_radius},
    {"max_pressure [Pa]", &PressSample::max_pressure},
    {"force_error [N]", &PressSample::force_error},
    {"time [s]", &PressSample::time},
}};

/// Splits one CSV line; cells hold no quotes, for they are numbers and titles without commas.
std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  for (std::size_t start = 0;;) {
    const std::size_t comma = line.find(',', start);
    std::string cell = line.substr(start, comma - start);
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    while (!cell.empty() && blank(cell.back())) cell.pop_back();
    while (!cell.empty() && blank(cell.front())) cell.erase(cell.begin());
    cells.push_back(std::move(cell));
    if (comma == std::string::npos) return cells;
    start = comma + 1;
  }
}

[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t line, std::string value,
                         std::string rule, std::string remedy) {
  throw InvalidInput({file.string() + ":" + std::to_string(line), std::move(value), std::move(rule),
                      std::move(remedy)});
}

/// For every column of the file the member it fills, or nullptr for a column not known here.
std::vector<double PressSample::*> read_titles(const std::filesystem::path& file,
                                               const std::vector<std::string>& titles) {
  std::vector<double PressSample::*> members;
  for (const std::string& title : titles) {
    const auto known = std::find_if(columns.begin(), columns.end(),
                                    [&](const Column& column) { return column.title == title; });
    members.push_back(known == columns.end() ? nullptr : known->value);
  }
  for (const Column& needed : {columns[0], columns[1]}) {
    if (std::find(members.begin(), members.end(), needed.value) == members.end()) {
      refuse(file, 1, titles.front(), "the column '" + std::string(needed.title) + "' is missing",
             "the first line must name the columns with their units, as in 'indentation "
             "[m],normal_force [N]'");
    }
  }
  return members;
}

double read_number(const std::filesystem::path& file, std::size_t line, const std::string& cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value)) {
    refuse(file, line, cell,
           "every cell must be a finite number (or empty, except indentation and force)",
           "correct the cell");
  }
  return value;
}

PressSample read_row(const std::filesystem::path& file, std::size_t line,
                     const std::vector<std::string>& cells,
                     const std::vector<double PressSample::*>& members) {
  if (cells.size() != members.size()) {
    refuse(file, line, std::to_string(cells.size()) + " cells",
           "every row must have as many cells as the first line has names (" +
               std::to_string(members.size()) + ")",
           "the file may be truncated: write it again");
  }
  PressSample sample;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const bool needed = members[c] == columns[0].value || members[c] == columns[1].value;
    if (members[c] != nullptr && (needed || !cells[c].empty())) {
      sample.*members[c] = read_number(file, line, cells[c]);
    }
  }
  return sample;
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

double PressResponse::normal_force_at(double indentation) const {
  if (!(indentation >= 0.0 && indentation <= depth())) {
    throw std::out_of_range("no force is known at an indentation of " + to_text(indentation) +
                            " m: the response ends at " + to_text(depth()) + " m");
  }
  std::vector<double> x{0.0}, y{0.0};
  for (const PressSample& sample : samples_) {
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

void PressResponse::write_csv(const std::filesystem::path& file) const {
  write_atomically(file, [&](std::ostream& out) {
    for (const Column& column : columns) {
      out << (&column == columns.data() ? "" : ",") << column.title;
    }
    out << '\n';
    for (const PressSample& sample : samples_) {
      for (const Column& column : columns) {
        out << (&column == columns.data() ? "" : ",") << to_text(sample.*column.value);
      }
      out << '\n';
    }
  });
}

PressResponse PressResponse::read_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string text;
  if (!in || !std::getline(in, text)) {
    refuse(file, 1, "", "the file cannot be read or is empty", "check its name and permissions");
  }
  const auto members = read_titles(file, cells_of(text));
  PressResponse response;
  for (std::size_t line = 2; std::getline(in, text); ++line) {
    if (in.eof()) {
      refuse(file, line, text, "the last row must end with a line break",
             "the file may be truncated: write it again");
    }
    const PressSample sample = read_row(file, line, cells_of(text), members);
    if (!response.empty() && sample.indentation <= response.depth()) {
      refuse(file, line, to_text(sample.indentation) + " m",
             "indentations must increase from row to row", "sort the rows");
    }
    response.append(sample);
  }
  return response;
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

}  // namespace fingertip::meshes
