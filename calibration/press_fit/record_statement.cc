/// The plain words of a fit to curves.
#include <algorithm>
#include <cmath>

#include "calibration/files/fit_file.h"
#include "calibration/files/words.h"
#include "calibration/material/relaxation_branches.h"
#include "calibration/press_fit/fit_record.h"
#include "calibration/statistics/fit_statistics.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;

namespace {

/// Signs of residuals that chance makes less often than this are told.
constexpr double improbable = 0.01;
/// A minimum whose chi-square is within this of the least one is as good (95 %, one parameter).
constexpr double as_good = 3.84;

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
            quantity_text(fit.estimates(Index(i)), unit(parameter));
    const bool by_ratio = fit.poissons_ratio_bound && is_modulus(parameter);
    if (by_ratio) continue;
    const double lower = fit.lower(Index(i)), upper = fit.upper(Index(i));
    const bool open = is_open(unit(parameter), fit.estimates(Index(i)), lower, upper);
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

/// Known errors of the model are in every interval: what they alone make of the first one, where
/// that is most of it.
std::string known_errors(const FitRecord& record) {
  constexpr double most = 0.7;
  const CurveFit& fit = record.fit;
  const Eigen::MatrixXd& known = record.options.model_covariance;
  const double half = 0.5 * (fit.upper(0) - fit.lower(0));
  if (known.size() == 0 || !(half > 0.0)) return "";
  const Eigen::RowVectorXd influence = fit.influence.row(0);
  const double own =
      normal_95() * std::sqrt(std::max(0.0, influence.dot(known * influence.transpose())));
  if (own < most * half) return "";
  return " The interval of " + fit.labels[0] + " is mostly " + record.model_error + ": " +
         rounded(own, 2) + " of " + rounded(half, 2) + " " + std::string(unit(fit.parameters[0])) +
         " to either side.";
}

/// What of the residuals is noise, and what the model misses.
std::string errors(const FitRecord& record) {
  const ErrorsEntry& errors = *record.errors;
  std::string text = " Noise of a value: " + quantity_text(errors.noise, "N", 2);
  if (std::isfinite(errors.over_told))
    text += " (" + rounded(errors.over_told, 2) + " times what the files tell)";
  const std::string most = percent(errors.misfit_upper) + " of the force (95 %)";
  text += errors.misses()
              ? ". Beyond it the model misses " + percent(errors.misfit) + ", at most " + most +
                    ", by no chance; the intervals know that."
              : ". Beyond it nothing is seen; what the model may miss unseen, at most " + most +
                    ", is in the intervals.";
  for (const OddValue& each : record.odd) {
    const Curve& curve = record.curves[each.curve];
    text += " " + curve.name + ": the value " + quantity_text(curve.y[each.place], "N", 4) +
            " at " + quantity_text(curve.x[each.place], "m", 4) +
            " is far off all others and counts for nothing.";
  }
  return text + known_errors(record);
}

std::string misfit(const FitRecord& record) {
  const bool travel = std::ranges::any_of(record.curves, &Curve::is_travel);
  const double missed = relative_rms(
      stacked(record.own_residuals.empty() ? record.fit.residuals : record.own_residuals),
      all_values(record.curves));
  if (std::isnan(missed)) return " All data are zero: there is nothing to be met.";
  std::string text = " The fit meets the data within " + percent(missed) + " (" +
                     std::string(name_of_relative_rms) + "), every single value within " +
                     percent(worst_relative_residual(record)) +
                     (travel ? " of its curve's largest." : " of itself.");
  const CurveFit& fit = record.fit;
  if (record.errors) return text + errors(record);
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

/// What scatters between repeats is no error of the model.
std::string repeats(const FitRecord& record) {
  std::string text;
  for (const Repeats& group : record.repeats)
    if (group.deviation > 0.0)
      text += " The " + std::to_string(group.curves.size()) + " repeats of " +
              group.curves.front() + " differ by " + percent(group.deviation) +
              " (standard deviation of a factor on the force of each): what is found is that of "
              "their mean, and the intervals follow from so many.";
  return text;
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
      text += " " + fit.labels[i] + " = " +
              quantity_text(minimum.estimates(Index(i)), unit(fit.parameters[i]));
    return text + ".";
  }
  return "";
}

std::string structures(const FitRecord& record) {
  std::string text;
  if (record.errors) return text;
  for (std::size_t c = 0; c < record.curves.size(); ++c) {
    const ResidualStructure structure = structure_of(record, c);
    if (structure.probability < improbable)
      text += " " + record.curves[c].name + ": " + structure.statement + ".";
  }
  return text;
}

/// Less of the loading's work than this is friction of a machine, too.
constexpr double told_loop = 0.02;

/// Of a rubber that relaxes: its branches, what its moduli are, which of them the curves do not
/// tell.
std::string relaxation_words(const FitRecord& record) {
  const meshes::Relaxation& relaxation = record.material.rubber.relaxation;
  if (relaxation.empty()) return "";
  std::string text = " The rubber relaxes by";
  for (const meshes::RelaxationBranch& branch : relaxation.branches)
    text += std::string(&branch == relaxation.branches.data() ? " " : " and ") +
            percent(branch.share) + " in " + rounded(branch.time, 3) + " s";
  text += ": what is found holds after long times, at once it is " +
          rounded(relaxation.instantaneous_ratio(), 4) + " times stiffer.";
  if (!record.observed_times) return text;
  for (const std::string& open : open_branches(relaxation, *record.observed_times))
    text += " Not told by the data: " + open + ".";
  return text;
}

/// Loadings alone are fitted: what they hide of time is said whether they are met or not.
std::string loops(const FitRecord& record) {
  std::string text;
  for (const Curve& curve : record.curves) {
    if (!(curve.course.loop > told_loop) || !record.material.rubber.relaxation.empty()) continue;
    text += " " + curve.name + ": loading and unloading differ by a loop of " +
            percent(curve.course.loop) +
            " of the loading's work, usually because the rubber relaxes; what is found holds for "
            "this speed, and a rubber at rest is softer";
    text += curve.course.relaxation > 0.0
                ? " (by " + percent(curve.course.relaxation) + " in the longest hold)."
                : " (by how much a hold would tell).";
  }
  return text;
}

/// How many times the interval of parameter `i` would narrow by a rigid blank pressed to the same
/// forces, f = (x - x0)/c with a touch x0 of its own, which shows the compliance `j` alone.
double narrowed_by_blank(const FitRecord& record, Index i, Index j) {
  const CurveFit& fit = record.fit;
  const Eigen::VectorXd force = all_values(record.curves);
  Eigen::VectorXd deviation = Eigen::VectorXd::Constant(force.size(), fit.residual_deviation);
  for (std::size_t c = 0; c < record.curves.size(); ++c)
    if (const auto& sigma = record.curves[c].sigma; !sigma.empty())
      deviation.segment(first_value(record.curves, c), Index(sigma.size())) =
          Eigen::VectorXd::Map(sigma.data(), Index(sigma.size()));
  const Eigen::VectorXd weight = deviation.cwiseInverse();
  // A blank on a rigid machine has no travel at all: then the compliance is known.
  const double soft = std::max(std::abs(fit.estimates(j)), 1e-6 * fit.standard_errors(j));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(force.size(), fit.estimates.size());
  rows.col(j) = -force.cwiseProduct(weight) / soft;
  return 1.0 / narrowing(fit.covariance, rows, -weight / soft)(i);
}

/// Compliances take their share of a travel as a softer rubber does.
std::string collinearity(const FitRecord& record) {
  const CurveFit& fit = record.fit;
  std::string text;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
      const bool pair =
          is_of_the_rubber(fit.parameters[i]) && fit.parameters[j] == MaterialParameter::compliance;
      if (!pair || fit.parameters[i] == MaterialParameter::shear_modulus) continue;
      const double correlation = fit.correlation(Index(i), Index(j));
      const double times = 1.0 / std::sqrt(std::max(1e-12, 1.0 - correlation * correlation));
      if (times < much_wider) continue;
      text += " " + fit.labels[i] + " and " + fit.labels[j] +
              " are nearly collinear (correlation " + rounded(correlation, 3) +
              "): if the compliance were known, the interval of " + fit.labels[i] + " would be " +
              rounded(times, 2) +
              " times narrower. What tells them apart: a rigid blank in place of the finger, which "
              "shows the compliance alone (pressed to the same forces it would make the interval " +
              rounded(narrowed_by_blank(record, Index(i), Index(j)), 2) +
              " times narrower); a press against another obstacle; a deeper one.";
    }
  return text;
}

