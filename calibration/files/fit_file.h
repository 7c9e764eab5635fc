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

#include "calibration/files/moduli_file.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline files {

/// What was known before.
struct PriorEntry {
  double mean = meshes::unknown, deviation = meshes::unknown;
};
constexpr auto fields_of(const PriorEntry*) {
  using meshes::named;
  using Whole = PriorEntry;
  return named("mean deviation", &Whole::mean, &Whole::deviation);
}

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
constexpr auto fields_of(const ParameterEntry*) {
  using meshes::named, meshes::newer;
  using Whole = ParameterEntry;
  return std::tuple_cat(named("name unit estimate standard_error lower upper at_bound",
                              &Whole::name, &Whole::unit, &Whole::estimate, &Whole::standard_error,
                              &Whole::lower, &Whole::upper, &Whole::at_bound),
                        newer(named("bound_of", &Whole::bound_of)),
                        named("start prior bias", &Whole::start, &Whole::prior, &Whole::bias),
                        newer(named("interval", &Whole::interval)));
}

/// Whether the data leave open what has `unit`: its 95 % interval exceeds it. A travel at touch, a
/// load cell's zero and what else a machine adds may well be zero and count by what they do to the
/// forces, which the directions of a fit tell.
inline bool is_open(std::string_view unit, double estimate, double lower, double upper) {
  const bool has_size = unit == "Pa" || unit == "N/m" || unit == "s" || unit == "1" || unit.empty();
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
constexpr auto fields_of(const ResidualStructure*) {
  using meshes::named;
  using Whole = ResidualStructure;
  return named("runs probability statement", &Whole::runs, &Whole::probability, &Whole::statement);
}

/// The fit without a curve, asked for it.
struct LeftOutEntry {
  std::vector<double> estimates;
  double worst_relative_error = meshes::unknown;
  std::string failure;
};
constexpr auto fields_of(const LeftOutEntry*) {
  using meshes::named, meshes::newer;
  using Whole = LeftOutEntry;
  return std::tuple_cat(
      named("estimates worst_relative_error", &Whole::estimates, &Whole::worst_relative_error),
      newer(named("failure", &Whole::failure)));
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
constexpr auto fields_of(const Repeats*) {
  using meshes::named;
  using Whole = Repeats;
  return named("curves factors factor_errors deviation probability travel mean scatter noise",
               &Whole::curves, &Whole::factors, &Whole::factor_errors, &Whole::deviation,
               &Whole::probability, &Whole::travel, &Whole::mean, &Whole::scatter, &Whole::noise);
}

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
constexpr auto fields_of(const LoadingHistory*) {
  using meshes::named;
  using Whole = LoadingHistory;
  return std::tuple_cat(named("rows noise", &Whole::rows, &Whole::noise),
                        newer(named("rows_per_value", &Whole::rows_per_value)),
                        named("loop", &Whole::loop), newer(named("play", &Whole::play)),
                        named("hold_time relaxation back_x back_y", &Whole::hold_time,
                              &Whole::relaxation, &Whole::back_x, &Whole::back_y),
                        newer(named("held_time held_y", &Whole::held_time, &Whole::held_y)));
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
constexpr auto fields_of(const CurveEntry*) {
  using meshes::named, meshes::newer;
  using Whole = CurveEntry;
  return std::tuple_cat(
      named("name condition", &Whole::name, &Whole::condition),
      newer(named("x_quantity y_quantity", &Whole::x_quantity, &Whole::y_quantity)),
      named("points worst_relative_residual rms_relative_residual structure left_out",
            &Whole::points, &Whole::worst_relative_residual, &Whole::rms_relative_residual,
            &Whole::structure, &Whole::left_out),
      newer(named("course", &Whole::course)));
}

/// A combination of parameters that data do not determine.
struct DirectionEntry {
  meshes::Entries<double> direction;
  double relative_singular_value = meshes::unknown, interval = meshes::unknown;
  std::string statement;
};
constexpr auto fields_of(const DirectionEntry*) {
  using meshes::named;
  using Whole = DirectionEntry;
  return named("direction relative_singular_value interval statement", &Whole::direction,
               &Whole::relative_singular_value, &Whole::interval, &Whole::statement);
}

/// Where a search ended.
struct MinimumEntry {
  std::vector<double> estimates;
  double loss = meshes::unknown;
  long iterations = 0;
  bool converged = false;
};
constexpr auto fields_of(const MinimumEntry*) {
  using meshes::named, meshes::newer;
  using Whole = MinimumEntry;
  return std::tuple_cat(
      named("estimates loss iterations", &Whole::estimates, &Whole::loss, &Whole::iterations),
      newer(named("converged", &Whole::converged)));
}

/// Rise of chi-square over two parameters.
struct ProfileEntry {
  std::string first, second;
  std::vector<double> first_values, second_values;
  std::vector<std::vector<double>> increase;
};
constexpr auto fields_of(const ProfileEntry*) {
  using meshes::named;
  using Whole = ProfileEntry;
  return named("first second first_values second_values increase", &Whole::first, &Whole::second,
               &Whole::first_values, &Whole::second_values, &Whole::increase);
}

/// A quantity of a rig in SI; of a fitted one its 95 % interval.
struct RigEntry {
  std::string of;
  bool fitted = false;
  double value = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
  std::optional<bool> given;  ///< false: nobody has stated it, and it is the default
};
constexpr auto fields_of(const RigEntry*) {
  using meshes::named, meshes::newer;
  using Whole = RigEntry;
  return std::tuple_cat(named("of fitted value lower upper", &Whole::of, &Whole::fitted,
                              &Whole::value, &Whole::lower, &Whole::upper),
                        newer(named("given", &Whole::given)));
}

/// What machines add to presses over their travel, per file or machine.
struct RigFile {
  std::vector<RigEntry> touch_offset, compliance, force_offset, drift;
};
constexpr auto fields_of(const RigFile*) {
  using meshes::named;
  using Whole = RigFile;
  return named("touch_offset compliance force_offset drift", &Whole::touch_offset,
               &Whole::compliance, &Whole::force_offset, &Whole::drift);
}

/// What freeing a number that the model of a fit leaves out would do (statistics/score_tests.h).
struct ScoreTest {
  std::string name, of, cause, unit;
  double amount = 0.0;        ///< the number then, in `unit`
  double decrease = 0.0;      ///< of chi-square; without sigma of squares over their variance
  double probability = 1.0;   ///< of at least that decrease if the number were 0
  std::string share_of = {};  ///< OmittedEffect::share_of; not in the file
};
constexpr auto fields_of(const ScoreTest*) {
  using meshes::named;
  using Whole = ScoreTest;
  return named("name of cause unit amount decrease probability", &Whole::name, &Whole::of,
               &Whole::cause, &Whole::unit, &Whole::amount, &Whole::decrease, &Whole::probability);
}

/// What a further measurement would make of a parameter's 95 % interval.
struct NarrowedEntry {
  std::string name;
  double lower = meshes::unknown, upper = meshes::unknown, times = meshes::unknown;
};
constexpr auto fields_of(const NarrowedEntry*) {
  using meshes::named;
  using Whole = NarrowedEntry;
  return named("name lower upper times", &Whole::name, &Whole::lower, &Whole::upper, &Whole::times);
}

/// A further measurement, and what it would tell.
struct NextEntry {
  std::string name, press;
  std::vector<NarrowedEntry> parameters;
  std::string failure;
};
constexpr auto fields_of(const NextEntry*) {
  using meshes::named;
  using Whole = NextEntry;
  return named("name press parameters failure", &Whole::name, &Whole::press, &Whole::parameters,
               &Whole::failure);
}

/// What a parameter is with another contact.
struct OtherEstimate {
  std::string name;
  double estimate = meshes::unknown, lower = meshes::unknown, upper = meshes::unknown;
};
constexpr auto fields_of(const OtherEstimate*) {
  using meshes::named;
  using Whole = OtherEstimate;
  return named("name estimate lower upper", &Whole::name, &Whole::estimate, &Whole::lower,
               &Whole::upper);
}

/// Where the contact is not known: the one that was taken, and the fit with the other.
struct ContactEntry {
  std::string taken, other;
  double chi_square = meshes::unknown, residual_deviation = meshes::unknown;  ///< with the other
  std::vector<OtherEstimate> parameters;
};
constexpr auto fields_of(const ContactEntry*) {
  using meshes::named;
  using Whole = ContactEntry;
  return named("taken other chi_square residual_deviation parameters", &Whole::taken, &Whole::other,
               &Whole::chi_square, &Whole::residual_deviation, &Whole::parameters);
}

/// Where the result may be used.
struct ValidityEntry {
  double largest_strain_measure = meshes::unknown, spacing = meshes::unknown,
         poissons_ratio = meshes::unknown;
  std::string model, kinematics;
};
constexpr auto fields_of(const ValidityEntry*) {
  using meshes::named;
  using Whole = ValidityEntry;
  return named("largest_strain_measure spacing poissons_ratio model kinematics",
               &Whole::largest_strain_measure, &Whole::spacing, &Whole::poissons_ratio,
               &Whole::model, &Whole::kinematics);
}

/// surrogate.json: force and stiffness at the knots of a spline.
struct SurrogateFile {
  std::vector<double> knots, force, stiffness, band;
  std::string statement, condition;
  std::map<std::string, std::string> units;

  bool empty() const { return knots.empty(); }
};
constexpr auto fields_of(const SurrogateFile*) {
  using meshes::named;
  using Whole = SurrogateFile;
  return named("knots force stiffness band statement condition units", &Whole::knots, &Whole::force,
               &Whole::stiffness, &Whole::band, &Whole::statement, &Whole::condition,
               &Whole::units);
}

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
  std::vector<NextEntry> next;
  std::optional<ContactEntry> contact;
  std::vector<Repeats> repeats;
  std::string statement;

  bool empty() const { return problem.empty(); }
};
constexpr auto fields_of(const FitFile*) {
  using meshes::named, meshes::newer;
  using Whole = FitFile;
  return std::tuple_cat(
      named("problem model spacing constants damping target", &Whole::problem, &Whole::model,
            &Whole::spacing, &Whole::constants, &Whole::damping, &Whole::target),
      newer(named("rubber", &Whole::rubber)),
      named("achieved forward parameters covariance correlation singular_values unidentifiable "
            "only_from_priors degrees_of_freedom chi_square chi_square_probability birge_ratio",
            &Whole::achieved, &Whole::forward, &Whole::parameters, &Whole::covariance,
            &Whole::correlation, &Whole::singular_values, &Whole::unidentifiable,
            &Whole::only_from_priors, &Whole::degrees_of_freedom, &Whole::chi_square,
            &Whole::chi_square_probability, &Whole::birge_ratio),
      newer(named("model_error converged poissons_ratio_bound", &Whole::model_error,
                  &Whole::converged, &Whole::poissons_ratio_bound)),
      named("residual_deviation minima x_quantity y_quantity curves residuals influence profile "
            "iterations evaluations wall_time validity",
            &Whole::residual_deviation, &Whole::minima, &Whole::x_quantity, &Whole::y_quantity,
            &Whole::curves, &Whole::residuals, &Whole::influence, &Whole::profile,
            &Whole::iterations, &Whole::evaluations, &Whole::wall_time, &Whole::validity),
      newer(named("failed rig lack_of_fit next contact repeats", &Whole::failed, &Whole::rig,
                  &Whole::lack_of_fit, &Whole::next, &Whole::contact, &Whole::repeats)),
      named("statement", &Whole::statement));
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
