/// What a fit to curves found, how well it describes them, and what they leave open.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "studies/report/calibration_chapters.h"
#include "studies/report/calibration_figures.h"

namespace fingertip::studies::reporting {
namespace {

using Blocks = std::vector<Block>;

Cell words(const std::string& text) {
  Cell cell = plain(text.empty() ? "–" : text);
  cell.words = true;
  return cell;
}

/// Leaves out figures without panels.
void add_figure(Blocks& blocks, Figure figure, const std::string& title,
                const std::string& caption) {
  if (!figure.panels.empty()) blocks.push_back(FigureBlock{std::move(figure), title, caption});
}

std::string chi_square_words(const Fit& fit) {
  const double chi_square = fit.file.chi_square, probability = fit.file.chi_square_probability,
               freedom = double(fit.file.degrees_of_freedom);
  if (!std::isfinite(chi_square)) {
    const bool sigma = std::ranges::any_of(fit.curves, &FitCurve::has_sigma);
    const double deviation = fit.file.residual_deviation;
    const std::string unit = fit.curves.empty() ? "" : fit.curves.front().y_quantity.si_unit;
    std::string text =
        sigma ? "Chi-square is not given: the loss was not quadratic."
              : "No sigma was given, so the residuals themselves tell how large the noise is, and "
                "nothing tells whether the model is right.";
    if (std::isfinite(deviation))
      text += " Residual deviation: " + with_prefix(deviation, unit) + ".";
    return text;
  }
  std::string text = fmt::format("Chi-square is {} with {} degrees of freedom", number(chi_square),
                                 count(freedom));
  if (!std::isfinite(probability)) return text + ".";
  text += fmt::format(
      ": if the model and sigma are right, a value at least that large has the probability {}. ",
      number(probability, 2));
  if (probability < 0.01)
    return text +
           "The residuals are larger than sigma explains: the model does not describe the data, "
           "or sigma is too small. The intervals below are widened accordingly.";
  if (probability > 0.99)
    return text + "The residuals are smaller than sigma and the model's known error explain.";
  return text + "The residuals are as large as sigma says.";
}

/// Residuals that keep their sign longer than chance would are the model's, not the noise's.
Cell structure_cell(const FitCurve& curve) {
  Cell cell = words(curve.structure);
  if (std::isfinite(curve.structure_probability))
    cell.note = "probability " + number(curve.structure_probability, 2);
  return cell;
}

Table curve_table(const Fit& fit) {
  const bool left_out = std::ranges::any_of(
      fit.curves, [](const FitCurve& curve) { return std::isfinite(curve.left_out_error); });
  Table table;
  table.caption = "The curves. Residuals are relative to what was measured.";
  table.graded = true;
  table.header = {plain("Curve"), plain("Points"), plain("Worst", "residual"),
                  plain("Rms", "residual"), plain("Runs of equal sign")};
  table.header.back().words = true;
  if (left_out) {
    table.header.insert(table.header.end() - 1, plain("Left out", "worst error"));
    table.caption +=
        " Left out: the error of the curve as the fit to all others predicts it, the honest "
        "measure of what the fit says about curves it has not seen.";
  }
  for (const FitCurve& curve : fit.curves) {
    const double points =
        std::isfinite(curve.points) || curve.x.empty() ? curve.points : double(curve.x.size());
    std::vector<Cell> row{plain(curve.name, curve.condition),
                          plain(count(points)),
                          {percent_magnitude(curve.worst), "", grade(curve.worst)},
                          {percent_magnitude(curve.rms), "", grade(curve.rms)}};
    if (left_out)
      row.push_back({percent_magnitude(curve.left_out_error), "", grade(curve.left_out_error)});
    row.push_back(structure_cell(curve));
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_quality(Blocks& blocks, const Fit& fit, const std::string& prefix) {
  blocks.push_back(Paragraph{"Goodness of fit.", chi_square_words(fit)});
  const bool sigma = std::ranges::any_of(fit.curves, &FitCurve::has_sigma);
  for (Figure& figure : curve_figures(fit, prefix))
    add_figure(blocks, std::move(figure), "Measured against fitted",
               sigma ? "Bars are one sigma. Beneath, measured minus fitted; of noise alone 95 % "
                       "stay within the band, on both sides of zero and in no order."
                     : "Beneath, measured minus fitted; noise lies on both sides of zero, in no "
                       "order.");
  if (!fit.curves.empty()) blocks.push_back(curve_table(fit));
}

void add_moduli(Blocks& blocks, const Fit& fit, const std::string& prefix) {
  add_figure(blocks, fitted_moduli_figure(fit, prefix), "Young's modulus along every direction",
             "Distance from the centre and colour are E of the infinite lattice along that "
             "direction, both at the same scale; n is the direction in the cube's axes. Rubber is "
             "a ball.");
}

void add_surrogate(Blocks& blocks, const Fit& fit, const std::string& prefix) {
  const std::string& condition = fit.surrogate_notes.condition;
  std::string caption = fit.surrogate_notes.statement;
  if (!condition.empty()) caption = "Condition: " + condition + ". " + caption;
  double widest = meshes::unknown;
  for (const calibration::SurrogateRow& row : fit.surrogate)
    if (row.force > 0.0) widest = std::fmax(widest, row.force_upper / row.force - 1.0);
  if (std::isfinite(widest))
    caption += fmt::format(" The band is at most {} of the force.", percent_magnitude(widest));
  add_figure(blocks, surrogate_figure(fit, prefix), "The fast stand-in for the press", caption);
}

void add_validity(Blocks& blocks, const Fit& fit) {
  const calibration::ValidityEntry& validity = fit.file.validity;
  std::vector<std::string> parts;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty() && value != "–") parts.push_back(name + value);
  };
  add("indentation up to ",
      std::isfinite(validity.largest_strain_measure)
          ? percent_magnitude(validity.largest_strain_measure) + " of the thickness"
          : "");
  add("model ", validity.model);
  add("kinematics ", validity.kinematics);
  if (std::isfinite(validity.spacing)) add("spacing ", length(validity.spacing));
  add("Poisson's ratio ", number(validity.poissons_ratio));
  if (!parts.empty())
    blocks.push_back(Paragraph{"Where it holds.", "Fitted and checked for " + enumerate(parts) +
                                                      "; outside of that it is a guess."});
}

std::string introduction(const Fit& fit) {
  std::vector<std::string> parts;
  if (!fit.model.empty()) parts.push_back("model " + fit.model);
  if (!fit.file.forward.empty()) parts.push_back("computed by " + fit.file.forward);
  if (const long n = fit.file.evaluations; n > 0)
    parts.push_back(count(double(n)) + " evaluations");
  if (const long n = fit.file.iterations; n > 0) parts.push_back(count(double(n)) + " iterations");
  if (const double time = fit.file.wall_time; std::isfinite(time))
    parts.push_back(number(time, 3) + gap + "s");
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? text : text + ".";
}

std::string problem_title(const Fit& fit) {
  if (fit.problem == "curve") return "The fit to the continuum's curves";
  if (fit.problem == "experiment") return "The fit to measured curves";
  if (fit.problem == "finite-strain") return "The fit at finite strain";
  if (fit.problem == "damping") return "The fit of the damping";
  return "The fit";
}

}  // namespace

std::vector<Chapter> fit_chapters(const CalibrationData& data) {
  std::vector<Chapter> chapters;
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    const Fit& fit = data.fits[i];
    const std::string prefix = data.fits.size() > 1 ? fmt::format("fit_{}", i + 1) : "fit";
    const std::string of = fit.name.empty() ? "" : " of " + fit.name;
    if (fit.file.empty()) continue;
    std::vector<Chapter> parts(4);
    parts[0] = {prefix, fit.name.empty() ? problem_title(fit) : "Fit " + fit.name, {}};
    const std::string& statement = fit.file.statement;
    if (!introduction(fit).empty())
      parts[0].blocks.push_back(Paragraph{"How it was made.", introduction(fit)});
    if (!statement.empty()) parts[0].blocks.push_back(Paragraph{"Result.", statement});
    add_quality(parts[0].blocks, fit, prefix);
    parts[1] = {prefix + "-parameters", "Parameters" + of, {}};
    parts[1].blocks = parameter_blocks(fit);
    add_validity(parts[1].blocks, fit);
    parts[2] = {prefix + "-identifiability", "What the data determine" + of, {}};
    parts[2].blocks = identifiability_blocks(fit, prefix);
    parts[3] = {prefix + "-material", "What the fit is good for" + of, {}};
    add_moduli(parts[3].blocks, fit, prefix);
    add_surrogate(parts[3].blocks, fit, prefix);
    // Of several fits each is a chapter, lest there be more chapters than one can choose from.
    for (std::size_t k = 1; data.fits.size() > 1 && k < parts.size(); ++k)
      std::ranges::move(std::exchange(parts[k].blocks, {}), std::back_inserter(parts[0].blocks));
    for (Chapter& part : parts) chapters.push_back(std::move(part));
  }
  return chapters;
}

