#include "studies/presses/press_setup.h"

#include <gtest/gtest.h>

#include "calibration/material/material.h"
#include "calibration/material/moduli.h"
#include "lattice/press/static_press.h"
#include "studies/config/documents.h"
#include "studies/fits/runs/moduli_job.h"
#include "studies/presses/modes_job.h"
#include "studies/presses/press_job.h"
#include "studies/presses/reference_job.h"
#include "tests/studies/configured.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace lattice = fingertip::lattice;

namespace {

using Settings = std::vector<std::string>;

fingertip::calibration::ElasticModuli moduli_of(const lattice::PressSetup& setup) {
  return fingertip::calibration::homogenised_moduli(setup.lattice.constants, setup.lattice.spacing);
}

Settings with(Settings sets, const std::string& more) {
  sets.push_back(more);
  return sets;
}

}  // namespace

TEST(PressSetup, AutoTakesEachModelsOwnConstants) {
  const auto published = setup_of({"lattice.model=published"});
  EXPECT_NEAR(published.lattice.constants.k1, 3922.66 * published.lattice.spacing, 1e-12);
  EXPECT_EQ(published.lattice.kinematics, lattice::Kinematics::finite);
  const auto hookean = moduli_of(setup_of({"lattice.model=hookean"}));
  EXPECT_NEAR(hookean.youngs_modulus_100, 3922.66, 1e-8);
  EXPECT_NEAR(hookean.poissons_ratio_100, 0.428571428571, 1e-10);
  const auto central = moduli_of(setup_of({"lattice.model=central"}));
  EXPECT_NEAR(central.youngs_modulus_100, 3922.66, 1e-5);
  EXPECT_NEAR(central.shear_modulus, 1372.931, 1e-5);
}

/// A lip of 0.05 mm would take a lattice of billions of masses, which nobody asks for.
TEST(PressSetup, ASpacingThatNobodyGaveIsCheckedWhereALatticeIsBuilt) {
  const TemporaryFolder folder;
  write_text(folder / "lip.csv",
             "r [mm],z [mm],surface,curve\n0,0,bond,\n9,0,free,\n13,0,contact,\n"
             "13,0.05,contact,\n10,0.05,contact,\n10,8,contact,arc 0 8\n0,18,axis,\n");
  const Settings profile = {"geometry.shape=profile",
                            "geometry.profile=" + (folder / "lip.csv").string()};
  EXPECT_NO_THROW(check_all(config_of(profile)));
  EXPECT_EQ(beyond_the_lattice(config_of(profile)).size(), 1U);
  EXPECT_TRUE(says(press_refusal(profile),
                   {"20 million", "0.05 mm", "tip_radius/", "leave it out", "reference"}));
  for (const char* given : {"lattice.spacing=tip_radius/12", "lattice.spacing=0.0125 mm"})
    EXPECT_TRUE(says(config_refusal([&] { check_all(config_of(with(profile, given))); }), given));
}

/// A pad of 2 mm radius on a rod as thin would sway under the controller, and rubber around a
/// needle weighs more than it.
/// 18 million masses: nothing in motion, at rest more than any machine that runs this has.
TEST(PressSetup, EquilibriumThatDoesNotFitIsRefusedWithASpacingThatWould) {
  const auto config = [](const char* mode) {
    return config_of({std::string("press.mode=") + mode, "lattice.spacing=tip_radius/150",
                      "lattice.offset=[0.1, 0.2, 0.3]"});
  };
  EXPECT_GT(equilibrium_memory(config("static").config.press), 1.5e11);
  EXPECT_EQ(equilibrium_memory(config("quasi-static").config.press), 0.0);
  EXPECT_NO_THROW(check_all(config("quasi-static")));
  EXPECT_THROW_SAYING(check_all(config("static")), ConfigError,
                      (Parts{"lattice.spacing", "its equilibrium would take some", "GB here",
                             "choose a coarser lattice, at most tip_radius/"}));
}

