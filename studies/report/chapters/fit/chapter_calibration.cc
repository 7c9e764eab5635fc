/// What a fit to curves found, how well it describes them, and what they leave open.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/calibration_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

bool any_left_out(const Fit& fit) {
  return std::ranges::any_of(
      fit.curves, [](const FitCurve& curve) { return std::isfinite(curve.left_out_error()); });
}

/// Chi-square and what it tells, or why there is none.
void add_goodness(ChapterData& chapter, const Fit& fit) {
  const double chi_square = fit.file.chi_square, probability = fit.file.chi_square_probability,
               deviation = fit.file.residual_deviation;
  const std::string unit = fit.curves.empty() ? "" : fit.curves.front().y_quantity.si_unit;
  chapter["sigma"] = std::ranges::any_of(fit.curves, &FitCurve::has_sigma);
  chapter["model_error"] = fit.file.model_error.value_or("");
  chapter["shared"] = std::ranges::any_of(fit.curves, &FitCurve::has_model_error);
  chapter["unshown"] =
      fit.file.model_error && std::ranges::none_of(fit.curves, [](const FitCurve& curve) {
        return curve.knows(&calibration::FitDataRow::whitened_residual);
      });
  chapter["priors"] = std::ranges::any_of(
      fit.parameters, [](const FitParameter& parameter) { return parameter.prior.has_value(); });
  chapter["deviation"] = if_known(deviation, amount(deviation, unit));
  chapter["chi_square"] = if_known(chi_square, number(chi_square));
  chapter["freedom"] = count(double(fit.file.degrees_of_freedom));
  chapter["probability"] = if_known(probability, number(probability, 2));
  chapter["large"] = probability < 0.01;
  chapter["small"] = probability > 0.99;
  chapter["fair"] = probability >= 0.01 && probability <= 0.99;
}

/// Noise, and what the model misses beyond it.
void add_errors(ChapterData& chapter, const Fit& fit) {
  chapter["errors"] = fit.file.errors.has_value();
  if (!fit.file.errors) return;
  const calibration::ErrorsEntry& errors = *fit.file.errors;
  chapter["noise_size"] = amount(errors.noise, "N");
  chapter["over_told"] = if_known(errors.over_told, number(errors.over_told, 2));
  chapter["misses"] = errors.misses();
  chapter["missed"] = percent_magnitude(errors.misfit);
  chapter["missed_most"] = percent_magnitude(errors.misfit_upper);
}

/// Residuals that keep their sign longer than chance would are the model's, not the noise's.
Cell structure_cell(const calibration::ResidualStructure& structure) {
  return {structure.statement.empty() ? "–" : structure.statement,
          if_known(structure.probability, "probability " + number(structure.probability, 2)),
          Grade::none, true};
}

Table curve_table(const Fit& fit) {
  Table table{heads({"Curve", "Points", "Worst\nresidual", "Rms residual\nover rms measured",
                     "Left out\nworst error", "Runs of equal sign"}),
              true};
  table.header.back().words = true;
  for (const FitCurve& curve : fit.curves) {
    const std::size_t points = curve.entry.points > 0 ? curve.entry.points : curve.rows.size();
    table.rows.push_back({{curve.name, curve.condition},
                          points > 0 ? count(double(points)) : "–",
                          magnitude_cell(curve.entry.worst_relative_residual),
                          magnitude_cell(curve.relative_rms()),
                          magnitude_cell(curve.left_out_error()),
                          structure_cell(curve.entry.structure)});
  }
  if (!any_left_out(fit)) table.drop_column(4);
  return table;
}

