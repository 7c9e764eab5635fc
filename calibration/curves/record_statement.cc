/// The plain words of a fit to curves.
#include <algorithm>
#include <cmath>

#include "calibration/curves/fit_record.h"
#include "calibration/words.h"

namespace fingertip::calibration {

using Eigen::Index;

namespace {

/// Signs of residuals that chance makes less often than this are told.
constexpr double improbable = 0.01;
/// A minimum whose chi-square is within this of the least one is as good (95 %, one parameter).
constexpr double as_good = 3.84;

std::string with_unit(double value, MaterialParameter parameter) {
  const std::string_view symbol = unit(parameter);
  return rounded(value, 5) + (symbol == "1" ? "" : " " + std::string(symbol));
}

std::string ratio_text(const CurveFit& fit) {
  const auto estimate = [&](MaterialParameter parameter) {
    return fit.estimates(std::ranges::find(fit.parameters, parameter) - fit.parameters.begin());
  };
  const double ratio = estimate(MaterialParameter::youngs_modulus) /
                           (2.0 * estimate(MaterialParameter::shear_modulus)) -
                       1.0;
  const double width = poissons_ratio_interval(fit);
  if (!(width <= open_ratio)) return "is not determined by these data";
  return rounded(ratio, 3) + " +- " + rounded(width, 2);
}

std::string estimates(const CurveFit& fit) {
  std::string text;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const MaterialParameter parameter = fit.parameters[i];
    text += (text.empty() ? "" : "; ") + fit.labels[i] + " = " +
            with_unit(fit.estimates(Index(i)), parameter);
    const bool by_ratio = fit.poissons_ratio_bound && is_modulus(parameter);
    if (by_ratio) continue;
    const double lower = fit.lower(Index(i)), upper = fit.upper(Index(i));
    // What is of the rig may well be zero.
    const bool open =
        !is_of_the_rig(parameter) && upper - lower > 2.0 * std::abs(fit.estimates(Index(i)));
    text += fit.at_bound[i] ? " (at its bound)"
            : open          ? " (open: the 95 % interval exceeds it)"
                            : " (95 %: " + rounded(lower, 5) + " to " + rounded(upper, 5) + ")";
  }
  if (fit.poissons_ratio_bound)
    text += "; Poisson's ratio is at its bound, " + rounded(*fit.poissons_ratio_bound, 5) +
            ", so that E and G have no intervals of their own";
  else if (fit.poissons_ratio_error)
    text += "; Poisson's ratio " + ratio_text(fit);
  return text + ".";
}

std::string misfit(const FitRecord& record) {
  double squares = 0.0, total = 0.0;
  for (std::size_t c = 0; c < record.curves.size(); ++c) {
    squares += record.fit.residuals[c].squaredNorm();
    for (const double y : record.curves[c].y) total += y * y;
  }
  if (total == 0.0) return " All data are zero: there is nothing to be met.";
  std::string text = " The fit meets the data within " + percent(std::sqrt(squares / total)) +
                     " (root mean square), every single value within " +
                     percent(worst_relative_residual(record)) + ".";
  const CurveFit& fit = record.fit;
  if (!fit.chi_square || !fit.chi_square_probability) return text;
  text += " Chi-square is " + rounded(*fit.chi_square, 3) + " at " +
          std::to_string(fit.degrees_of_freedom) + " degrees of freedom";
  const std::string known =
      "the stated deviations" + (record.model_error.empty() ? "" : " and " + record.model_error);
  if (fit.birge_ratio > 1.0)
    return text + ": more than " + known + " explain (probability " +
           rounded(*fit.chi_square_probability, 2) +
           "). The model does not describe the data, or the deviations are too small; the "
           "intervals are wider by Birge's ratio, " +
           rounded(fit.birge_ratio, 2) + ".";
  return text + ", which " + known + " explain (probability " +
         rounded(*fit.chi_square_probability, 2) + ").";
}

std::string open_directions(const CurveFit& fit) {
  std::string text;
  for (const Direction& direction : fit.unidentifiable)
    text += " Not determined by the data: " + direction.statement + ".";
  for (const Direction& direction : fit.only_from_priors)
    text += " Known from the prior, not from the data: " + direction.statement + ".";
  return text;
}

std::string other_minima(const CurveFit& fit) {
  const auto best = std::ranges::min_element(fit.minima, {}, &Minimum::loss);
  for (const Minimum& minimum : fit.minima) {
    const bool same =
        (minimum.estimates - best->estimates).cwiseQuotient(best->estimates).cwiseAbs().maxCoeff() <
        0.01;
    if (same || 2.0 * (minimum.loss - best->loss) > as_good || !fit.chi_square) continue;
    std::string text = " Another answer describes the data as well:";
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
      text +=
          " " + fit.labels[i] + " = " + with_unit(minimum.estimates(Index(i)), fit.parameters[i]);
    return text + ".";
  }
  return "";
}

std::string structures(const FitRecord& record) {
  std::string text;
  for (std::size_t c = 0; c < record.curves.size(); ++c) {
    const ResidualStructure structure = structure_of(record, c);
    if (structure.probability < improbable)
      text += " " + record.curves[c].name + ": " + structure.statement + ".";
  }
  return text;
}

}  // namespace

std::string fit_statement(const FitRecord& record) {
  std::string text = estimates(record.fit) + misfit(record) + open_directions(record.fit) +
                     other_minima(record.fit) + structures(record);
  for (const std::string& failed : failed_tests(record)) text += " Not accepted: " + failed + ".";
  return text;
}

}  // namespace fingertip::calibration