/// What nobody has told of a machine is unknown within what is usual.
std::string assumptions(const FitRecord& record) {
  std::string text;
  for (const RigValue& value : record.rig) {
    if (value.given || !value.place) continue;
    const auto& prior = record.options.free[*value.place].prior;
    if (!prior) continue;
    const std::string unit_text(unit(value.quantity));
    const double reach = 2.0 * prior->deviation,
                 low = value.quantity == MaterialParameter::compliance ? 0.0 : prior->mean - reach;
    text += (text.empty() ? " Nobody tells " : "; ") + record.fit.labels[*value.place] + ": " +
            quantity_text(low, unit_text, 2) + " to " +
            quantity_text(prior->mean + reach, unit_text, 2) + " (95 %) counts as possible";
  }
  return text.empty() ? text : text + " (calibration.rig).";
}

/// What errors of sizes, place and Poisson's ratio do to the estimates: of those whose tolerance is
/// known, or of all others.
std::string sensitivities(const FitRecord& record, bool counting) {
  std::string text;
  for (const SensitivityEntry& each : record.sensitivities) {
    if (each.counts != counting) continue;
    // Of what is no size the step itself; a scale is 1 as described.
    const bool of_itself = each.value > 0.0 && (each.unit != "1" || each.value == 1.0);
    text += (text.empty() ? " " : "; ") +
            (of_itself ? percent(each.step / each.value) : quantity_text(each.step, each.unit, 2)) +
            " more of " + each.name + " would make";
    for (const auto& [parameter, change] : each.changes) {
      const auto place =
          std::ranges::find(record.fit.labels, parameter) - record.fit.labels.begin();
      const double relative = change / record.fit.estimates(place);
      text += " " + parameter + " " + percent(std::abs(relative)) +
              (relative < 0.0 ? " smaller" : " larger");
    }
  }
  if (text.empty()) return text;
  return text + (counting ? ", which the intervals hold."
                          : "; the intervals hold none of it "
                            "(calibration.tolerances).");
}

