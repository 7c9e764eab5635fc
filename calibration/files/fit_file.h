/// calibration.json, of a fit to curves and, without a `problem`, to moduli (moduli_file.h);
/// surrogate.json. SI.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/files/displacement_fit_file.h"
#include "calibration/files/moduli_file.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline files {

/// What was known before.
struct PriorEntry {
  double mean = meshes::unknown, deviation = meshes::unknown;
};
FINGERTIP_FIELDS(PriorEntry, mean, deviation);

/// A free parameter, in `unit`.
struct ParameterEntry {
  std::string name, unit;
  double estimate = meshes::unknown, standard_error = meshes::unknown, lower = meshes::unknown,
         upper = meshes::unknown;
  bool at_bound = false;
  std::optional<std::string> bound_of;
  double start = meshes::unknown;
  std::optional<PriorEntry> prior;
  double bias = meshes::unknown;
  std::string interval;  ///< what it is: linear, profile, or either with both contacts
};
consteval auto fields_of(const ParameterEntry*) {
  return FINGERTIP_ALL_MEMBERS(ParameterEntry, name, unit, estimate, standard_error, lower, upper,
                               at_bound, bound_of, start, prior, bias, interval)
      .newer("bound_of interval");
}

/// Whether the data leave open what has `unit`: a modulus by more than a factor of two, another
/// size where its 95 % interval exceeds it. A travel at touch, a
/// load cell's zero and what else a machine adds may well be zero and count by what they do to the
/// forces, which the directions of a fit tell.
inline bool is_open(std::string_view unit, double estimate, double lower, double upper) {
  if (unit == "Pa") return !(2.0 * lower >= estimate && upper <= 2.0 * estimate);
  const bool has_size = unit == "N/m" || unit == "s" || unit == "1" || unit.empty();
  return has_size && !(upper - lower <= 2.0 * std::abs(estimate));
}

/// What the runs test says of a curve's residuals.
struct ResidualStructure {
  long runs = 0;  ///< stretches of one sign; residuals of exactly zero do not count
  /// Of so few runs or fewer, were the signs in random order: the exact distribution of Wald and
  /// Wolfowitz (1940) given how many are positive and negative. Where all have one sign, which says
  /// nothing of order: 2^(1-n), as for signs that are drawn independently. 1 for less than two.
  double probability = 1.0;
  std::string statement;
};
FINGERTIP_FIELDS(ResidualStructure, runs, probability, statement);

/// The fit without a curve, asked for it.
struct LeftOutEntry {
  std::vector<double> estimates;
  double worst_relative_error = meshes::unknown;
  std::string failure;
};
consteval auto fields_of(const LeftOutEntry*) {
  return FINGERTIP_ALL_MEMBERS(LeftOutEntry, estimates, worst_relative_error, failure)
      .newer("failure");
}

/// Repeats of one press, two or more curves of the same finger, pressed in the same way; an entry
/// per repeat where nothing else is said. SI.
struct Repeats {
  std::vector<std::string> curves;
  /// Force of the repeat over that of the fit, its touch, zero and drift fitted for itself, and the
  /// standard error that the residuals yield.
  std::vector<double> factors, factor_errors;
  /// Standard deviation of the factors between repeats beyond their errors, by the method of
  /// moments (DerSimonian & Laird, Controlled Clinical Trials 7, 177, 1986). 0: none is seen.
  double deviation = 0.0;
  /// That factors that are the same scatter as much (Cochran's Q is chi-square of n - 1).
  double probability = 1.0;
  /// At equal steps of the travel since touch that all have [m]: mean force, standard deviation
  /// between repeats, and that which the noise of their rows explains, NaN where unknown [N].
  std::vector<double> travel, mean, scatter, noise;
  std::vector<std::size_t> places = {};  ///< of the curves in the fit; not in the file
};
FINGERTIP_FIELDS_BUT((places), Repeats, curves, factors, factor_errors, deviation, probability,
                     travel, mean, scatter, noise);

