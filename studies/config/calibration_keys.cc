/// The keys of [calibration].
#include "studies/config/key_builders.h"
#include "studies/config/key_sections.h"

namespace fingertip::studies {

std::string_view name(CalibrationProblem problem) {
  switch (problem) {
    case CalibrationProblem::moduli: return "moduli";
    case CalibrationProblem::curve: return "curve";
    case CalibrationProblem::experiment: return "experiment";
    case CalibrationProblem::finite_strain: return "finite-strain";
    case CalibrationProblem::damping: return "damping";
  }
  return "unknown";
}

std::string_view name(ForwardKind forward) {
  return forward == ForwardKind::lattice ? "lattice" : "continuum";
}

namespace {

/// A key whose value is one number, stored in a member of the order.
template <typename Number>
Key number(const char* key, Kind kind, const char* preset, Range range, const char* help,
           Number CalibrationOrder::*member) {
  return plain("calibration", key, kind, preset, range, help,
               [member](Config& config, const Value& value) {
                 config.calibration.*member = Number(value.number);
               });
}

Key flag(const char* key, const char* preset, const char* help, bool CalibrationOrder::*member) {
  return plain("calibration", key, Kind::boolean, preset, any, help,
               [member](Config& config, const Value& value) {
                 config.calibration.*member = value.number != 0.0;
               });
}

Key list(const char* key, const char* help, std::vector<std::string> CalibrationOrder::*member) {
  return plain(
      "calibration", key, Kind::texts, "[]", any, help,
      [member](Config& config, const Value& value) { config.calibration.*member = value.words; });
}

Key problem_key() {
  using enum CalibrationProblem;
  return choice(
      "calibration", "problem", "moduli",
      {{"moduli", "spring constants to Young's and shear modulus"},
       {"curve", "spring constants, bond and contact to the continuum's forces"},
       {"experiment", "Young's and shear modulus to measured forces"},
       {"finite-strain", "law A to measured stress and stretch, or shear"},
       {"damping", "the retardation time to loss factors, creep, a held ramp or a press"}},
      "what is fitted to what",
      assign_named(
          [](Config & config) -> auto& { return config.calibration.problem; },
          std::vector{moduli, curve, experiment, finite_strain, damping}));
}

Key data_key() {
  return with_rule(plain("calibration", "data", Kind::files, "[]", any,
                         "measured CSV files, a curve each, units in the header",
                         [](Config& config, const Value& value) {
                           config.calibration.data.assign(value.words.begin(), value.words.end());
                         }),
                   "for experiment, finite-strain and damping; paths are relative to this file",
                   {});
}

Key forward_key() {
  return choice("calibration", "forward", "lattice",
                {{"lattice", "the static lattice of [lattice], with exact derivatives"},
                 {"continuum", "continuum runs at several Poisson's ratios, interpolated"}},
                "what answers for the press in an experiment",
                [](Config& config, const Value& value) {
                  config.calibration.forward =
                      value.word == "lattice" ? ForwardKind::lattice : ForwardKind::continuum;
                });
}

Key range_key() {
  return with_rule(plain("calibration", "poisson_range", Kind::number_pair, "[0, 0.4999]",
                         {-0.99, 0.4999, true}, "Poisson's ratios between which is sought",
                         [](Config& config, const Value& value) {
                           config.calibration.poisson_range = value.numbers;
                         }),
                   "the lower one first; for experiment; the continuum, which is run at seven "
                   "ratios between, takes [0.25, 0.49] unless the range is given",
                   {});
}

}  // namespace

std::vector<Key> calibration_keys() {
  using Order = CalibrationOrder;
  return {
      problem_key(),
      data_key(),
      list("conditions",
           "settings of presses in place of [press], \"press.contact=stick; press.tilt=20 deg\", a "
           "curve each; none: the press itself",
           &Order::conditions),
      quantity("calibration", "depth", "0.15 cm", "m", positive,
               "largest indentation of the continuum's curves",
               [](Config& config) -> double& { return config.calibration.depth; }),
      number("points", Kind::integer, "6", {2, 200, true},
             "indentations of each of the continuum's curves", &Order::points),
      with_rule(list("parameters", "what is free; none: what the problem usually frees",
                     &Order::parameters),
                "youngs_modulus, shear_modulus: E and G; modulus: E, Poisson's ratio held; "
                "lame_shear, lambda: of law A; k1, k2, k3, kappa: of the lattice; bond, contact: "
                "factors on the ties; retardation_time. experiment and curve know all but the "
                "last, finite-strain the moduli and law A's, damping the last alone",
                {}),
      forward_key(),
      number("prior", Kind::number, "0.02", {0.0, 10.0, true},
             "relative standard deviation of constants about those of the moduli, ten times that "
             "for bond and contact; 0: no prior",
             &Order::prior),
      number("model_error", Kind::number, "0.01", {0.0, 1.0, true},
             "relative error a model of a curve may have, besides the continuum's own",
             &Order::model_error),
      number("robust_width", Kind::number, "0", {0.0, 1e6, true},
             "residuals beyond so many sigma count linearly; 0: least squares",
             &Order::robust_width),
      range_key(),
      plain("calibration", "evaluations", Kind::integer, "50", {1, 1000000, true},
            "evaluations of the model a search may do, a press of every curve each",
            [](Config& config, const Value& value) {
              config.calibration.evaluations = int(value.number);
            }),
      list("profile", "two free parameters to draw chi-square over, or none", &Order::profile),
      flag(
          "bias", "false",
          "run the continuum at the estimates, too, and tell what the lattice's error does to them",
          &Order::bias),
      flag("surrogate", "false", "write F(delta) and its derivative for gain schedules",
           &Order::surrogate),
      number("isotropy_weight", Kind::number, "0", {0.0, 1e6, true},
             "weight of isotropy beside E and G for central springs", &Order::isotropy_weight),
      number("bulk_weight", Kind::number, "0", {0.0, 1e6, true},
             "weight of the bulk modulus beside E and G for central springs", &Order::bulk_weight),
      number("starts", Kind::integer, "10", {1, 1000, true},
             "random starts of the fit to moduli; the best one is kept", &Order::starts),
      number("seed", Kind::integer, "1", {0, 4294967295.0, true}, "seed of the random starts",
             &Order::seed),
  };
}

}  // namespace fingertip::studies