/// What intervals cover besides.
std::string rivals(const FitRecord& record) {
  std::string text;
  for (const RivalEntry& each : record.rivals)
    if (!each.contradicts())
      text += " They leave open " + rival_words(record, each) + ", which the intervals cover.";
  return text;
}

/// How much of it there would be: an absurd amount shows that it is not the cause.
std::string amount_of(const ScoreTest& each) {
  return each.unit == "1" ? percent(each.amount) + " of " + each.share_of
                          : quantity_text(each.amount, each.unit, 3);
}

/// What freeing the gravest effects would do, where the fit misses its data.
std::string lack_of_fit(const FitRecord& record) {
  constexpr double most = 0.5;  // of a misfit that known errors of the model can hide
  bool missed = record.errors ? record.errors->misses() || (!record.lack_of_fit.empty() &&
                                                            record.lack_of_fit[0].share > most)
                              : record.fit.birge_ratio > 1.0;
  if (!record.fit.chi_square_probability && !record.errors)
    for (std::size_t c = 0; c < record.curves.size(); ++c)
      missed = missed || structure_of(record, c).probability < improbable;
  if (!missed) return "";
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(record.lack_of_fit.size(), 3); ++i) {
    const ScoreTest& each = record.lack_of_fit[i];
    if (each.probability > by_no_chance) break;
    const std::string named = each.name + (each.of.empty() ? "" : " (" + each.of + ")");
    text += (i == 0 ? " What is missed looks most like " : "; then ") + named;
    if (std::isfinite(each.share))
      text += ", which alone would take away " + percent(each.share) + " of the misfit (" +
              amount_of(each) + ": " + each.cause + ")";
    else
      text += " (" + each.cause + ")";
  }
  return text.empty() ? text : text + ".";
}

}  // namespace

std::string rival_words(const FitRecord& record, const RivalEntry& rival) {
  const double times = std::exp(rival.likelier);
  std::string text = rival.name + " = " + rival.told + ": with " + rival.instead + " they are " +
                     (times > 1e6 ? "over a million" : rounded(times, 2)) + " times likelier";
  for (std::size_t i = 0; i < rival.parameters.size(); ++i) {
    const OtherEstimate& each = rival.parameters[i];
    const std::string unit_text(unit(record.fit.parameters[i]));
    text += ", with " + each.name + " = " + quantity_text(each.estimate, unit_text) +
            " (95 %: " + quantity_text(each.lower, unit_text) + " to " +
            quantity_text(each.upper, unit_text) + ")";
  }
  return text;
}

std::string prediction_words(const PredictedEntry& entry) {
  if (!entry.failure.empty()) return entry.name + ", held back, is not foretold: " + entry.failure;
  const auto last = std::size_t(std::ranges::max_element(entry.foretold) - entry.foretold.begin());
  const double largest = entry.foretold[last];
  std::string text =
      entry.name + ", held back, is foretold within " + percent(entry.rms_relative) + " (" +
      std::string(name_of_relative_rms) + "), " + (entry.is_within() ? "inside" : "outside") +
      " its 95 % interval, which at its largest force is " +
      quantity_text(entry.lower[last], "N", 3) + " to " + quantity_text(entry.upper[last], "N", 3) +
      " about " + quantity_text(largest, "N", 3) + "; measured are " +
      quantity_text(entry.measured[last], "N", 3);
  if (!entry.is_within())
    text += " (of presses as foretold " + percent(entry.probability) + " stray so far)";
  text += ".";
  for (const EstimateEntry& each : entry.own)
    text += (&each == entry.own.data() ? " From its own values: " : "; ") + each.name + " = " +
            quantity_text(each.estimate, each.unit, 3);
  return entry.own.empty() ? text : text + ".";
}

std::string fit_statement(const FitRecord& record) {
  std::string text;
  for (const std::string& failed : failed_tests(record)) text += "Not accepted: " + failed + ". ";
  text += estimates(record.fit) + misfit(record) + repeats(record) + open_directions(record.fit) +
          other_minima(record.fit) + collinearity(record) + assumptions(record) +
          sensitivities(record, true) + sensitivities(record, false) + rivals(record) +
          structures(record) + relaxation_words(record) + loops(record) + lack_of_fit(record);
  for (const PredictedEntry& each : record.predicted) text += " " + prediction_words(each);
  const std::string next =
      gain_statement(record.next, record.fit.labels, rubber_parameters(record.fit));
  if (!next.empty()) text += " " + next;
  return text;
}

}  // namespace fingertip::calibration::inline press_fit
