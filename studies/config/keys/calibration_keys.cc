/// The keys of [calibration].
#include "calibration/material_tests/law_model.h"
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

/// A key for a member of the settings.
template <typename T>
Key entry(const char* name, Range range, const char* help, T CalibrationSettings::*member) {
  return plain("calibration", name, range, help, at(&Config::calibration, member));
}

Key problem_key() {
  using enum CalibrationProblem;
  return choice(
      "calibration", "problem",
      {{"moduli", "spring constants to Young's and shear modulus"},
       {"curve", "spring constants, bond and contact to the continuum's forces"},
       {"experiment", "Young's and shear modulus to measured forces"},
       {"damping", "the retardation time to loss factors, creep, a held ramp or a press"},
       {"material", "laws of rubber at large strain to the material tests of calibration.tests"}},
      "what is fitted to what", at(&Config::calibration, &CalibrationSettings::problem));
}

Key data_key() {
  return with_rule(
      entry("data", any,
            "measured CSV files, units in the header, or TOML files that describe such: forces of "
            "presses, and displacements of points",
            &CalibrationSettings::data),
      "for experiment and damping; paths are relative to this file", {});
}

Key forward_key() {
  return choice(
      "calibration", "forward",
      {{"lattice", "the static lattice of [lattice], with exact derivatives"},
       {"continuum", "the continuum, run at the Poisson's ratios that the search comes near"}},
      "what answers for the press in an experiment",
      at(&Config::calibration, &CalibrationSettings::forward));
}

Key range_key() {
  return with_rule(
      entry("poisson_range", {-0.99, 0.4999, true}, "Poisson's ratios between which is sought",
            &CalibrationSettings::poisson_range),
      "the lower one first; for experiment", {});
}

Key candidates_key() {
  return with_rule(
      entry("candidates", any,
            "further measurements of which is told how they would narrow the intervals; []: none",
            &CalibrationSettings::candidates),
      "repeat, shallow (half as deep), deep (half as deep again), blank (a rigid one, for the "
      "compliance), ball, plane, contact (the other one), as far as the continuum presses them on "
      "its meridian; or conditions, \"obstacle.shape=sphere; obstacle.radius=5 mm\"",
      {});
}

/// Files with a column `position` know the travel of a machine only.
Key rig_key() {
  Key key;
  key.section = "calibration";
  key.name = "rig";
  key.kind = Kind::fields;
  key.preset = "{}";
  key.fields = {
      {"touch_offset", "m", "0.1 mm", "travel at first touch, of each file; fitted unless given"},
      {"compliance", "m/N", "0.1 mm/N",
       "of frame, load cell and grips; 0 to 0.04 mm/N (95 %) unless given"},
      {"force_offset", "N", "0.02 N",
       "what the load cell tells without load; within 0.2 % of the largest force (95 %) unless "
       "given, or as the rows before touch tell"},
      {"drift", "N/s", "0.001 N/s",
       "of that in the file's column time; within 0.2 % of the largest force in all unless given"},
      {"blank", "", "blank.csv",
       "a press of a rigid blank by this machine, whose line tells the compliance with its "
       "interval"}};
  key.help = "the machine of files that tell its travel in a column position";
  key.rule =
      "each is \"fit\", a quantity, or a quantity with its standard deviation before the fit, "
      "\"0.1 +- 0.02 mm/N\"; blank is a file, in place of compliance";
  key.assign = [](Config& config, const Value& value) {
    RigSettings& rig = config.calibration.rig = {};
    rig.blank = value.word;
    const std::pair<std::string_view, RigSetting*> entries[] = {{"touch_offset", &rig.touch_offset},
                                                                {"compliance", &rig.compliance},
                                                                {"force_offset", &rig.force_offset},
                                                                {"drift", &rig.drift}};
    for (std::size_t i = 0; i < value.words.size(); ++i)
      for (const auto& [name, setting] : entries)
        if (name == value.words[i])
          *setting = {value.numbers[3 * i] == 1.0, value.numbers[3 * i + 1],
                      value.numbers[3 * i + 2], true};
  };
  return key;
}

Key tolerances_key() {
  Key key;
  key.section = "calibration";
  key.name = "tolerances";
  key.kind = Kind::fields;
  key.preset = "{}";
  using calibration::Described;
  key.fields = {{"scale", "%", "1 %", "of the whole finger"},
                {"tip_radius", "m", "0.1 mm", "of a dome"},
                {"rod_radius", "m", "0.1 mm", "of a dome"},
                {"obstacle_radius", "m", "0.05 mm", "of what is curved"},
                {"obstacle_offset", "m", "0.2 mm", "of what is curved"},
                {"tilt", "rad", "1 deg", "of the finger against the obstacle"}};
  key.help = "how well sizes and place are known: standard deviations that widen the intervals";
  key.rule =
      "each is a quantity; those of Poisson's ratio: calibration.poisson_range. Without them is "
      "told what an error of each would do";
  key.assign = [](Config& config, const Value& value) {
    Tolerances& told = config.calibration.tolerances;
    told.clear();
    for (std::size_t i = 0; i < value.words.size(); ++i) {
      // Of "fit", or of a quantity with a deviation of its own, it is no number.
      const bool alone = value.numbers[3 * i] == 0.0;
      const Described what = *meshes::enumerator<Described>(value.words[i]);
      const double unit = what == Described::scale ? 0.01 : 1.0;
      told.emplace_back(what, alone ? unit * value.numbers[3 * i + 1] : meshes::unknown);
    }
  };
  return key;
}

}  // namespace