/// What a file tells besides the values that are fitted; SI, NaN where unknown.
struct LoadingHistory {
  std::size_t rows = 0;            ///< of the file; 0: unknown
  double noise = meshes::unknown;  ///< standard deviation of a single row [y]
  double rows_per_value = 1.0;     ///< that were averaged
  /// Area between loading and unloading over the loading's work. Below 0 the way back lies above:
  /// no rubber gives work, it is the machine's play or lag, which shifts it by `play` [m].
  double loop = meshes::unknown, play = meshes::unknown;
  /// Of the longest hold under load: how long [s], and the share by which the force falls from that
  /// at the end of the loading; forces [y] over the time since then [s], thinned.
  double hold_time = meshes::unknown, relaxation = meshes::unknown;
  std::vector<double> held_time, held_y;
  std::vector<double> back_x, back_y;  ///< the unloading branch, thinned

  /// Of a value that is fitted, the mean of some rows.
  double noise_of_value() const { return noise / std::sqrt(std::max(1.0, rows_per_value)); }
};
consteval auto fields_of(const LoadingHistory*) {
  return FINGERTIP_ALL_MEMBERS(LoadingHistory, rows, noise, rows_per_value, loop, play, hold_time,
                               relaxation, back_x, back_y, held_time, held_y)
      .newer("rows_per_value play held_time held_y");
}

/// A curve of a fit.
struct CurveEntry {
  std::string name, condition, x_quantity, y_quantity;
  std::size_t points = 0;
  double worst_relative_residual = meshes::unknown, rms_relative_residual = meshes::unknown;
  ResidualStructure structure;
  std::optional<LeftOutEntry> left_out;
  std::optional<LoadingHistory> course;
};
consteval auto fields_of(const CurveEntry*) {
  return FINGERTIP_ALL_MEMBERS(CurveEntry, name, condition, x_quantity, y_quantity, points,
                               worst_relative_residual, rms_relative_residual, structure, left_out,
                               course)
      .newer("x_quantity y_quantity course");
}

/// A combination of parameters that data do not determine.
struct DirectionEntry {
  meshes::Entries<double> direction;
  double relative_singular_value = meshes::unknown, interval = meshes::unknown;
  std::string statement;
};
FINGERTIP_FIELDS(DirectionEntry, direction, relative_singular_value, interval, statement);

/// Where a search ended.
struct MinimumEntry {
  std::vector<double> estimates;
  double loss = meshes::unknown;
  long iterations = 0;
  bool converged = false;
};
consteval auto fields_of(const MinimumEntry*) {
  return FINGERTIP_ALL_MEMBERS(MinimumEntry, estimates, loss, iterations, converged)
      .newer("converged");
}

/// Rise of chi-square over two parameters.
struct ProfileEntry {
  std::string first, second;
  std::vector<double> first_values, second_values;
  std::vector<std::vector<double>> increase;
};
FINGERTIP_FIELDS(ProfileEntry, first, second, first_values, second_values, increase);

/// A quantity of a rig in SI; of a fitted one its 95 % interval.
struct RigEntry {
  std::string of;
  bool fitted = false;
  double value = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
  std::optional<bool> given;  ///< false: nobody has stated it, and it is the default
};
consteval auto fields_of(const RigEntry*) {
  return FINGERTIP_ALL_MEMBERS(RigEntry, of, fitted, value, lower, upper, given).newer("given");
}

/// What machines add to presses over their travel, per file or machine.
struct RigFile {
  std::vector<RigEntry> touch_offset, compliance, force_offset, drift;
};
FINGERTIP_FIELDS(RigFile, touch_offset, compliance, force_offset, drift);

/// A misfit, or a decrease of it, that chance makes less often than this is told by the data.
inline constexpr double by_no_chance = 1e-3;

/// What freeing a number that the model of a fit leaves out would do (statistics/score_tests.h).
struct ScoreTest {
  std::string name, of, cause, unit;
  double amount = 0.0;        ///< the number then, in `unit`
  double decrease = 0.0;      ///< of chi-square; without sigma of squares over their variance
  double probability = 1.0;   ///< of at least that decrease if the number were 0
  double share = meshes::unknown;  ///< of the misfit that the decrease takes away
  std::string share_of = {};       ///< OmittedEffect::share_of; not in the file
};
consteval auto fields_of(const ScoreTest*) {
  return FINGERTIP_MEMBERS(ScoreTest, name, of, cause, unit, amount, decrease, probability, share)
      .newer("share");
}