/// What nobody gave is coarser; what somebody gave stays.
TEST(PressSetup, AtPaceASpacingKeepsFivePerCent) {
  const LoadedConfig usual = config_of(), paced = at_pace(usual);
  EXPECT_EQ(paced.config.spacing_tolerance, 0.05);
  EXPECT_EQ(paced.config.press.lattice.spacing,
            config_of({"lattice.tolerance=0.05"}).config.press.lattice.spacing);
  EXPECT_GT(paced.config.press.lattice.spacing, usual.config.press.lattice.spacing);
  for (const char* given : {"lattice.tolerance=0.02", "lattice.spacing=tip_radius/17"})
    EXPECT_EQ(at_pace(config_of({given})).config.press.lattice.spacing,
              config_of({given}).config.press.lattice.spacing);
}

TEST(PressSetup, ARodThatNobodyGaveIsHeavyEnough) {
  const TemporaryFolder folder;
  write_text(
      folder / "pad.csv",
      "r [mm],z [mm],surface,curve\n3.2,0,bond,\n3.2,7.96,contact,\n0,7.96,axis,\n0,0,bond,\n");
  for (const Settings& sets :
       {Settings{"geometry.shape=profile", "geometry.profile=" + (folder / "pad.csv").string()},
        Settings{"geometry.rod_radius=1 mm", "lattice.spacing=tip_radius/10"}}) {
    EXPECT_TRUE(says(press_refusal(sets), "rod"));
    const LoadedConfig complete = with_material(config_of(sets), LatticeUse::press);
    const auto setup = press_setup(complete);
    EXPECT_GT(setup.rod.density, 2700.0);
    EXPECT_TRUE(says(complete.notes.back(), "rod.density"));
    write_text(folder / "again.toml", parameters_toml(complete, "again"));
    EXPECT_EQ(load_config({folder / "again.toml", {}, {}}).config.press.rod.density,
              setup.rod.density);
  }
}

TEST(PressSetup, CalibratedHookeanAgreesWithItsClosedForm) {
  const auto fitted = moduli_of(setup_of({"lattice.constants=calibrated"}));
  const auto closed = moduli_of(setup_of({"lattice.constants=rule"}));
  EXPECT_NEAR(fitted.c11 / closed.c11, 1.0, 1e-8);
  EXPECT_NEAR(fitted.c12 / closed.c12, 1.0, 1e-8);
  EXPECT_NEAR(fitted.c44 / closed.c44, 1.0, 1e-8);
}

TEST(PressSetup, TakesConstantsFromAMaterialFileAtAnySpacing) {
  const TemporaryFolder folder;
  const LoadedConfig central = config_of({"lattice.model=central"});
  const Job job =
      moduli_job(central.config.press.rubber, fit_options(central, lattice::ModelKind::central));
  const JobContext context{[](double, const std::string&) { return true; },
                           [](const std::string&) {}, 1};
  job.run(folder.path(), context);
  const std::string constants = "lattice.constants=" + (folder / "material.toml").string();
  const auto finer =
      setup_of({"lattice.model=central", "lattice.spacing=tip_radius/17", constants});
  EXPECT_NEAR(moduli_of(finer).youngs_modulus_100, 3922.66, 1e-5);
  EXPECT_TRUE(says(press_refusal({"lattice.model=hookean", constants}), "central"));
  EXPECT_TRUE(says(press_refusal({"lattice.constants=" + (folder / "absent.toml").string()}),
                   "absent.toml"));
}

namespace {

namespace calibration = fingertip::calibration;

/// As a fit to curves leaves it: another rubber than the default one, factors on the ties.
calibration::Material fitted(lattice::ModelKind model) {
  calibration::Material m;
  m.model = model;
  m.spacing = 1e-2 / 8.0;
  m.kinematics = default_kinematics(model);
  m.rubber = {5000.0, 1800.0, 900.0, 1.0 / 3.0e3, {}, {}};
  m.constants = lattice::hookean_constants(m.rubber, m.spacing);
  m.ligament_stiffness = 1.25;
  m.contact_stiffness = 0.7;
  m.validity.largest_indentation = 1e-3;
  m.validity.thickness = 5e-3;
  m.validity.smallest_spacing = m.validity.largest_spacing = m.spacing;
  m.statement = "for tests";
  return m;
}

/// Sets that use it where it was fitted.
std::vector<std::string> inside(const TemporaryFolder& folder, const calibration::Material& m) {
  calibration::write_material_toml(m, folder / "material.toml");
  return {"lattice.constants=" + (folder / "material.toml").string(), "press.mode=static",
          "lattice.model=" + std::string(lattice::name(m.model)), "lattice.spacing=tip_radius/8",
          "press.depth=0.1 cm"};
}

Settings notes(const Settings& sets, LatticeUse use = LatticeUse::press) {
  return with_material(config_of(sets), use).notes;
}

}  // namespace