std::vector<Key> calibration_keys() {
  using Order = CalibrationSettings;
  const auto of_material = [](Key key) {
    return only_with("calibration.problem", {"material"}, std::move(key));
  };
  const auto of_experiment = [](Key key) {
    return only_with("calibration.problem", {"experiment"}, std::move(key));
  };
  return {
      problem_key(),
      data_key(),
      of_material(choice("calibration", "tests", {{"none", "only for material"}},
                         "TOML file that names and describes material tests, for material",
                         at(&Config::calibration, &Order::tests))),
      of_material(with_rule(
          entry("laws", any, "laws that are tried; none: all of them", &Order::laws),
          "neo-hookean, mooney-rivlin, gent, yeoh-2, yeoh-3, ogden-1, ogden-2, ogden-3; \"yeoh-2+"
          "prony-1\": with so many branches of a relaxation, not up to calibration.branches",
          {})),
      of_material(entry("branches", {0, calibration::max_branches, true},
                        "most branches of a relaxation, where tests are given in time",
                        &Order::branches)),
      of_material(choice("calibration", "weights",
                         {{"test", "the root mean square stress of each test"},
                          {"stress", "the same for all: small stresses count little"},
                          {"point", "the stress itself, at least 5 % of the test's largest"}},
                         "what a residual of a material test is divided by; a sigma goes before it",
                         at(&Config::calibration, &Order::weights))),
      of_material(entry("stretch_range", {0.05, 20.0, true},
                        "principal stretches of use, in which a law must be stable",
                        &Order::stretch_range)),
      entry("conditions", any,
            "settings of presses in place of [press], \"press.contact=stick; press.tilt=20 deg\", "
            "for "
            "each of data; none: the press itself",
            &Order::conditions),
      quantity("calibration", "depth", "cm", "m", positive,
               "largest indentation of the continuum's curves",
               at(&Config::calibration, &CalibrationSettings::depth)),
      entry("points", {2, 200, true}, "indentations of each of the continuum's curves",
            &Order::points),
      with_rule(
          entry("parameters", any, "what is free; none: what the problem usually frees",
                &Order::parameters),
          "youngs_modulus, shear_modulus: E and G; modulus, or one of these alone: E, Poisson's "
          "ratio held; "
          "lame_shear, lambda: of law A; k1, k2, k3, kappa: of the lattice; bond, contact: "
          "factors on the ties; retardation_time. experiment and curve know all but the "
          "last, damping the last alone. experiment knows besides relaxation: shares and times of "
          "the branches of rubber.relaxation, of one if it has none; or relaxation_g1, "
          "relaxation_tau1 ...: some of them. Beside measured displacements poissons_ratio, which "
          "they tell in any case; compression: a factor of the field, load by load, so that its "
          "shape alone tells; slip: how far the contact is from stick to frictionless",
          {}),
      forward_key(),
      of_experiment(rig_key()),
      of_experiment(tolerances_key()),
      of_experiment(entry("noise", {0.0, 1.0, true},
                          "relative standard deviation of the forces that calibrate --plan plans",
                          &Order::noise)),
      of_experiment(quantity("calibration", "noise_force", "N", "N", not_negative,
                             "standard deviation of these that is there whatever the force",
                             at(&Config::calibration, &Order::noise_force))),
      of_experiment(candidates_key()),
      of_experiment(choice("calibration", "contact",
                           {{"both", "where press.contact is not given, sticking and frictionless"},
                            {"given", "press.contact, also where that is its default"}},
                           "with which contacts measured presses are fitted",
                           at(&Config::calibration, &Order::contact_as_given))),
      of_experiment(choice("calibration", "frame",
                           {{"fitted", "its rigid motion is fitted, load by load"},
                            {"held", "it stands still where the finger is held"}},
                           "the frame in which displacements of points were measured",
                           at(&Config::calibration, &Order::frame_held))),
      of_experiment(entry("machine", any, "name of the machine: files of one share a compliance",
                          &Order::machine)),
      entry("prior", {0.0, 10.0, true},
            "relative standard deviation of constants about those of the moduli, ten times that "
            "for bond and contact; 0: no prior",
            &Order::prior),
      entry("model_error", {0.0, 1.0, true},
            "relative error a model of a curve may have, besides the continuum's own",
            &Order::model_error),
      entry("robust_width", {0.0, 1e6, true},
            "residuals beyond so many sigma count linearly; 0: least squares",
            &Order::robust_width),
      range_key(),
      entry("evaluations", {1, 1000000, true},
            "evaluations of the model a search may do, a press of every curve each",
            &Order::evaluations),
      entry("profile", any, "two free parameters to draw chi-square over, or none",
            &Order::profile),
      of_experiment(choice("calibration", "intervals",
                           {{"auto",
                             "profile where the modulus alone is sought of the rubber, which "
                             "costs no press, else linear"},
                            {"linear", "of the covariance at the estimates"},
                            {"profile",
                             "up to where chi-square, least over the other parameters, has "
                             "risen: also where ellipses do not hold"}},
                           "what 95 % intervals of parameters are",
                           at(&Config::calibration, &Order::intervals))),
      entry(
          "bias", any,
          "run the continuum at the estimates, too, and tell what the lattice's error does to them",
          &Order::bias),
      entry("surrogate", any, "write F(delta) and its derivative for gain schedules",
            &Order::surrogate),
      entry("isotropy_weight", {0.0, 1e6, true},
            "weight of isotropy beside E and G for central springs", &Order::isotropy_weight),
      entry("bulk_weight", {0.0, 1e6, true},
            "weight of the bulk modulus beside E and G for central springs", &Order::bulk_weight),
      entry("starts", {1, 1000, true}, "of no effect: the fit to moduli has a closed form",
            &Order::starts),
      entry("seed", {0, 4294967295.0, true}, "seed of the random starts of laws", &Order::seed),
  };
}

}  // namespace fingertip::studies::inline config::inline keys
