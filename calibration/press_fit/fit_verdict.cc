/// Whether a fit passed its own tests.
#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "calibration/press_fit/fit_record.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"
#include "meshes/rubber/plausible.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;

namespace {

using Sentences = std::vector<std::string>;

/// A curve missed by more than this share, by relative_rms, is not described, whatever its noise.
constexpr double largest_misfit = 0.1;

void judge_misfit(Sentences& found, const FitRecord& record) {
  const CurveFit& fit = record.fit;
  if (fit.birge_ratio > 1.0)
    found.push_back("the model does not describe the data: chi-square is " +
                    rounded(*fit.chi_square, 3) + " at " + std::to_string(fit.degrees_of_freedom) +
                    " degrees of freedom, probability " + rounded(*fit.chi_square_probability, 2));
  if (record.errors && record.errors->misfit > largest_misfit)
    found.push_back("the model does not describe the data: it misses " +
                    percent(record.errors->misfit) + " of them beyond noise (" +
                    std::string(name_of_relative_rms) + ", at most " + percent(largest_misfit) +
                    ")");
  if (fit.chi_square_probability || record.errors) return;
  for (std::size_t c = 0; c < record.curves.size(); ++c) {
    const Curve& curve = record.curves[c];
    if (auto sentence = missed("the model", curve.name, own_residuals(record, c), values_of(curve),
                               largest_misfit))
      found.push_back(*std::move(sentence));
  }
}

/// What a file must show of its largest force before it contradicts a touch.
constexpr double shown_share = 0.01, shown_noises = 4.0;

/// What the load cell tells of a curve without load [N].
double zero_of(const FitRecord& record, const Curve& curve) {
  for (const RigValue& value : record.rig)
    if (value.quantity == MaterialParameter::force_offset && value.of == curve.name)
      return value.place ? record.fit.estimates(Index(*value.place)) : value.held;
  return 0.0;
}

/// A touch before a file's first row says that the finger was pressed there already: a force that
/// the file must show, at least half of it.
void judge_touch(Sentences& found, const FitRecord& record) {
  const CurveFit& fit = record.fit;
  for (const RigValue& value : record.rig) {
    if (value.quantity != MaterialParameter::touch_offset || !value.place) continue;
    const auto curve = std::ranges::find(record.curves, value.of, &Curve::name);
    if (curve == record.curves.end() || curve->x.empty()) continue;
    const double touch = fit.estimates(Index(*value.place)), zero = zero_of(record, *curve),
                 measured = curve->y.front() - zero,
                 pressed = measured - fit.residuals[std::size_t(curve - record.curves.begin())](0),
                 largest = *std::ranges::max_element(curve->y) - zero;
    if (touch >= curve->x.front() || measured > 0.5 * pressed || pressed < shown_share * largest ||
        pressed < shown_noises * curve->course.noise)
      continue;
    found.push_back(fit.labels[*value.place] + " = " + quantity_text(touch, "m", 3) +
                    " lies before the first row of " + curve->name + ", " +
                    quantity_text(curve->x.front(), "m", 3) + ", where the model has " +
                    quantity_text(pressed, "N", 2) + " (" + percent(pressed / largest) +
                    " of the largest) and " + quantity_text(measured, "N", 2) +
                    " were measured: obstacle, shape or law are others, or the load cell was "
                    "zeroed under load (rig: force_offset = \"fit\")");
  }
}

/// Of the loading's work, and of its error: less of a loop is friction of a machine, or noise.
constexpr double min_gain = 0.02, gain_errors = 3.0;

/// A way back above the loading gives more work than was done, which no rubber does: position and
/// force do not belong together, and nothing says that they do on the way down. The area between n
/// rows there and back over the travel s errs by 2 s noise/sqrt(n).
void judge_unloading(Sentences& found, const FitRecord& record) {
  for (const Curve& curve : record.curves) {
    const LoadingHistory& course = curve.course;
    if (!(course.loop < -min_gain)) continue;
    const double force = *std::ranges::max_element(curve.y) - curve.y.front(),
                 error = 2.0 * (curve.x.back() - curve.x.front()) * course.noise /
                         std::sqrt(double(course.rows));
    if (course.play * force < gain_errors * error) continue;
    found.push_back(curve.name + ": the way back lies above the loading by " +
                    percent(-course.loop) +
                    " of its work: not the rubber, which gives back no more than it took, but " +
                    quantity_text(course.play, "m", 2) +
                    " of play or lag of the machine's travel. Mend it; where it is known to arise "
                    "at the turn alone, choose the loading in a TOML file (rows = [first, last])");
  }
}

void judge_bounds(Sentences& found, const FitRecord& record) {
  const CurveFit& fit = record.fit;
  if (fit.poissons_ratio_bound) {
    found.push_back("Poisson's ratio ended at a bound, " + rounded(*fit.poissons_ratio_bound, 5) +
                    ": the data do not tell it; hold it (parameters: modulus, with the rubber's "
                    "ratio), or widen its range where such a rubber is possible");
    return;
  }
  // Noise makes an estimate negative where there is none: twice the interval lies below zero.
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    if (fit.parameters[i] == MaterialParameter::compliance &&
        (2.0 * fit.upper(Index(i)) < fit.estimates(Index(i)) ||
         (fit.at_bound[i] && fit.estimates(Index(i)) < 0.0)))
      found.push_back(fit.labels[i] + " = " +
                      quantity_text(fit.estimates(Index(i)), unit(fit.parameters[i])) +
                      " is below zero, which no machine has: the force grows faster with depth "
                      "than the model's (sticking, a law that stiffens, another obstacle or "
                      "shape); hold the compliance, and mend that");
    else if (fit.at_bound[i])
      found.push_back(fit.labels[i] + " ended at a bound, " +
                      quantity_text(fit.estimates(Index(i)), unit(fit.parameters[i])));
}

/// Half of what elastic solids have, -1 to 1/2.
constexpr double whole_ratio = 0.75;

/// Whether what changes most along it is a branch of the relaxation.
bool is_of_branches(const CurveFit& fit, const Direction& direction) {
  Index most = 0;
  direction.changes.cwiseAbs().maxCoeff(&most);
  return is_of_the_relaxation(fit.parameters[std::size_t(most)]);
}

void judge_identifiability(Sentences& found, const FitRecord& record) {
  const CurveFit& fit = record.fit;
  if (fit.poissons_ratio_bound) return;
  std::string remedy =
      fit.poissons_ratio_error
          ? ": hold Poisson's ratio (parameters: modulus), give a prior, or add a curve of another "
            "contact"
          : ": hold what is known, of the machine by calibration.rig, give a prior, or add a press "
            "against another obstacle or a rigid blank";
  if (std::ranges::any_of(fit.unidentifiable,
                          [&](const Direction& each) { return is_of_branches(fit, each); }))
    remedy =
        ": free fewer branches of the relaxation, hold those that are known (rubber.relaxation), "
        "or "
        "measure a longer hold after a faster ramp";
  const double width = poissons_ratio_interval(fit);
  // Of a measured press a modulus may be off by two; what of its machine is open costs width alone.
  const auto leaves_open = [&](const Direction& each) {
    return !record.errors || is_of_branches(fit, each) || width > open_ratio;
  };
  if (std::ranges::none_of(fit.unidentifiable, leaves_open)) return;
  const std::string told =
      width <= open_ratio ? "every parameter (" + std::to_string(fit.unidentifiable.size()) +
                                " direction" + (fit.unidentifiable.size() > 1 ? "s" : "") + " open)"
                          : "Poisson's ratio (95 %: " +
                                (width <= whole_ratio ? "+-" + rounded(width, 2)
                                                      : "wider than -1 to 1/2, all there is") +
                                "), and so not E and G one by one";
  found.push_back("the data do not determine " + told + remedy);
}

/// What is told of the presses against what makes the data far likelier.
void judge_told(Sentences& found, const FitRecord& record) {
  if (record.rivals.empty() || !record.rivals.front().contradicts()) return;
  const RivalEntry& rival = record.rivals.front();
  found.push_back("the data contradict " + rival_words(record, rival) + ": " +
                  (rival.name == contact_rival
                       ? "look how the rubber touches, and tell that"
                       : "measure it, or tell how well it is known (calibration.tolerances)"));
}

/// What was known of the machine contradicts what the data say, beyond what they leave open.
void judge_priors(Sentences& found, const FitRecord& record) {
  constexpr double widths = 3.0;
  const CurveFit& fit = record.fit;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const auto& prior = record.options.free[i].prior;
    if (!prior || !is_of_the_rig(fit.parameters[i])) continue;
    const double away = std::abs(fit.estimates(Index(i)) - prior->mean);
    if (away <= widths * std::hypot(prior->deviation, fit.standard_errors(Index(i)))) continue;
    const std::string unit_text(unit(fit.parameters[i])), name_text(name(fit.parameters[i]));
    found.push_back(fit.labels[i] + " = " + quantity_text(fit.estimates(Index(i)), unit_text, 3) +
                    " is " + rounded(away / prior->deviation, 2) +
                    " standard deviations from what was known of it, " +
                    quantity_text(prior->mean, unit_text, 3) + " +- " +
                    quantity_text(prior->deviation, unit_text, 2) +
                    ": measure it (of a machine by a rigid blank), or let the fit seek it: "
                    "calibration.rig = {" +
                    name_text + " = \"fit\"}");
  }
}