TEST(MaterialOfAPress, StiffnessTiesAndRubberAreTheFiles) {
  const TemporaryFolder folder;
  const calibration::Material m = fitted(lattice::ModelKind::hookean);
  const auto sets = inside(folder, m);
  const lattice::PressSetup press = setup_of(sets);
  EXPECT_EQ(press.lattice.constants.k1, m.constants.k1);
  EXPECT_EQ(press.lattice.constants.kappa, m.constants.kappa);
  EXPECT_EQ(press.lattice.ligament_stiffness, 1.25);
  EXPECT_EQ(press.lattice.contact_stiffness, 0.7);
  EXPECT_EQ(press.rubber.youngs_modulus, 5000.0);
  EXPECT_EQ(press.rubber.density, 900.0);
  EXPECT_NEAR(press.rubber.retardation_time, 1.0 / 3.0e3, 1e-17);
  EXPECT_TRUE(notes(sets).empty()) << notes(sets).front();
}

TEST(MaterialOfAPress, ANetworkTakesItsModuliFromTheFile) {
  const TemporaryFolder folder;
  const auto sets = inside(folder, fitted(lattice::ModelKind::network));
  const lattice::PressSetup press = setup_of(sets);
  EXPECT_EQ(press.rubber.shear_modulus, 1800.0);
  EXPECT_EQ(press.rubber.youngs_modulus, 5000.0);
  // The forces are those of a press whose rubber is given by hand.
  const auto force = [](const lattice::PressSetup& setup) {
    return lattice::run_static_press(setup).response.samples().back().normal_force;
  };
  const double by_hand =
      force(setup_of({"press.mode=static", "lattice.model=network", "lattice.spacing=tip_radius/8",
                      "press.depth=0.1 cm", "press.samples=[\"0.1 cm\"]",
                      "rubber.youngs_modulus=5000 Pa", "rubber.shear_modulus=1800 Pa",
                      "lattice.ligament_stiffness=1.25", "lattice.contact_stiffness=0.7"}));
  EXPECT_NEAR(force(setup_of(with(sets, "press.samples=[\"0.1 cm\"]"))) / by_hand, 1.0, 1e-12);
}

TEST(MaterialOfAPress, WhatTheUserSaysIsKeptAndWarnedOf) {
  const TemporaryFolder folder;
  const auto sets = inside(folder, fitted(lattice::ModelKind::hookean));
  for (const auto& [set, words] : {std::pair{"rubber.density=1 g/cm^3", "density is 1000"},
                                   {"rubber.retardation_time=1 ms", "retardation time is 0.001"},
                                   {"lattice.ligament_stiffness=2", "bond is 2"},
                                   {"lattice.contact_stiffness=1", "contact is 1"},
                                   {"rubber.youngs_modulus=3900 Pa", "have no effect"},
                                   {"press.depth=0.2 cm", "20 % only"},
                                   {"lattice.spacing=tip_radius/10", "calibrate at this spacing"},
                                   {"lattice.kinematics=finite", "used at finite strain"}}) {
    const auto found = notes(with(sets, set));
    ASSERT_EQ(found.size(), 1U) << set;
    EXPECT_TRUE(found[0].starts_with("material.toml: ")) << found[0];
    EXPECT_TRUE(says(found[0], words));
  }
  EXPECT_TRUE(notes(with(sets, "press.depth=0.2 cm"), LatticeUse::modes).empty());
  EXPECT_EQ(notes(with(sets, "lattice.spacing=tip_radius/10"), LatticeUse::modes).size(), 1U);
  const lattice::PressSetup press = setup_of(with(sets, "rubber.density=1 g/cm^3"));
  EXPECT_EQ(press.rubber.density, 1000.0);
  EXPECT_EQ(setup_of(with(sets, "rubber.youngs_modulus=3900 Pa")).rubber.youngs_modulus, 5000.0);
  EXPECT_TRUE(notes({"press.mode=static", "lattice.spacing=tip_radius/12"}).empty())
      << "no file, nothing to warn of";
}

