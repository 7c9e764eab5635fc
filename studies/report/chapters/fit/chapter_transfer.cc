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
std::string trouble_of(const CalibrationData& data, const std::string& fit,
                       const std::string& prediction) {
  for (const TransferRow& row : data.transfer)
    if (row.fit == fit && row.prediction == prediction && !trouble(row.status).empty())
      return row.status;
  return "";
}

/// Where the error is largest: "at 2 mm".
std::string place(const CalibrationData& data, const std::string& fit,
                  const std::string& prediction) {
  const TransferRow* worst = largest_in(data.transfer, [&](const TransferRow& row) {
    return row.fit == fit && row.prediction == prediction ? std::abs(row.relative_error)
                                                          : meshes::unknown;
  });
  return worst == nullptr ? "" : "at " + shown_units().length.text(worst->indentation);
}

Table transfer_table(const CalibrationData& data) {
  Table table{{"Fitted to"}, true};
  for (const std::string& prediction : data.predictions) table.header.emplace_back(prediction);
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const Fit& fit = data.fits[i];
    std::vector<Cell> row{{fit.name, fit.model}};
    for (std::size_t j = 0; j < data.predictions.size(); ++j) {
      const std::string status = trouble_of(data, fit.name, data.predictions[j]);
      row.push_back(
          magnitude_cell(data.worst_error[i][j],
                         status.empty() ? place(data, fit.name, data.predictions[j]) : status));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string transfer_answer(const CalibrationData& data) {
  struct Outcome {
    std::string name;
    double worst;
    bool complete;
  };
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const std::vector<double>& row = data.worst_error[i];
    outcomes.push_back(
        {data.fits[i].name, largest_magnitude(row),
         std::ranges::all_of(row, [](double error) { return std::isfinite(error); })});
  }
  const Outcome* worst = largest_in(outcomes, &Outcome::worst);
  if (worst == nullptr) return "";
  // The best one among those that predicted everything.
  const Outcome* best = largest_in(outcomes, [](const Outcome& outcome) {
    return outcome.complete ? -outcome.worst : meshes::unknown;
  });
  TemplateData words;
  words["fits"] = std::to_string(data.fits.size());
  words["one"] = data.fits.size() == 1;
  words["complete"] = best != nullptr;
  words["best"] = best ? best->name : "";
  words["best_error"] = best ? percent_magnitude(best->worst) : "";
  words["another"] = best != worst;
  words["worst"] = worst->name;
  words["worst_error"] = percent_magnitude(worst->worst);
  return sentences("answer_transfer", words);
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

}  // namespace fingertip::studies::report::inline chapters::inline fit
