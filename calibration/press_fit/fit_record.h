/// A fit to curves as it is kept: in plain words, as calibration.json and as fit_data.csv.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material/material.h"
#include "calibration/material/material_parameter.h"
#include "calibration/press_fit/repeats.h"
#include "calibration/statistics/curve.h"
#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/design.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/fit_result.h"
#include "calibration/statistics/posterior.h"
#include "calibration/statistics/score_tests.h"

namespace fingertip::calibration::inline press_fit {

/// A quantity of a rig, fitted or held.
struct RigValue {
  MaterialParameter quantity = MaterialParameter::touch_offset;
  std::string of;                    ///< the file or machine it belongs to
  double held = 0.0;                 ///< in the parameter's unit, where it is not fitted
  std::optional<std::size_t> place;  ///< among the parameters, where it is
  bool given = false;                ///< somebody has stated it; else it is the default
};

/// Everything that is told of a fit.
struct FitRecord {
  std::string problem;  ///< "curve", "experiment", "damping"
  std::string forward;  ///< "lattice", "continuum", "formula"
  /// What is known of the models' errors and stands in options.model_covariance, in words; empty:
  /// nothing.
  std::string model_error;
  Material material;                     ///< with the estimates put in
  std::optional<meshes::Rubber> target;  ///< where the data were made of a known rubber
  std::vector<Curve> curves;
  std::vector<std::string> conditions;  ///< a text per curve, may be empty
  CurveFitOptions options;
  CurveFit fit;
  std::vector<LeftOut> left_out;   ///< per curve, or none
  std::optional<Profile> profile;  ///< over these two:
  MaterialParameter profile_first{}, profile_second{};
  /// Of a rubber that relaxes: from the shortest to the longest time the curves tell of [s].
  std::optional<std::array<double, 2>> observed_times;
  std::vector<RigValue> rig;                     ///< of presses over travel
  std::vector<std::vector<double>> indentation;  ///< of their values, per curve [m]
  std::vector<SensitivityEntry> sensitivities;   ///< of the presses' sizes and place
  std::vector<RivalEntry> rivals;                ///< that count, likeliest first
  std::vector<ScoreTest> lack_of_fit;            ///< gravest first
  std::vector<PredictedEntry> predicted;         ///< presses that were held back
  std::vector<MeasurementGain> next;             ///< further measurements, best first
  std::vector<bool> profiled;         ///< per parameter: its interval is the profile's; or empty
  std::vector<Repeats> repeats;       ///< groups of curves
  std::optional<ErrorsEntry> errors;  ///< of measured presses
  double misfit_size = 0.0;  ///< deviation of what their model misses, relative; 0: not sought
  std::vector<OddValue> odd;
  /// Where repeats scatter, what each leaves with a factor of its own on its force; else empty.
  std::vector<Eigen::VectorXd> own_residuals;
  double wall_time = 0.0;  ///< [s]
};

/// Measured minus computed of a curve [y], of repeats that scatter with a factor of its own.
const Eigen::VectorXd& own_residuals(const FitRecord& record, std::size_t curve);

/// Order in the residuals of a curve, press by press of repeats: whitened by its own covariance
/// where sigma is given, so that known errors of the model, which keep their sign, are no sign of
/// something missed, nor is the order of another curve that shares them.
ResidualStructure structure_of(const FitRecord& record, std::size_t curve);

/// Standard deviation of every value of a curve by the covariance that chi-square divides by: of
/// sigma and the models' errors together [y]. Empty without sigma.
std::vector<double> total_sigma(const FitRecord& record, std::size_t curve);

/// Largest |measured - fitted| over |measured| of all curves, where that is not zero; over a travel
/// over the curve's largest.
double worst_relative_residual(const FitRecord& record);

/// RivalEntry::name of the contact between rubber and obstacle.
inline constexpr const char* contact_rival = "press.contact";

/// "rod_radius = 5 mm: with 6.25 mm they are 30 times likelier, and modulus = 120 kPa (95 %: ...)"
std::string rival_words(const FitRecord& record, const RivalEntry& rival);

/// What was found, how sure that is, what the data leave open and whether the model describes them.
std::string fit_statement(const FitRecord& record);

/// Of the parameters those that the press itself depends on; they stand first.
std::size_t rubber_parameters(const CurveFit& fit);

/// Half width of the 95 % interval of Poisson's ratio where E and G are sought; else 0.
double poissons_ratio_interval(const CurveFit& fit);

/// Why constants of this fit must not be used as they are, a sentence each; none: it passed its own
/// tests. It fails where the search did not end; where the model does not describe the data (of
/// measured presses more than a tenth of them is missed beyond noise, or they contradict what is
/// told of the presses (RivalEntry); else chi-square is improbable, below 1 %, or, where there is
/// none, a curve is missed by more than a tenth, relative_rms); where a parameter or Poisson's
/// ratio ended at a bound; where a quantity of a machine is farther from what was known of it than
/// three deviations of both; where the data leave a direction open, of E and G Poisson's ratio by
/// more than open_ratio; and where the material is no rubber: rules of Material, E outside of
/// meshes::implausible_modulus.
std::vector<std::string> failed_tests(const FitRecord& record);

/// "deep, held back, is foretold within 2.1 %, inside its 95 % interval, ...", a sentence or two.
std::string prediction_words(const PredictedEntry& entry);

/// calibration.json of the README, SI. Written atomically. Throws std::runtime_error when the file
/// cannot be written.
void write_fit_json(const FitRecord& record, const std::filesystem::path& file);

/// The columns of FitDataRow, SI; empty cells where unknown. As above.
void write_fit_data(const FitRecord& record, const std::filesystem::path& file);

}  // namespace fingertip::calibration::inline press_fit