/// "model central, computed by …, 12 evaluations"; "" when nothing is told.
std::string how_it_was_made(const Fit& fit) {
  std::vector<std::string> parts;
  if (!fit.model.empty()) parts.push_back("model " + fit.model);
  if (!fit.file.forward.empty()) parts.push_back("computed by " + fit.file.forward);
  if (const long n = fit.file.evaluations; n > 0)
    parts.push_back(count(double(n)) + " evaluations");
  if (const long n = fit.file.iterations; n > 0) parts.push_back(count(double(n)) + " iterations");
  if (const double time = fit.file.wall_time; std::isfinite(time))
    parts.push_back(number(time, 3) + gap + "s");
  return fmt::format("{}", fmt::join(parts, ", "));
}

Chapter quality_chapter(const Fit& fit, const std::string& prefix) {
  ChapterData chapter("fit");
  chapter.id = prefix;
  chapter["name"] = fit.name;
  chapter["curve"] = fit.problem == "curve";
  chapter["experiment"] = fit.problem == "experiment";
  chapter["damping"] = fit.problem == "damping";
  chapter["made"] = how_it_was_made(fit);
  chapter["statement"] = as_shown(fit.file.statement);
  add_errors(chapter, fit);
  add_goodness(chapter, fit);
  chapter["left_out"] = any_left_out(fit);
  chapter["travel"] = fit.file.rig.has_value();
  chapter["noise"] = std::ranges::any_of(fit.curves, [](const FitCurve& curve) {
    return curve.entry.course && curve.entry.course->noise > 0.0;
  });
  chapter.figures = curve_figures(fit, prefix);
  WordList figures;
  for (const Figure& figure : chapter.figures) figures.emplace_back()["figure"] = figure.name;
  chapter["figures"] = std::move(figures);
  chapter.tables["curves"] = curve_table(fit);
  return written(std::move(chapter));
}

Chapter material_chapter(const Fit& fit, const std::string& prefix) {
  double widest = meshes::unknown;
  for (const calibration::SurrogateRow& row : fit.surrogate)
    if (row.force > 0.0) widest = std::fmax(widest, row.force_upper / row.force - 1.0);
  ChapterData chapter("fit_material");
  chapter.id = prefix + "-material";
  chapter["name"] = fit.name;
  chapter["prefix"] = prefix;
  chapter["springs"] = finds_springs(fit);
  chapter["condition"] = fit.surrogate_notes.condition;
  chapter["statement"] = as_shown(fit.surrogate_notes.statement);
  chapter["widest"] = if_known(widest, percent_magnitude(widest));
  chapter.figures = {fitted_moduli_figure(fit, prefix), surrogate_figure(fit, prefix)};
  return written(std::move(chapter));
}

std::string estimates_of(const Fit& fit) {
  std::vector<std::string> estimates;
  for (const FitParameter& parameter : fit.parameters)
    estimates.push_back(estimate_words(parameter));
  return enumerate(estimates);
}

double worst_residual(const Fit& fit) {
  double worst = meshes::unknown;
  for (const FitCurve& curve : fit.curves)
    worst = std::fmax(worst, curve.entry.worst_relative_residual);
  return worst;
}

/// The result of one fit in a few sentences.
std::string fit_answer(const Fit& fit) {
  if (fit.of_displacements()) return as_shown(fit.file.statement);
  double left_out = meshes::unknown;
  for (const FitCurve& curve : fit.curves) left_out = std::fmax(left_out, curve.left_out_error());
  const double worst = worst_residual(fit);
  TemplateData words;
  words["estimates"] = estimates_of(fit);
  words["model"] = fit.model;
  words["curves"] = std::to_string(fit.curves.size());
  words["one"] = fit.curves.size() == 1;
  words["worst"] = if_known(worst, percent_magnitude(worst));
  words["left_out"] = if_known(left_out, percent_magnitude(left_out));
  words["travel"] = fit.file.rig.has_value();
  words["rejected"] = !fit.file.failed.empty();
  words["open"] = !fit.file.unidentifiable.empty();
  return sentences("answer_fit", words);
}

