/// Complete, resolved settings for every verb: what the key table's values add up to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/law_fit.h"
#include "calibration/moduli/moduli_fit.h"
#include "calibration/press_fit/model_error.h"
#include "fem_reference/job/job.h"
#include "lattice/control/control_settings.h"
#include "lattice/grasp/grasp.h"
#include "lattice/press/press_setup.h"
#include "meshes/base/names.h"
#include "studies/config/shapes/sensor_file.h"
#include "studies/config/shapes/solid_file.h"

namespace fingertip::studies::inline config::inline keys {

/// What the finger is (key geometry.shape).
enum class ShapeKind {
  dome,     ///< the paper's finger
  profile,  ///< a body of revolution from a file
  solid,    ///< a closed surface of triangles, or a CAD solid, from a file
};
using meshes::name, meshes::values;
constexpr auto names_of(ShapeKind) {
  using enum ShapeKind;
  return meshes::names<ShapeKind>({{dome, "dome"}, {profile, "profile"}, {solid, "solid"}});
}

/// Where the spring constants come from (key lattice.constants).
enum class ConstantsSource {
  automatic,   ///< published: its rule; central: fit; hookean, network: closed form
  rule,        ///< published and central: k = E a²/l0; hookean, network: closed form
  calibrated,  ///< fit to the rubber's moduli (central, hookean)
  file,        ///< a material.toml written by `calibrate`
};
constexpr auto names_of(ConstantsSource) {
  using enum ConstantsSource;
  return meshes::names<ConstantsSource>(
      {{automatic, "auto"}, {rule, "rule"}, {calibrated, "calibrated"}, {file, "file"}});
}

/// What `calibrate` fits (key calibration.problem).
enum class CalibrationProblem {
  moduli,      ///< constants to E and G of the rubber
  curve,       ///< constants and ties to the continuum's forces
  experiment,  ///< E and G, or constants, to measured forces
  damping,     ///< the retardation time
  material,    ///< laws of large strain to material tests
};
constexpr auto names_of(CalibrationProblem) {
  using enum CalibrationProblem;
  return meshes::names<CalibrationProblem>({{moduli, "moduli"},
                                            {curve, "curve"},
                                            {experiment, "experiment"},
                                            {damping, "damping"},
                                            {material, "material"}});
}

/// What answers for the press when parameters are varied (key calibration.forward).
enum class ForwardKind { lattice, continuum };
constexpr auto names_of(ForwardKind) {
  using enum ForwardKind;
  return meshes::names<ForwardKind>({{lattice, "lattice"}, {continuum, "continuum"}});
}

/// What is known beforehand of a quantity of a rig; SI.
struct RigSetting {
  bool fitted = false;
  double value = 0.0;      ///< where it is not fitted; the mean of its prior
  double deviation = 0.0;  ///< of the prior; 0: none
  bool given = false;      ///< by the user; else all of this is the default
};

/// The machine that measured a force against the travel of its crosshead (key calibration.rig).
struct RigSettings {
  RigSetting touch_offset{true};  ///< travel at first touch [m]
  /// [m/N]; unless given not below 0, and with this deviation, half of a normal distribution.
  RigSetting compliance{true, 0.0, 2e-5};
  RigSetting force_offset;      ///< [N]; unless given travel_of says what it may be
  RigSetting drift;             ///< of the force [N/s]; likewise
  std::filesystem::path blank;  ///< a press of a rigid blank, which tells the compliance; absolute
};

/// How well numbers are known that describe a press (key calibration.tolerances): standard
/// deviations, SI.
using Tolerances = std::vector<std::pair<calibration::Described, double>>;

/// What intervals of parameters are (key calibration.intervals).
enum class IntervalKind {
  automatic,  ///< profile where the models answer from what they know, else linear
  linear,     ///< of the covariance at the estimates
  profile,    ///< where chi-square, least over the other parameters, has risen
};
constexpr auto names_of(IntervalKind) {
  using enum IntervalKind;
  return meshes::names<IntervalKind>(
      {{automatic, "auto"}, {linear, "linear"}, {profile, "profile"}});
}

/// Section [calibration]; the key table says what the entries mean.
struct CalibrationSettings {
  CalibrationProblem problem = CalibrationProblem::moduli;
  std::vector<std::filesystem::path> data;  ///< absolute
  std::vector<std::string> conditions;      ///< "section.key=value; ..." per curve
  double depth = 1.5e-3;                    ///< [m]
  int points = 6;
  std::vector<std::string> parameters;  ///< empty: the problem's own
  ForwardKind forward = ForwardKind::lattice;
  RigSettings rig;
  Tolerances tolerances;
  std::string machine;       ///< files of one name share a compliance
  double noise = 0.01;       ///< relative, of forces that are planned
  double noise_force = 0.0;  ///< and whatever the force [N]
  /// Further measurements that a fit weighs: names of studies/fits/setup/fit_plan.h, or conditions.
  std::vector<std::string> candidates = {"repeat", "shallow", "deep",   "blank",
                                         "ball",   "plane",   "contact"};
  bool frame_held = false;        ///< that measured displacements; else its motion is fitted
  bool contact_as_given = false;  ///< else both contacts are fitted where none is given
  double prior = 0.02;            ///< relative; 0: none
  double model_error = 0.01;      ///< relative
  double robust_width = 0.0;
  std::vector<double> poisson_range = {0.0, 0.4999};  ///< lowest, highest
  std::vector<std::string> profile;
  IntervalKind intervals = IntervalKind::automatic;
  bool bias = false, surrogate = false;
  double isotropy_weight = 0.0, bulk_weight = 0.0;
  int starts = 10;
  int evaluations = 50;  ///< most that a search may do
  unsigned seed = 1;
  std::filesystem::path tests;    ///< what describes the material tests; absolute, empty for none
  std::vector<std::string> laws;  ///< of calibration::law_named; empty: all known_laws
  int branches = 3;               ///< most of a relaxation that is fitted
  calibration::TestWeights weights = calibration::TestWeights::test;
  std::vector<double> stretch_range = {0.5, 2.0};  ///< principal stretches of use
};

/// Who moves the rod in mode pid (key controller.type).
enum class ControllerKind {
  pid,       ///< lattice::PidController with the gains of [controller]
  adaptive,  ///< lattice::AdaptivePid
  force,     ///< lattice::ForceController
  hybrid,    ///< lattice::HybridController
  library,   ///< SharedObjectController (studies/control)
  socket,    ///< SocketController (studies/control)
};
constexpr auto names_of(ControllerKind) {
  using enum ControllerKind;
  return meshes::names<ControllerKind>({{pid, "pid"},
                                        {adaptive, "adaptive"},
                                        {force, "force"},
                                        {hybrid, "hybrid"},
                                        {library, "library"},
                                        {socket, "socket"}});
}

/// What of section [controller] goes beyond the PID. The stiffness schedules are empty here;
/// studies/presses/controller_choice.h reads the file.
struct ControllerSettings {
  ControllerKind kind = ControllerKind::pid;
  lattice::AdaptiveSettings adaptive;
  lattice::ForceSettings force;
  std::filesystem::path schedule;                 ///< absolute; empty for none
  std::filesystem::path library;                  ///< shared object, absolute; empty for none
  std::string address = "unix:fingertip.socket";  ///< where a socket is, see LocalAddress
  double timeout = 5.0;                           ///< for an answer over the socket [s]
  double connect_timeout = 60.0;                  ///< for the first client of the socket [s]
};

/// Coefficients of a law of large strain, as given; resolve_elasticity makes Rubber::energy of
/// them.
struct LawCoefficients {
  std::vector<double> yeoh, mooney_rivlin;  ///< [Pa]
  std::vector<double> ogden;                ///< mu [Pa], alpha, mu [Pa], alpha, ...
  std::optional<double> gent_jm, bulk_modulus;
};

/// The neo-Hookean law of the continuum by an older name (key reference.law).
enum class ContinuumLaw {
  a,  ///< the rubber's own
  b,  ///< VolumetricLaw::full_quadratic
  c,  ///< VolumetricLaw::isochoric_logarithmic
};
constexpr auto names_of(ContinuumLaw) {
  using enum ContinuumLaw;
  return meshes::names<ContinuumLaw>({{a, "A"}, {b, "B"}, {c, "C"}});
}

/// How a lattice's press finds the error of its forces.
enum class ForceErrorBy {
  automatic,  ///< from the continuum where that takes seconds, else estimated
  continuum,  ///< from the continuum, whatever it takes
  estimate,   ///< by lattice::ForceEstimator
  nothing,    ///< not at all
};
constexpr auto names_of(ForceErrorBy) {
  using enum ForceErrorBy;
  return meshes::names<ForceErrorBy>(
      {{automatic, "auto"}, {continuum, "continuum"}, {estimate, "estimate"}, {nothing, "off"}});
}

/// Section [exchange]: what is handed to another program.
struct ExchangeSettings {
  bool cube = false;            ///< a free cube instead of the fingertip
  int cells = 8;                ///< along its edge
  bool is_free = false;         ///< else the tip hangs on its rod
  bool has_wall = false;        ///< an elastic wall comes
  double wall_stiffness = 1.0;  ///< over that of an axis spring
  long steps = 1000;
  long every = 100;            ///< steps between frames; 0: none
  double agitation = 1e-4;     ///< random displacements at the start over the spacing
  std::optional<double> edge;  ///< of tetrahedra [m]; empty: as the finger's size asks for
};

/// SI throughout. The spring constants in `press.lattice` are empty until
/// `studies/presses/press_setup.h` resolves them.
struct Config {
  lattice::PressSetup press;
  ShapeKind shape = ShapeKind::dome;
  std::filesystem::path profile;   ///< absolute; only for ShapeKind::profile
  SolidFile solid;                 ///< only for ShapeKind::solid
  std::optional<double> endpoint;  ///< of a profile or solid, on the axis [m]
  ControllerSettings controller;
  TaxelLayout taxels;    ///< press.hardware.skin has them
  MarkerLayout markers;  ///< press.protocol has them
  ConstantsSource constants = ConstantsSource::automatic;
  std::filesystem::path constants_file;           ///< absolute; only for ConstantsSource::file
  std::optional<lattice::Kinematics> kinematics;  ///< as asked for; empty: the model's default
  std::vector<double> rotation;                   ///< of the grid about x, y, z in turn [rad]
  int lattice_modes = 10;                         ///< how many natural frequencies
  std::optional<double> spacing_divisor;          ///< a = R/divisor when given so
  bool automatic_spacing = true;                  ///< such that spacing_tolerance is kept
  double spacing_tolerance = 0.02;                ///< of the force, by lattice::ForceEstimator
  double max_particles = 1e5;                     ///< of an automatic spacing
  std::optional<double> poissons_ratio;           ///< when given so; press.rubber has E and G
  std::optional<double> shore_hardness;           ///< Shore A, when given instead of E
  std::filesystem::path card;                     ///< of the rubber's law; absolute, or empty
  LawCoefficients coefficients;                   ///< as given; press.rubber has the law
  /// Scaled masses where they keep to a press's force, else press.integrator as it stands.
  bool automatic_integrator = false;
  ForceErrorBy force_error = ForceErrorBy::automatic;
  ContinuumLaw continuum_law = ContinuumLaw::a;
  fem_reference::ReferenceJob reference;  ///< but for specimen and protocol, see continuum()
  CalibrationSettings calibration;
  ExchangeSettings exchange;
  lattice::GripSettings grip;
  lattice::BlockSettings block;
  double grasp_gravity = 9.80665;  ///< [m/s²]

  /// The continuum's job: `reference` on the press's specimen, pressed as the lattice is.
  fem_reference::ReferenceJob continuum() const {
    fem_reference::ReferenceJob job = reference;
    job.geometry = press.geometry;
    job.rubber = press.rubber;
    job.protocol = press.protocol;
    if (continuum_law != ContinuumLaw::a)
      job.rubber.energy.volumetric = continuum_law == ContinuumLaw::b
                                         ? meshes::VolumetricLaw::full_quadratic
                                         : meshes::VolumetricLaw::isochoric_logarithmic;
    return job;
  }
};

/// The model's own kinematics: published and network finite, central and hookean small.
inline lattice::Kinematics default_kinematics(lattice::ModelKind model) {
  using lattice::ModelKind;
  return model == ModelKind::published || model == ModelKind::network ? lattice::Kinematics::finite
                                                                      : lattice::Kinematics::small;
}

}  // namespace fingertip::studies::inline config::inline keys