/// Exports and `reference` press the continuum of the same rubber, whatever moduli stand beside it.
TEST(MaterialOfAPress, IsThatOfTheContinuumToo) {
  const TemporaryFolder folder;
  const auto sets = inside(folder, fitted(lattice::ModelKind::hookean));
  for (const char* more : {"rubber.poissons_ratio=0.45", "rubber.youngs_modulus=3900 Pa",
                           "rubber.density=1 g/cm^3", "press.depth=0.1 cm"}) {
    const Config config = with_material(config_of(with(sets, more)), LatticeUse::modes).config;
    for (const fingertip::meshes::Rubber& rubber :
         {config.press.rubber, config.continuum().rubber}) {
      EXPECT_EQ(rubber.youngs_modulus, 5000.0) << more;
      EXPECT_EQ(rubber.shear_modulus, 1800.0) << more;
      EXPECT_EQ(rubber.density, config.press.rubber.density) << more;
    }
  }
}

TEST(MaterialOfAPress, IsReadOnce) {
  const TemporaryFolder folder;
  const LoadedConfig config = config_of(inside(folder, fitted(lattice::ModelKind::hookean)));
  check_all(config);
  std::filesystem::remove(folder / "material.toml");
  EXPECT_NO_THROW(press_setup(with_material(config, LatticeUse::press)));
}

TEST(MaterialOfAPress, ParametersOfARunMakeTheSamePress) {
  const TemporaryFolder folder;
  const auto sets = inside(folder, fitted(lattice::ModelKind::hookean));
  for (const char* more : {"press.depth=0.2 cm", "rubber.shear_modulus=30 gf/cm^2"}) {
    const LoadedConfig first = with_material(config_of(with(sets, more)), LatticeUse::press);
    write_text(folder / "parameters.toml", parameters_toml(first, "test"));
    const LoadedConfig again =
        with_material(load_config({folder / "parameters.toml", {}, {}}), LatticeUse::press);
    EXPECT_EQ(press_job(press_setup(again)).key(), press_job(press_setup(first)).key());
    EXPECT_EQ(again.notes, first.notes);
    EXPECT_EQ(first.entries.at("rubber.density").place, (folder / "material.toml").string());
  }
}

TEST(PressSetup, ContactStiffnessScalesTheTiesToThePlaneAlone) {
  const auto body_of = [](const std::string& factor) {
    const auto setup = setup_of({"press.mode=static", "lattice.spacing=tip_radius/6",
                                 "lattice.contact_stiffness=" + factor});
    return lattice::static_body(setup, 4);
  };
  const lattice::LatticeBody soft = body_of("1.0"), three = body_of("3.0");
  ASSERT_EQ(soft.outer.size(), three.outer.size());
  ASSERT_EQ(soft.bond.size(), three.bond.size());
  for (std::size_t i = 0; i < soft.outer.size(); ++i)
    EXPECT_NEAR(three.outer[i].stiffness / soft.outer[i].stiffness, 3.0, 1e-12);
  for (std::size_t i = 0; i < soft.bond.size(); ++i)
    EXPECT_EQ(three.bond[i].stiffness, soft.bond[i].stiffness);
  const auto key = [](const std::string& factor) {
    return press_job(setup_of({"press.mode=static", "lattice.contact_stiffness=" + factor})).key();
  };
  EXPECT_NE(key("2.0"), key("1.0"));
  // Where there are no ties the factor would be without effect.
  for (const Settings& without :
       {Settings{"lattice.contact_stiffness=1e7"},
        Settings{"press.mode=static", "lattice.model=published", "lattice.contact_stiffness=2.0"},
        Settings{"press.mode=static", "lattice.contact_stiffness=0.0"}})
    EXPECT_TRUE(says(press_refusal(without), "lattice.contact_stiffness"));
}