std::string fit_answer(const Fit& fit) {
  std::vector<std::string> estimates;
  for (const FitParameter& one : fit.parameters) estimates.push_back(estimate_words(one));
  if (estimates.empty()) return "The fit gives no parameters.";
  double worst = meshes::unknown, left_out = meshes::unknown;
  for (const FitCurve& curve : fit.curves) {
    worst = std::fmax(worst, curve.worst);
    left_out = std::fmax(left_out, curve.left_out_error);
  }
  std::string text =
      fmt::format("The model{}, fitted to {} {}, has ", fit.model.empty() ? "" : " " + fit.model,
                  fit.curves.size(), fit.curves.size() == 1 ? "curve" : "curves");
  text += enumerate(estimates) + ".";
  if (std::isfinite(worst))
    text += fmt::format(" The worst residual is {} of what was measured", percent_magnitude(worst));
  if (std::isfinite(left_out))
    text += fmt::format("; of a curve that was left out, {}", percent_magnitude(left_out));
  if (std::isfinite(worst)) text += ".";
  if (!fit.file.unidentifiable.empty())
    text += " The data do not determine the answer: some change of the parameters is hardly seen.";
  return text;
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
    if (fit.file.empty()) continue;
    const bool measured =
        std::ranges::any_of(fit.curves, [](const FitCurve& curve) { return !curve.x.empty(); });
    need(measured, "Measured and fitted curves", "fit_data.csv");
    need(!fit.parameters.empty(), "Parameters", "calibration.json: parameters");
    if (fit.parameters.size() > 1) {
      need(!fit.file.singular_values.empty(), "Singular values",
           "calibration.json: singular_values");
      need(fit.file.profile.has_value(), "Profile likelihood", "calibration.json: profile");
    }
    if (fit.curves.size() > 1)
      need(std::ranges::any_of(
               fit.curves,
               [](const FitCurve& curve) { return std::isfinite(curve.left_out_error); }),
           "Curves left out one after the other", "calibration.json: curves: left_out");
    need(!fit.surrogate.empty(), "Surrogate", "surrogate.csv, surrogate.json");
  }
  if (data.study && data.transfer.empty())
    missing.push_back({"Predictions of the fits", "transfer.csv"});
  return missing;
}

}  // namespace fingertip::studies::reporting
