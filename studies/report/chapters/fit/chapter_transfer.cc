/// How far a fit carries: presses it has not seen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/calibration_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

/// What kept a prediction from its deepest samples; empty when nothing did.
std::string trouble(const CalibrationData& data, const std::string& fit,
                    const std::string& prediction) {
  for (const TransferRow& row : data.transfer) {
    const bool fine = row.status.empty() || row.status == "finished" || row.status == "ok";
    if (row.fit == fit && row.prediction == prediction && !fine) return row.status;
  }
  return "";
}

/// Where the error is largest: "at 2 mm".
std::string place(const CalibrationData& data, const std::string& fit,
                  const std::string& prediction) {
  const TransferRow* worst = nullptr;
  for (const TransferRow& row : data.transfer) {
    if (row.fit != fit || row.prediction != prediction || !std::isfinite(row.relative_error))
      continue;
    if (worst == nullptr || std::abs(row.relative_error) > std::abs(worst->relative_error))
      worst = &row;
  }
  return worst == nullptr ? "" : "at " + shown_units().length.text(worst->indentation);
}

Table transfer_table(const CalibrationData& data) {
  Table table;
  table.graded = true;
  table.header = {plain("Fitted to")};
  for (const std::string& prediction : data.predictions) table.header.push_back(plain(prediction));
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const Fit& fit = data.fits[i];
    std::vector<Cell> row{plain(fit.name, fit.model)};
    for (std::size_t j = 0; j < data.predictions.size(); ++j) {
      const double error = data.worst_error[i][j];
      const std::string status = trouble(data, fit.name, data.predictions[j]);
      row.push_back({percent_magnitude(error),
                     status.empty() ? place(data, fit.name, data.predictions[j]) : status,
                     grade(error)});
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The index of the fit whose worst prediction is best (sign -1) or worst (1), the first only among
/// those that predicted everything; the number of fits when there is none.
std::size_t extreme(const CalibrationData& data, double sign) {
  std::size_t found = data.fits.size();
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const std::vector<double>& row = data.worst_error[i];
    const double worst = largest_magnitude(row);
    const bool complete =
        std::ranges::all_of(row, [](double error) { return std::isfinite(error); });
    if (!std::isfinite(worst) || (sign < 0.0 && !complete)) continue;
    if (found == data.fits.size() ||
        sign * worst > sign * largest_magnitude(data.worst_error[found]))
      found = i;
  }
  return found;
}

std::string transfer_answer(const CalibrationData& data) {
  const std::size_t best = extreme(data, -1.0), worst = extreme(data, 1.0);
  if (worst == data.fits.size()) return "";
  const bool complete = best < data.fits.size();
  const auto error = [&](std::size_t i) {
    return percent_magnitude(largest_magnitude(data.worst_error[i]));
  };
  Words words;
  words["fits"] = std::to_string(data.fits.size());
  words["one"] = data.fits.size() == 1;
  words["complete"] = complete;
  words["best"] = complete ? data.fits[best].name : "";
  words["best_error"] = complete ? error(best) : "";
  words["another"] = best != worst;
  words["worst"] = data.fits[worst].name;
  words["worst_error"] = error(worst);
  return sentences("answer_transfer", words);
}

std::string ascii(const std::string& text) {
  std::string result;
  for (const char c : text) result += c >= ' ' && c <= '~' ? c : '?';
  return result;
}

std::string parameter_lines(const Fit& fit) {
  std::string text;
  for (const FitParameter& parameter : fit.parameters) {
    const auto value = [&](double si) {
      return std::isfinite(si) ? fmt::format("{:.5g}", parameter.factor * si) : std::string("-");
    };
    const ShownUnit* known = shown_units().of(parameter.si_unit);
    const std::string unit = known ? std::string(known->ascii) : parameter.unit;
    const bool open = calibration::is_open(parameter.si_unit, parameter.estimate, parameter.lower,
                                           parameter.upper);
    text += fmt::format(
        "  {:<18}{:>12} {:<8} 95 %: {}{}\n", ascii(parameter.name), value(parameter.estimate),
        ascii(unit),
        open ? std::string("not determined by these data")
             : value(parameter.lower) + " ... " + value(parameter.upper),
        parameter.at_bound ? fmt::format(" ({} at its bound)", ascii(parameter.bounded)) : "");
  }
  return text;
}

}  // namespace

Chapter transfer_chapter(const CalibrationData& data) {
  if (data.predictions.empty() || data.fits.empty()) return {};
  ChapterData chapter("transfer");
  chapter["answer"] = transfer_answer(data);
  chapter.figures = {transfer_figure(data)};
  chapter.tables["transfer"] = transfer_table(data);
  return written(std::move(chapter));
}

std::string calibration_answer(const CalibrationData& data) {
  const std::string transfer = transfer_answer(data);
  if (!transfer.empty()) return transfer;
  return fits_answer(data);
}

std::string calibration_text(const CalibrationData& data) {
  std::string text;
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const Fit& fit = data.fits[i];
    text += ascii(fmt::format("{} ({})", fit.name.empty() ? fit.problem : fit.name, fit.model));
    text += '\n';
    text += parameter_lines(fit);
    for (std::size_t j = 0; j < data.predictions.size(); ++j) {
      const double error = data.worst_error[i][j];
      text += fmt::format("  {:<30}{:>10}\n", ascii(data.predictions[j]),
                          std::isfinite(error) ? fmt::format("{:.2f} %", 100.0 * error) : "-");
    }
  }
  if (!data.predictions.empty()) text += "largest error of the force of each press predicted\n";
  return text;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