TEST(PressSetup, RefusesWhatTheLatticeCannotDo) {
  EXPECT_TRUE(says(press_refusal({"lattice.spacing=0.26 cm"}), "(R - r)/2"));
  EXPECT_EQ(press_refusal({"lattice.spacing=0.25 cm"}), "");
  EXPECT_TRUE(says(press_refusal({"lattice.spacing=1 um"}), "20 million"));
  EXPECT_TRUE(says(press_refusal({"lattice.model=published", "lattice.constants=calibrated"}),
                   "lattice.constants"));
}

namespace {

/// What `check` says to a configuration with these settings; empty when it is fine.
std::string check_refusal(void (*check)(const LoadedConfig&), const Settings& sets) {
  return refusal<ConfigError>([&] { check(config_of(sets)); });
}

}  // namespace

TEST(Checks, WhatAPressCannotDoIsRefusedToTheValidationAlone) {
  for (const char* set :
       {"press.tilt=5 deg", "press.lateral=1 mm",
        "lattice.rotation=[\"10 deg\", \"0 deg\", \"5 deg\"]", "lattice.contact_stiffness=2"}) {
    EXPECT_EQ(check_refusal(check_all, {set}), "") << set;
    EXPECT_NO_THROW(continuum_setup(config_of({set}))) << set;
    EXPECT_TRUE(check_refusal(check_validation, {set}).starts_with("--set " + std::string(set)));
    EXPECT_NE(press_refusal({set, "lattice.model=published"}), "") << set;
  }
  const std::string coulomb = "press.contact=coulomb";
  EXPECT_EQ(check_refusal(check_validation, {coulomb}), "");
  EXPECT_EQ(press_refusal({coulomb, "lattice.model=published"}), "");
  EXPECT_EQ(press_refusal({coulomb, "press.mode=static"}), "");
  EXPECT_EQ(check_refusal(check_all, {"press.twist=5 deg"}), "");
  EXPECT_TRUE(
      check_refusal(check_validation, {"press.twist=5 deg"}).starts_with("--set press.twist"));
  EXPECT_EQ(check_refusal(check_validation, {}), "");
  EXPECT_EQ(check_refusal(check_validation, {"reference.mode=transient"}), "");
  EXPECT_NE(check_refusal(check_validation, {"reference.mode=modes"}), "");
}

TEST(Checks, FiniteStrainNeedsAPositivePoissonsRatioAndSaysWhy) {
  const std::string negative = "rubber.poissons_ratio=-0.2";
  EXPECT_EQ(check_refusal(check_all, {negative}), "");
  EXPECT_EQ(check_refusal(check_all, {"reference.strain=finite"}), "");
  EXPECT_TRUE(says(check_refusal(check_all, {"reference.strain=finite", negative}),
                   {"--set reference.strain=finite", "nu >= 0", "--set " + negative}));
}

TEST(Checks, ATransientPressHasItsLimits) {
  for (const char* set : {"reference.strain=finite", "press.contact=coulomb", "press.tilt=5 deg",
                          "press.lateral=1 mm"}) {
    const std::string text = check_refusal(check_all, {"reference.mode=transient", set});
    EXPECT_TRUE(text.starts_with("--set reference.mode=transient")) << text;
    EXPECT_TRUE(says(text, "--set " + std::string(set)));
  }
}