void judge_material(Sentences& found, const FitRecord& record) {
  for (const meshes::Violation& violation : record.material.violations())
    found.push_back("the estimates are no rubber: " + to_string(violation));
  const std::string modulus = meshes::implausible_modulus(record.material.rubber.youngs_modulus);
  if (record.problem != "damping" && !modulus.empty()) found.push_back(modulus);
}

}  // namespace

double poissons_ratio_interval(const CurveFit& fit) {
  if (!fit.poissons_ratio_error) return 0.0;
  // Half width over a standard error, the same for all parameters.
  const double quantile = (fit.upper(0) - fit.lower(0)) / (2.0 * fit.standard_errors(0));
  return quantile * *fit.poissons_ratio_error;
}

std::vector<std::string> failed_tests(const FitRecord& record) {
  Sentences found;
  const CurveFit& fit = record.fit;
  if (!fit.converged)
    found.push_back(
        "the search did not end within " + std::to_string(fit.evaluations) +
        (fit.evaluations == 1 ? " evaluation" : " evaluations") +
        ", and the estimates are the best seen so far: allow more (calibration.evaluations), free "
        "fewer parameters, or leave out depths that the model does not resolve");
  judge_told(found, record);
  judge_misfit(found, record);
  judge_touch(found, record);
  judge_unloading(found, record);
  judge_bounds(found, record);
  judge_identifiability(found, record);
  judge_material(found, record);
  judge_priors(found, record);
  return found;
}

}  // namespace fingertip::calibration::inline press_fit
