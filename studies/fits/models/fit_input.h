/// Everything that a fit to curves depends on.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "calibration/press_fit/model_error.h"
#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "fem_reference/job/job.h"
#include "lattice/press/press_setup.h"
#include "studies/config/keys/config.h"
#include "studies/fits/models/travel.h"

namespace fingertip::studies::inline fits::inline models {

/// What answers for one curve.
enum class CurveKind {
  press,      ///< the static lattice
  continuum,  ///< run at the Poisson's ratios that the search comes near
  loss_factor,
  creep,
  ramp,          ///< a press to a depth, held: FitInput::presses' static lattice, damped
  moving_press,  ///< the moving lattice
};

/// The rows of a file that a curve's values begin with, as its `rows` counts them; from `first` on.
struct RowsOfValues {
  std::string file;
  std::size_t first = 1;
  std::vector<std::size_t> rows;
};

struct FitInput;

/// A measurement that might follow, of which the fit tells what it would tell.
struct Candidate {
  std::string name;        ///< "ball"
  std::string press = {};  ///< for people: contact, obstacle, depth
  double depth = 0.0;      ///< its largest indentation [m]
  bool blank = false;  ///< a rigid blank in place of the finger, pressed to the forces of the fit
  /// The press behind its rig, as the one curve of a fit of the same rubber; none: the first press
  /// of the fit itself, so that nothing is computed for it.
  std::shared_ptr<const FitInput> input = nullptr;
  std::string refused = {};  ///< why it cannot be; empty: it can
};

/// A curve of a fit and what answers for it. The continuum of a press answers for it, makes its
/// data (y is then still empty), or can judge the lattice.
struct FitCurve : calibration::Curve {
  FitCurve() = default;
  FitCurve(Curve curve) : Curve(std::move(curve)) {}

  CurveKind kind = CurveKind::press;
  std::string condition;                  ///< how it was pressed, for people
  lattice::PressSetup press;              ///< of presses
  fem_reference::ReferenceJob continuum;  ///< of presses
  /// Of presses over the travel of a machine, all of a fit or none. The samples of `press` and
  /// `continuum` then are Travel::depths.
  std::optional<Travel> travel;
  RowsOfValues rows;  ///< none where these are not measured
  /// Of a press that is held back: the curve of the fit whose further rows it is, with its touch
  /// and its zero.
  std::optional<std::size_t> continues;
  /// For each of FitInput::known_errors, how much it changes the force at every sample of its
  /// press, relative. Empty: not at all.
  std::vector<std::vector<double>> known_errors;
  /// Likewise, by how much a finite law exceeds the small-strain lattice that is fitted; empty
  /// where it is finite, and where one of the presses finds no equilibrium.
  std::vector<double> finite_excess;
};

/// An error of known size and unknown sign that all forces share: of the models, or of a number
/// that describes the presses.
struct KnownError {
  std::string name;  ///< for people: "what finite strain adds", "tip_radius"
  /// Of a number: which, of the presses where it is `value`, and its standard deviation, or of
  /// which step the changes are.
  std::optional<calibration::Described> number = std::nullopt;
  double value = 0.0, step = 0.0;
  double low = 0.0, high = 0.0;  ///< between which it may be anywhere, sqrt(12) steps apart
};

inline constexpr const char* finite_strain_error = "what finite strain adds";

/// SI.
struct FitInput {
  CalibrationProblem problem = CalibrationProblem::curve;
  std::vector<FitCurve> curves;
  /// Of a rubber that relaxes, with places among all free parameters; curves then have times and
  /// travels. The moduli, as of all presses here, are those after long times.
  std::vector<calibration::FitBranch> branches;
  lattice::PressSetup base;   ///< of the configuration: rubber and lattice that are not sought
  bool rubber_known = false;  ///< the data were made of base.rubber
  bool contact_told = false;  ///< of all presses, by somebody
  calibration::CurveFitOptions options;
  /// Poisson's ratios that are scanned for starts of E and G; none: options.free starts, its
  /// stiffness put to the data's scale where `scale_to_data`.
  std::vector<double> start_ratios;
  bool scale_to_data = false;
  /// What the lattices are known to miss goes into the covariance of the forces.
  bool with_lattice_error = false;
  std::vector<KnownError> known_errors;
  bool density_known = true, retardation_time_known = true;  ///< of base.rubber, for material.toml
  std::vector<std::string> profile;                          ///< two parameters, or none
  bool profile_intervals = false;                            ///< else those of the covariance
  std::string provenance, program;                           ///< for material.toml
  std::string place = "continuum";    ///< stem of the folders of the continua that answer
  /// The same fit with the presses that are held back: their curves stand behind those that are
  /// fitted, and so do parameters that only they have. None: there are none.
  std::shared_ptr<const FitInput> with_held_back;
  std::vector<Candidate> candidates;  ///< of presses; in the order of calibration.candidates
};

/// Whether the continuum answers for the curves.
bool by_continuum(const FitInput& input);

/// Whether a curve of this kind is forces of a press.
bool is_press(CurveKind kind);
/// Whether the curves are presses, and whether they go over the travel of a machine.
bool has_presses(const FitInput& input);
bool has_travels(const FitInput& input);

/// The curves alone.
std::vector<calibration::Curve> curves_of(const FitInput& input);

/// Of `input.options.free`, without those of rigs and relaxation, which stand behind them.
std::vector<calibration::MaterialParameter> parameters_of(const FitInput& input);

/// Whether it is among what is sought.
bool frees(const FitInput& input, calibration::MaterialParameter parameter);

/// Whether forces are a modulus times a function of Poisson's ratio, of the lattice's ties, too,
/// which are as stiff as its cells: few presses of every curve then tell everything.
bool seeks_moduli_alone(const FitInput& input);

/// Whether forces are proportional to all that is sought of the rubber: a press of every curve then
/// tells everything, whatever rig and relaxation.
bool asks_one_press(const FitInput& input);

}  // namespace fingertip::studies::inline fits::inline models