TEST(Checks, WhatALatticeCanDoAtRestOrMoving) {
  for (const char* set : {"lattice.model=network", "press.tilt=5 deg", "press.lateral=1 mm",
                          "lattice.rotation=[\"10 deg\", \"0 deg\", \"5 deg\"]"}) {
    EXPECT_EQ(press_refusal({set, "press.mode=static"}), "") << set;
    EXPECT_EQ(press_refusal({set}), "") << set;
  }
  for (const char* set : {"press.tilt=5 deg", "press.lateral=1 mm"}) {
    EXPECT_EQ(press_refusal({set, "lattice.model=published", "press.mode=static"}), "") << set;
    EXPECT_TRUE(says(press_refusal({set, "lattice.model=published"}), "press.mode = static"));
  }
  const std::string after = "press.lateral_path=after", lateral = "press.lateral=1 mm";
  EXPECT_EQ(press_refusal({after, lateral, "press.mode=static"}), "");
  EXPECT_TRUE(press_refusal({after, lateral}).starts_with("--set press.lateral_path=after"));
  EXPECT_EQ(check_refusal(check_all, {after, lateral}), "") << "the continuum goes that way";
  EXPECT_EQ(press_refusal({"run.integrator=explicit-euler", "lattice.model=published"}), "");
  EXPECT_TRUE(says(press_refusal({"run.integrator=explicit-euler"}), "symplectic-euler"));
  // A twist under stick with the published lattice, too.
  for (const char* model : {"lattice.model=published", "lattice.model=hookean"}) {
    EXPECT_TRUE(says(press_refusal({"press.twist=5 deg", model}), "press.twist"));
    EXPECT_EQ(press_refusal({"press.twist=5 deg", model, "press.mode=static"}), "");
  }
  const std::string turning =
      R"(press.program=[["2 mm", "1 cm/s"], ["twist", "5 deg", "10 deg/s"]])";
  EXPECT_TRUE(says(press_refusal({turning}), "press.program"));
  EXPECT_EQ(press_refusal({turning, "press.mode=static"}), "");
  // What concerns the lattice alone keeps no other verb from its work.
  EXPECT_EQ(check_refusal(check_all, {"lattice.model=network"}), "");
  EXPECT_EQ(check_refusal(check_all, {"lattice.rotation=[\"10 deg\", \"0 deg\", \"5 deg\"]"}), "");
  EXPECT_TRUE(says(press_refusal({"press.mode=static", "lattice.model=published",
                                  "lattice.rotation=[\"1 deg\", \"0 deg\", \"0 deg\"]"}),
                   "aligned with the rod"));
  // nu = 0.05: kappa = lambda - G < 0.
  EXPECT_TRUE(says(press_refusal({"lattice.kinematics=finite", "rubber.poissons_ratio=0.05"}),
                   "kappa >= 0"));
  EXPECT_NE(
      press_refusal({"press.mode=static", "lattice.model=network", "lattice.constants=calibrated"}),
      "");
  // nu = E/(2G) - 1 = -0.2: the network's energy falls without bound, linearised it does not.
  const std::vector<std::string> negative = {"press.mode=static", "lattice.model=network",
                                             "rubber.poissons_ratio=-0.2"};
  EXPECT_TRUE(says(press_refusal(negative), "Poisson's ratio >= 0"));
  EXPECT_EQ(press_refusal({negative[0], negative[1], negative[2], "lattice.kinematics=small"}), "");
}

namespace {

std::string press_key(const Settings& sets) {
  return press_job(setup_of(sets)).key();
}
std::string static_key(const Settings& sets) {
  return press_key(with(sets, "press.mode=static"));
}
std::string continuum_key(const Settings& sets) {
  return reference_job(continuum_setup(config_of(sets))).key();
}
std::string modes_key(const Settings& sets) {
  return modes_job(setup_of(with(sets, "press.mode=static")), 10).key();
}

using KeyOf = std::string (*)(const Settings&);

/// Beside `common`, every one of the settings leaves the key as it is.
void expect_same(KeyOf key, const Settings& settings, const Settings& common = {}) {
  for (const std::string& set : settings) EXPECT_EQ(key(common), key(with(common, set))) << set;
}
void expect_other(KeyOf key, const Settings& settings, const Settings& common = {}) {
  for (const std::string& set : settings) EXPECT_NE(key(common), key(with(common, set))) << set;
}

}  // namespace