/// How far measured forces are from those of the model, by its cause (statistics/value_errors.h).
struct ErrorsEntry {
  double noise = meshes::unknown;         ///< standard deviation of a value [y]
  double over_told = meshes::unknown;     ///< the noise over what the file tells; NaN: it does not
  double misfit = meshes::unknown;        ///< root mean square of the smooth part over the data's
  double misfit_upper = meshes::unknown;  ///< 95 % point of its deviation, relative to the forces
  double misfit_seen = 0.0;  ///< twice the log of how many times likelier the data are with it
  double scatter = meshes::unknown;  ///< deviation of factors between repeats; NaN: none
  double log_evidence = meshes::unknown;

  /// Chance alone makes this once in a hundred fits.
  bool misses() const { return misfit_seen > 6.0; }
};
FINGERTIP_FIELDS(ErrorsEntry, noise, over_told, misfit, misfit_upper, misfit_seen, scatter,
                 log_evidence);

/// What an error of a number that describes the presses does to the estimates.
struct SensitivityEntry {
  std::string name, unit;  ///< "tip_radius", "m"
  /// The number as described, and a step of it: a standard deviation where it counts.
  double value = meshes::unknown, step = meshes::unknown;
  bool counts = false;              ///< in the intervals
  meshes::Entries<double> changes;  ///< of the rubber's estimates, were it larger by the step
};
FINGERTIP_FIELDS(SensitivityEntry, name, unit, value, step, counts, changes);
/// An estimate in `unit`.
struct EstimateEntry {
  std::string name, unit;
  double estimate = meshes::unknown;
};
FINGERTIP_FIELDS(EstimateEntry, name, unit, estimate);

/// A press that was held back, beside what the fit foretells of it: lists have an entry per value.
struct PredictedEntry {
  std::string name, condition;
  std::vector<EstimateEntry> own;                           ///< of its machine, from its own values
  std::vector<double> x, measured, foretold, lower, upper;  ///< 95 %, of a value by itself
  double rms_relative = meshes::unknown;  ///< of measured - foretold over that of measured
  double within = meshes::unknown;        ///< share of values in their intervals
  /// That of presses as foretold one strays so far from it anywhere.
  double probability = meshes::unknown;
  std::string failure;  ///< why nothing is foretold

  bool is_within() const { return probability >= 0.05; }
};
FINGERTIP_FIELDS(PredictedEntry, name, condition, own, x, measured, foretold, lower, upper,
                 rms_relative, within, probability, failure);

/// What a further measurement would make of a parameter's 95 % interval.
struct NarrowedEntry {
  std::string name;
  double lower = meshes::unknown, upper = meshes::unknown, times = meshes::unknown;
};
FINGERTIP_FIELDS(NarrowedEntry, name, lower, upper, times);

/// A further measurement, and what it would tell.
struct NextEntry {
  std::string name, press;
  std::vector<NarrowedEntry> parameters;
  std::string failure;
};
FINGERTIP_FIELDS(NextEntry, name, press, parameters, failure);

/// What a parameter is with another contact.
struct OtherEstimate {
  std::string name;
  double estimate = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
};
FINGERTIP_FIELDS(OtherEstimate, name, estimate, lower, upper);

/// Where the contact is not known: the one that was taken, and the fit with the other.
struct ContactEntry {
  std::string taken, other;
  double chi_square = meshes::unknown, residual_deviation = meshes::unknown;  ///< with the other
  std::vector<OtherEstimate> parameters;
};
FINGERTIP_FIELDS(ContactEntry, taken, other, chi_square, residual_deviation, parameters);

/// Something that is told of the presses, and the fit with another in its place.
struct RivalEntry {
  /// "rod_radius", or where presses have several "rod_radius of 0.005"; "0.005 m", "0.00625 m"
  std::string name, told, instead;
  double likelier = meshes::unknown;  ///< log of how many times likelier the data are then
  std::vector<OtherEstimate> parameters;