/// A row per fit.
Chapter fits_chapter(const CalibrationData& data) {
  Table table{heads({"Fit", "Curves", "Parameters", "Worst residual", "Its own tests"})};
  table.header[2].words = true;
  for (const Fit& fit : data.fits) {
    if (fit.file.empty()) continue;
    const std::string estimates = estimates_of(fit);
    table.rows.push_back({{fit.name, fit.model},
                          std::to_string(fit.curves.size()),
                          prose(estimates.empty() ? "–" : estimates),
                          percent_magnitude(worst_residual(fit)),
                          fit.file.failed.empty() ? "passed" : "not passed"});
  }
  ChapterData chapter("fits");
  chapter.tables["fits"] = std::move(table);
  return written(std::move(chapter));
}

}  // namespace

std::vector<std::string> fit_failures(const CalibrationData& data) {
  return data.fits.size() == 1 ? data.fits.front().file.failed : std::vector<std::string>();
}

std::string fits_answer(const CalibrationData& data) {
  if (data.fits.size() == 1) return fit_answer(data.fits.front());
  std::size_t failed = 0;
  for (const Fit& fit : data.fits) failed += !fit.file.failed.empty();
  TemplateData words;
  words["fits"] = std::to_string(data.fits.size());
  words["failed"] = failed > 0 ? std::to_string(failed) : "";
  words["one"] = failed == 1;
  return sentences("answer_fits", words);
}

std::vector<Chapter> fit_chapters(const CalibrationData& data) {
  std::vector<Chapter> chapters;
  const bool several = data.fits.size() > 1;
  if (several) chapters.push_back(fits_chapter(data));
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const Fit& fit = data.fits[i];
    const std::string prefix = several ? fmt::format("fit_{}", i + 1) : "fit";
    if (fit.file.empty() || fit.of_displacements()) continue;
    chapters.push_back(quality_chapter(fit, prefix));
    std::vector<Chapter> parts = measured_chapters(fit, prefix);
    parts.insert(parts.begin(), {predicted_chapter(fit, prefix), parameter_chapter(fit, prefix)});
    parts.push_back(identifiability_chapter(fit, prefix));
    parts.push_back(material_chapter(fit, prefix));
    for (Chapter& part : parts) {
      // Of several fits each is a chapter, lest there be more chapters than one can choose from.
      if (several)
        std::ranges::move(part.blocks, std::back_inserter(chapters.back().blocks));
      else
        chapters.push_back(std::move(part));
    }
  }
  return chapters;
}

std::vector<NotRun> missing_fit_parts(const CalibrationData& data) {
  std::vector<NotRun> missing;
  for (const Fit& fit : data.fits) {
    const std::string of = fit.name.empty() ? "" : " of " + fit.name;
    const std::string folder = fit.folder.empty() ? "" : fit.folder + "/";
    const auto need = [&](bool there, const std::string& what, const std::string& where) {
      if (!there) missing.push_back({what + of, folder + where});
    };
    need(!fit.file.empty(), "Fit", "calibration.json");
    if (fit.file.empty() || fit.of_displacements()) continue;
    const bool measured =
        std::ranges::any_of(fit.curves, [](const FitCurve& curve) { return !curve.rows.empty(); });
    need(measured, "Measured and fitted curves", "fit_data.csv");
    need(!fit.parameters.empty(), "Parameters", "calibration.json: parameters");
    if (fit.parameters.size() > 1) {
      need(!fit.file.singular_values.empty(), "Singular values",
           "calibration.json: singular_values");
      need(fit.file.profile.has_value(), "Profile likelihood", "calibration.json: profile");
    }
    if (fit.curves.size() > 1)
      need(any_left_out(fit), "Curves left out one after the other",
           "calibration.json: curves: left_out");
    need(!fit.surrogate.empty(), "Surrogate", "surrogate.csv, surrogate.json");
  }
  if (data.study && data.transfer.empty())
    missing.push_back({"Predictions of the fits", "transfer.csv"});
  return missing;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