TEST(Jobs, StaticPressesDependOnWhatIsStatic) {
  expect_same(static_key, {"run.units=paper", "press.speed=2 cm/s", "rod.density=2 g/cm^3"});
  expect_other(static_key, {"press.tilt=1 deg", "press.lateral=1 mm", "lattice.model=network",
                            "lattice.ligament_stiffness=2", "lattice.kinematics=finite",
                            "lattice.offset=[0.0, 0.0, 0.5]", "press.contact=frictionless",
                            "press.samples=[\"0.1 cm\", \"0.3 cm\"]",
                            "lattice.rotation=[\"1 deg\", \"0 deg\", \"0 deg\"]"});
}

TEST(Jobs, TheLateralPathMattersWhereThereIsLateralMotion) {
  const std::string after = "press.lateral_path=after", lateral = "press.lateral=1 mm",
                    single_sample = "press.lateral_samples=1";
  for (const KeyOf key : {static_key, continuum_key}) {
    expect_same(key, {after});
    expect_same(key, {single_sample}, {lateral});
    expect_other(key, {after}, {lateral});
    expect_other(key, {single_sample}, {after, lateral});
  }
}

TEST(Jobs, ModesDependOnTheLatticeAndNotOnThePress) {
  expect_same(modes_key, {"press.depth=0.1 cm", "press.contact=frictionless"},
              {"lattice.spacing=tip_radius/12"});
  expect_other(modes_key, {"rubber.density=1 g/cm^3", "lattice.spacing=0.1 cm",
                           "lattice.ligament_stiffness=2", "rubber.shear_modulus=15 gf/cm^2"});
  EXPECT_NE(modes_key({}), modes_job(setup_of({"press.mode=static"}), 11).key());
}

TEST(Jobs, KeysDependOnWhatMattersAndOnNothingElse) {
  // Stick has no coefficient of friction.
  expect_same(press_key, {"run.threads=1", "lattice.constants=rule", "reference.degree=1",
                          "run.units=paper", "press.friction=0.1"});
  EXPECT_EQ(press_key({}),
            press_key({"rubber.youngs_modulus=3922.66 Pa", "rubber.shear_modulus=1372.931 Pa"}));
  expect_other(press_key, {"press.speed=2 cm/s", "rod.density=2 g/cm^3"});
  expect_other(press_key, {"press.friction=0.1"}, {"press.contact=coulomb"});
  // A whole number of steps makes a period, whatever moves the rod.
  expect_other(press_key, {"controller.period=2 ms"}, {"press.mode=quasi-static"});
  expect_same(press_key, {"controller.natural_frequency=50 Hz"}, {"press.mode=quasi-static"});
  // Small strain has no law.
  expect_same(continuum_key, {"rubber.density=1 g/cm^3", "lattice.spacing=0.2 cm",
                              "reference.law=B", "press.friction=0.1", "press.speed=9 cm/s"});
  expect_other(
      continuum_key,
      {"press.contact=frictionless", "reference.refinement=1.5", "reference.strain=finite",
       "reference.tolerance=0.01", "reference.max_unknowns=1e5", "reference.volumetric=pointwise",
       "reference.solver_tolerance=1e-9", "press.tilt=1 deg", "press.lateral=1 mm",
       "press.contact=coulomb", "reference.mode=transient"});
  expect_other(continuum_key, {"press.friction=0.1"}, {"press.contact=coulomb"});
  expect_other(continuum_key, {"reference.law=B"}, {"reference.strain=finite"});
  expect_other(continuum_key, {"press.speed=9 cm/s", "rubber.density=1 g/cm^3"},
               {"reference.mode=transient"});
  expect_other(continuum_key, {"rubber.density=1 g/cm^3", "reference.modes=3"},
               {"reference.mode=modes"});
  expect_same(continuum_key, {"press.depth=0.1 cm"}, {"reference.mode=modes"});
}

TEST(Jobs, TheContinuumsOwnVerificationIsAJob) {
  const Job job = verification_job();
  EXPECT_EQ(job.kind, "verification");
  EXPECT_TRUE(job.resumable);
  EXPECT_EQ(job.inputs["analysis"], "verification");
  EXPECT_FALSE(job.inputs.contains("samples"));
  fingertip::fem_reference::ReferenceJob reference;
  reference.analysis = fingertip::fem_reference::Analysis::verification;
  EXPECT_TRUE(reference.violations().empty()) << "fingertip-fem would refuse it";
}