  /// That it is so: one of a hundred presses is told wrongly.
  double probability() const { return 1.0 / (1.0 + 99.0 * std::exp(-likelier)); }
  bool counts() const { return probability() > 0.05; }
  bool contradicts() const { return probability() > 0.95; }
};
FINGERTIP_FIELDS(RivalEntry, name, told, instead, likelier, parameters);

/// Where the result may be used.
struct ValidityEntry {
  double largest_strain_measure = meshes::unknown, spacing = meshes::unknown,
         poissons_ratio = meshes::unknown;
  std::string model, kinematics;
};
FINGERTIP_FIELDS(ValidityEntry, largest_strain_measure, spacing, poissons_ratio, model, kinematics);

/// surrogate.json: force and stiffness at the knots of a spline.
struct SurrogateFile {
  std::vector<double> knots, force, stiffness, band;
  std::string statement, condition;
  std::map<std::string, std::string> units;

  bool empty() const { return knots.empty(); }
};
FINGERTIP_FIELDS(SurrogateFile, knots, force, stiffness, band, statement, condition, units);

/// calibration.json of a fit to curves.
struct FitFile {
  std::string problem, model;
  double spacing = meshes::unknown;
  FitConstants constants;
  DampingEntry damping;
  std::optional<RubberEntry> target;
  RubberEntry rubber;
  std::optional<AchievedEntry> achieved;
  std::string forward;
  std::vector<ParameterEntry> parameters;
  std::vector<std::vector<double>> covariance, correlation;
  std::vector<double> singular_values;
  std::vector<DirectionEntry> unidentifiable, only_from_priors;
  long degrees_of_freedom = 0;
  double chi_square = meshes::unknown, chi_square_probability = meshes::unknown,
         birge_ratio = meshes::unknown;
  std::optional<std::string> model_error;
  bool converged = true;
  double poissons_ratio_bound = meshes::unknown, residual_deviation = meshes::unknown;
  std::vector<MinimumEntry> minima;
  std::string x_quantity, y_quantity;
  std::vector<CurveEntry> curves;
  std::vector<std::vector<double>> residuals, influence;
  std::optional<ProfileEntry> profile;
  long iterations = 0, evaluations = 0;
  double wall_time = meshes::unknown;
  ValidityEntry validity;
  std::vector<std::string> failed;
  std::optional<RigFile> rig;
  std::vector<ScoreTest> lack_of_fit;
  std::optional<ErrorsEntry> errors;  ///< of measured presses
  std::vector<SensitivityEntry> sensitivities;
  std::vector<RivalEntry> rivals;  ///< that count, likeliest first
  std::vector<PredictedEntry> predicted;
  std::vector<NextEntry> next;
  std::optional<ContactEntry> contact;
  std::vector<Repeats> repeats;
  std::optional<DisplacementFitFile> displacements;  ///< measured beside the forces, or alone
  std::string statement;

  bool empty() const { return problem.empty(); }
};
consteval auto fields_of(const FitFile*) {
  return FINGERTIP_ALL_MEMBERS(
             FitFile, problem, model, spacing, constants, damping, target, rubber, achieved,
             forward, parameters, covariance, correlation, singular_values, unidentifiable,
             only_from_priors, degrees_of_freedom, chi_square, chi_square_probability, birge_ratio,
             model_error, converged, poissons_ratio_bound, residual_deviation, minima, x_quantity,
             y_quantity, curves, residuals, influence, profile, iterations, evaluations, wall_time,
             validity, failed, rig, lack_of_fit, errors, sensitivities, rivals, predicted, next,
             contact, repeats, displacements, statement)
      .newer(
          "rubber model_error converged poissons_ratio_bound failed rig lack_of_fit errors "
          "sensitivities rivals predicted next contact repeats displacements");
}

/// What a fit to moduli, which has no curves, has in common with others.
inline FitFile as_fit(const ModuliFile& moduli) {
  FitFile fit;
  fit.problem = "moduli";
  fit.model = moduli.model;
  fit.spacing = moduli.spacing;
  fit.constants = moduli.constants;
  fit.target = moduli.target;
  fit.achieved = moduli.achieved;
  fit.statement = moduli.statement;
  return fit;
}

}  // namespace fingertip::calibration::inline files
