#include "studies/config/loader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "studies/config/documents.h"
#include "studies/config/keys/key_table.h"
#include "tests/expectations.h"
#include "tests/studies/loaded.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;

namespace {

std::vector<fingertip::meshes::Violation> problems(const auto& action) {
  try {
    action();
  } catch (const ConfigError& error) {
    return error.violations();
  }
  return {};
}

/// The problems of a configuration file with this text and these --set; empty when it is fine.
std::vector<fingertip::meshes::Violation> problems_of(const std::string& text,
                                                      const std::vector<std::string>& sets = {}) {
  const TemporaryFolder folder;
  write_text(folder / "case.toml", text);
  return problems([&] { config_in(folder / "case.toml", sets); });
}

}  // namespace

TEST(Loader, TemplateGivesTheDefaults) {
  const TemporaryFolder folder;
  write_text(folder / "all.toml", config_template());
  const LoadedConfig from_file = config_in(folder / "all.toml");
  const LoadedConfig defaults = config_of();
  for (const Key& key : key_table()) {
    EXPECT_TRUE(from_file.entries.at(key.full_name()).given) << key.full_name();
    EXPECT_FALSE(defaults.entries.at(key.full_name()).given) << key.full_name();
  }
  EXPECT_EQ(from_file.config.press.lattice.spacing, defaults.config.press.lattice.spacing);
}

TEST(Loader, DefaultsSuitTheFinger) {
  const TemporaryFolder folder;
  write_text(folder / "hollow.csv",
             "r [mm],z [mm],surface,curve\n12.5,0,contact,\n12.5,12.5,contact,arc 0 12.5\n"
             "0,25,axis,\n0,22.5,free,arc 0 12.5\n10,12.5,free,\n10,0,bond,\n");
  write_text(folder / "pad.csv",
             "r [mm],z [mm],surface,curve\n6,0,free,\n6,2,contact,\n0,2,axis,\n0,0,bond,\n");
  const auto profile = [&](const char* file) {
    return std::vector<std::string>{"geometry.shape=profile",
                                    "geometry.profile=" + (folder / file).string()};
  };
  struct Case {
    std::vector<std::string> sets;
    double depth;  // [m]
  };
  // The usual depth, or a tenth of the rubber's thickness.
  const Case cases[] = {{{}, 3e-3},
                        {profile("hollow.csv"), 3e-3},
                        {profile("pad.csv"), 0.2e-3},
                        {{"geometry.rod_radius=9 mm"}, 0.1e-3},
                        {{"geometry.rod_radius=0.05 mm"}, 3e-3}};
  for (const Case& each : cases) {
    const LoadedConfig loaded = config_of(each.sets);
    const auto& press = loaded.config.press;
    EXPECT_NEAR(press.protocol.depth, each.depth, 1e-12);
    EXPECT_LT(loaded.config.calibration.depth, press.geometry.thickness());
    EXPECT_TRUE(press.lattice.spacing <= press.geometry.coarsest_spacing());
    // A run can be repeated with what its parameters say.
    write_text(folder / "again.toml", parameters_toml(loaded, "again"));
    const auto& again = config_in(folder / "again.toml").config.press;
    EXPECT_EQ(again.lattice.spacing, press.lattice.spacing);
    EXPECT_EQ(again.protocol.depth, press.protocol.depth);
  }
  // Of a rubber of 60 Shore A the actuator must push some hundred newtons, and may anything else.
  const auto& stiff = config_of({"rubber.shore_hardness=60"});
  EXPECT_GT(stiff.config.press.controller.force_limit, 300.0);
  EXPECT_GT(stiff.config.press.controller.torque_limit, 300.0 * 0.04);
  write_text(folder / "again.toml", parameters_toml(stiff, "again"));
  EXPECT_EQ(config_in(folder / "again.toml").config.press.controller.force_limit,
            stiff.config.press.controller.force_limit);
  EXPECT_EQ(config_of({"rubber.shore_hardness=60", "controller.force_limit=5 N"})
                .config.press.controller.force_limit,
            5.0);
  EXPECT_EQ(config_of().config.press.controller.force_limit, 20.0);

  auto asked = profile("hollow.csv");
  asked.push_back("lattice.spacing=tip_radius/12");
  EXPECT_EQ(config_of(asked).config.press.lattice.spacing, 0.0125 / 12);
}

TEST(Loader, ParametersFileReproducesEveryKey) {
  const TemporaryFolder folder;
  write_text(folder / "material.toml", "");
  write_text(folder / "in.toml", "[lattice]\nconstants = 'material.toml'\n");
  const std::vector<std::string> sets = {"geometry.tip_radius=12 mm",
                                         "rubber.youngs_modulus=3.92 kPa",
                                         "lattice.model=central",
                                         "lattice.spacing=tip_radius/9",
                                         "lattice.offset=[0.25, 0, -0.5]",
                                         "press.contact=frictionless",
                                         "press.samples=[\"0.1 cm\", \"0.05 cm\"]",
                                         "run.time_step=1e-5 s",
                                         "reference.degree=1",
                                         "reference.estimate_error=false",
                                         "reference.strain=finite",
                                         "reference.law=C",
                                         "reference.max_unknowns=50000",
                                         "press.friction=0.25",
                                         "press.tilt=-9 deg",
                                         "press.lateral=2 mm",
                                         "press.lateral_path=after",
                                         "press.lateral_samples=4",
                                         "lattice.kinematics=finite",
                                         "run.integrator=explicit-euler"};
  const LoadedConfig first = load_config({folder / "in.toml", sets, "3"});
  write_text(folder / "parameters.toml", parameters_toml(first, "test"));
  const LoadedConfig second = config_in(folder / "parameters.toml");
  for (const Key& key : key_table()) {
    EXPECT_EQ(first.entries.at(key.full_name()).literal,
              second.entries.at(key.full_name()).literal);
  }
  EXPECT_EQ(second.config.press.geometry.tip_radius, 0.012);
  EXPECT_EQ(second.config.press.lattice.spacing, 0.012 / 9.0);
  EXPECT_EQ(second.config.press.lattice.offset.z(), -0.5);
  EXPECT_EQ(second.config.press.lattice.kinematics, fingertip::lattice::Kinematics::finite);
  EXPECT_EQ(second.config.press.protocol.samples, (std::vector<double>{0.0005, 0.001}));
  EXPECT_EQ(second.config.press.protocol.depth, 0.001);
  EXPECT_EQ(second.config.press.time_step, 1e-5);
  EXPECT_EQ(second.config.press.threads, 3);
  EXPECT_EQ(second.config.constants_file, folder / "material.toml");
  EXPECT_FALSE(second.config.reference.estimate_error);
  EXPECT_EQ(second.config.reference.strain, fingertip::fem_reference::Strain::finite);
  EXPECT_EQ(second.config.continuum().rubber.energy.volumetric,
            fingertip::meshes::VolumetricLaw::isochoric_logarithmic);
  EXPECT_EQ(second.config.reference.max_unknowns, 50000.0);
  EXPECT_EQ(second.config.continuum().protocol.friction, 0.25);
  EXPECT_NEAR(second.config.continuum().protocol.tilt, -std::atan(1.0) / 5.0, 1e-14);
  EXPECT_EQ(second.config.continuum().protocol.lateral, 0.002);
  EXPECT_EQ(second.config.continuum().protocol.lateral_path, fingertip::meshes::LateralPath::after);
  EXPECT_EQ(second.config.continuum().protocol.lateral_samples, 4);
}

TEST(Loader, SetIsALiteralOrElseBareText) {
  const auto with = [](const std::string& set) { return config_of({set}).config; };
  EXPECT_EQ(with("press.depth=0.2 cm").press.protocol.depth, 0.002);
  EXPECT_EQ(with("press.depth=\"0.2 cm\"").press.protocol.depth, 0.002);
  EXPECT_EQ(with("press.depth='2 mm'").press.protocol.depth, 0.002);
  EXPECT_EQ(with("reference.degree=1").reference.degree, 1);
  EXPECT_EQ(with("lattice.ligament_stiffness=10").press.lattice.ligament_stiffness, 10.0);
  EXPECT_EQ(with("press.contact=frictionless").press.protocol.contact,
            fingertip::meshes::ContactMode::frictionless);
}

TEST(Loader, ThePressGoesToTheContinuumToo) {
  const Config config =
      config_of({"press.speed=2 cm/s", "press.contact=coulomb", "press.tilt=45 deg"}).config;
  EXPECT_EQ(config.continuum().protocol.speed, 0.02);
  EXPECT_EQ(config.continuum().protocol.contact, fingertip::meshes::ContactMode::coulomb);
  EXPECT_NEAR(config.continuum().protocol.tilt, std::atan(1.0), 1e-14);
}

TEST(Loader, LaterSourcesWin) {
  const TemporaryFolder folder;
  write_text(folder / "a.toml", "[press]\ndepth = \"0.1 cm\"\n[run]\nthreads = 1\n");
  const LoadedConfig loaded =
      load_config({folder / "a.toml", {"press.depth=0.15 cm", "press.depth=0.2 cm"}, "2"});
  EXPECT_EQ(loaded.config.press.protocol.depth, 0.002);
  EXPECT_EQ(loaded.config.press.threads, 2);
  EXPECT_EQ(loaded.entries.at("press.depth").place, "--set press.depth=0.2 cm");
}

TEST(Loader, SamplesSetTheDepthAndSaySo) {
  const LoadedConfig loaded =
      config_of({"press.samples=[\"0.2 cm\", \"0.1 cm\"]", "press.depth=0.3 cm"});
  EXPECT_EQ(loaded.config.press.protocol.depth, 0.002);
  EXPECT_EQ(loaded.config.continuum().protocol.samples, (std::vector<double>{0.001, 0.002}));
  ASSERT_EQ(loaded.notes.size(), 1U);
}

TEST(Loader, CollectsAllProblemsWithTheirLines) {
  const auto problems =
      problems_of("[rubber]\nyoungs_modulus = \"40 N\"\ndensty = \"1 g/cm^3\"\n[latice]\nx = 1\n",
                  {"press.speed=0 m/s"});
  ASSERT_EQ(problems.size(), 4U);
  std::string all;
  for (const fingertip::meshes::Violation& problem : problems) all += to_string(problem) + "\n";
  EXPECT_TRUE(says(all, {"case.toml:2: rubber.youngs_modulus = 40 N: ", "wrong dimension",
                         "case.toml:3: rubber.densty = 1 g/cm^3: unknown key",
                         "nearest valid key is rubber.density", "case.toml:4: latice",
                         "nearest valid section is [lattice]",
                         "--set press.speed=0 m/s: press.speed = 0 m/s: must be > 0 m/s"}));
}

TEST(Loader, DomainRulesNameTheValueThatWasWritten) {
  auto problems =
      problems_of("[rubber]\nshear_modulus = \"13 gf/cm^2\"\nyoungs_modulus = \"40 gf/cm^2\"\n");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(says(problems[0].place, "case.toml:2"));
  EXPECT_EQ(problems[0].value, "13 gf/cm^2");
  // The rule is about G, and names the E that breaks it.
  problems = problems_of("[rubber]\nshear_modulus = \"14 gf/cm^2\"\n",
                         {"rubber.youngs_modulus=50 gf/cm^2"});
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_TRUE(says(problems[0].place, "case.toml:2"));
  EXPECT_TRUE(says(problems[0].rule, "rubber.youngs_modulus = 50 gf/cm^2"));
}

TEST(Loader, AnUnreadableValueDoesNotBreakFurtherRules) {
  // rod_radius keeps its default 0.5 cm, which tip_radius = 0.4 cm would violate.
  const auto problems = problems_of(
      "[geometry]\ntip_radius = \"0.4 cm\"\nrod_radius = \"0.2 gf\"\n[press]\ndepth = \"0.1 "
      "cm\"\n");
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems[0].key, "geometry.rod_radius");
}

TEST(Loader, RefusesWrongKindsOfValues) {
  for (const char* set : {"press.depth=nan",
                          "press.depth=3",
                          "press.depth=true",
                          "press.samples=0.1 cm",
                          "press.samples=[1, 2]",
                          "lattice.offset=[0, 0]",
                          "lattice.offset=[0, 0, inf]",
                          "lattice.offset=[0, 0, 1.5]",
                          "reference.degree=2.0",
                          "reference.degree=4",
                          "reference.tolerance=1e-8",
                          "reference.max_unknowns=many",
                          "reference.mode=verification",
                          "reference.law=D",
                          "press.contact=coulombe",
                          "press.friction=0",
                          "press.tilt=3",
                          "press.tilt=5 %",
                          "press.tilt=46 deg",
                          "press.lateral=1.1 cm",
                          "press.lateral=1 deg",
                          "reference.fields=yes",
                          "lattice.model=3",
                          "lattice.model=networks",
                          "lattice.rotation=[\"1 deg\"]",
                          "press.mode=dynamic",
                          "lattice.constants=",
                          "lattice.spacing=tip_radius/0",
                          "lattice.spacing=tip_radius/x",
                          "run.time_step=soon",
                          "run.threads=-1",
                          "press.depth",
                          "depth=0.1 cm",
                          "press=1",
                          "press.depth=\n[x]\ny=1"}) {
    EXPECT_EQ(problems([&] { config_of({set}); }).size(), 1U) << set;
  }
}

// toml++ makes a table per part and takes them apart by recursion.
TEST(Loader, AKeyOfManyThousandPartsIsRefused) {
  const TemporaryFolder folder;
  std::string key;
  for (int part = 0; part < 70'000; ++part) key += "a.";
  for (const std::string& text :
       {"[" + key + "a]\n", key + "a = 1\n", "b = {" + key + "a = 1}\n"}) {
    write_text(folder / "deep.toml", text);
    EXPECT_TRUE(says(config_refusal([&] { config_in(folder / "deep.toml"); }), "deep.toml"));
  }
  EXPECT_NE(config_refusal([&] { config_of({"press.depth={" + key + "a=1}"}); }), "");
}

TEST(Loader, RefusesFilesThatAreNoConfiguration) {
  EXPECT_TRUE(
      problems_of("[rubber]\nyoungs_modulus = \"40 gf").at(0).rule.starts_with("not valid TOML"));
  EXPECT_EQ(problems_of("rubber = 3").size(), 1U);
  EXPECT_EQ(problems_of("[rubber.density]\nx = 1").size(), 1U);
  for (const std::filesystem::path& file :
       {std::filesystem::path("/nowhere/at/all.toml"), std::filesystem::temp_directory_path()})
    EXPECT_TRUE(says(config_refusal([&] { config_in(file); }), file.string()));
}

TEST(Loader, AKeyThatDoesNothingIsToldOf) {
  const auto notes = [](std::vector<std::string> sets) { return config_of(std::move(sets)).notes; };
  const auto stick = notes({"press.friction=0.3"});
  ASSERT_EQ(stick.size(), 1U);
  EXPECT_TRUE(says(stick[0], {"press.friction = 0.3", "press.contact = stick"}));
  EXPECT_TRUE(notes({"press.friction=0.3", "press.contact=coulomb"}).empty());
  EXPECT_EQ(notes({"controller.force=50 mN"}).size(), 1U);
  EXPECT_TRUE(notes({"controller.force=50 mN", "controller.type=hybrid"}).empty());
  EXPECT_TRUE(notes({"press.friction=0.5"}).empty()) << "its default";
}

TEST(Loader, AProgramDecidesDepthSpeedAndSamples) {
  const std::string program =
      R"(press.program=[["0.2 cm", "3 cm/s"], ["hold", "2 s"], ["-0.1 mm", "1 mm/s"]])";
  const LoadedConfig loaded = config_of({program, R"(press.samples=["0.1 cm"])"});
  const auto& protocol = loaded.config.press.protocol;
  using Stages = std::vector<fingertip::meshes::PressStage>;
  EXPECT_EQ(protocol.program, (Stages{{2e-3, 0.03, 0.0}, {2e-3, 0.0, 2.0}, {-1e-4, 1e-3, 0.0}}));
  EXPECT_EQ(protocol.depth, 2e-3);
  EXPECT_EQ(protocol.speed, 0.03);
  EXPECT_EQ(protocol.samples, (std::vector<double>{1e-3, 2e-3}));
  EXPECT_EQ(loaded.config.continuum().protocol.program, protocol.program);
  EXPECT_TRUE(loaded.notes.empty());
  // What is written down can be run again, and what is said twice alike is welcome.
  const TemporaryFolder folder;
  write_text(folder / "again.toml", parameters_toml(loaded, "head"));
  EXPECT_EQ(config_in(folder / "again.toml").config.press.protocol.program, protocol.program);
  EXPECT_NO_THROW(config_of({program, "press.depth=2 mm", "press.speed=30 mm/s"}));
}

TEST(Loader, AProgramMovesAlongThePlaneAndTwists) {
  const std::string program =
      R"(press.program=[["3 mm", "1 cm/s"], ["lateral", "-1 mm", "2 mm/s"], )"
      R"(["twist", "90 deg", "10 deg/s"], ["hold", "1 s"], ["0 mm", "1 cm/s"]])";
  const LoadedConfig loaded = config_of({program});
  const auto& stages = loaded.config.press.protocol.program;
  using fingertip::meshes::PressStage;
  using fingertip::meshes::StageMove;
  ASSERT_EQ(stages.size(), 5U);
  const double right = 0.5 * std::numbers::pi;
  EXPECT_EQ(stages[1], (PressStage{3e-3, 2e-3, 0.0, StageMove::lateral, -1e-3, 0.0}));
  EXPECT_NEAR(stages[2].twist, right, 1e-12);
  EXPECT_NEAR(stages[2].speed, right / 9.0, 1e-12);
  EXPECT_EQ(stages[3], (PressStage{3e-3, 0.0, 1.0, StageMove::press, -1e-3, stages[2].twist}));
  EXPECT_EQ(stages[4], (PressStage{0.0, 1e-2, 0.0, StageMove::press, -1e-3, stages[2].twist}));
  const TemporaryFolder folder;
  write_text(folder / "again.toml", parameters_toml(loaded, "head"));
  EXPECT_EQ(config_in(folder / "again.toml").config.press.protocol.program, stages);
}

TEST(Loader, RefusesProgramsWithTheNumberOfTheStage) {
  const auto refusal = [](const std::vector<std::string>& sets) {
    return config_refusal([&] { config_of(sets); });
  };
  const std::string start = R"(press.program=[["0.2 cm", "1 cm/s"])";
  for (const auto& [stages, words] : {
           std::pair{"press.program=3", "must be a list of stages"},
           {R"(press.program=["0.2 cm", "1 cm/s"])", "stage 1: must be a list of texts"},
           {R"(press.program=[["hold", "1 s"]])", "stage 1: a program begins with a move"},
           {R"(press.program=[["0 cm", "1 cm/s"]])", "stage 1: the first stage must press"},
       })
    EXPECT_TRUE(says(refusal({stages}), words));
  for (const auto& [stage, words] :
       {std::pair{R"(["hold"])", "stage 2: must be a list of texts"},
        {R"(["hold", "1 Hz"])", "stage 2: "},
        {R"(["hold", "0 s"])", "stage 2: a hold must take"},
        {R"(["0.1 cm", "1 cm"])", "stage 2: "},
        {R"(["0.1 cm", "-1 cm/s"])", "stage 2: the speed of a move must be positive"},
        {R"(["0.1 cm", 1])", "stage 2: must be a list of texts"},
        {R"(["0.2 cm", "1 cm/s"])", "stage 2: the move ends where it begins"},
        {R"(["twist", "5 deg"])", "stage 2: must be a list of texts"},
        {R"(["twist", "1 mm", "1 cm/s"])", "stage 2: "},
        {R"(["twist", "5 deg", "1 Hz"])", "stage 2: "},
        {R"(["twist", "100 deg", "1 deg/s"])", "stage 2: a twist lies between"},
        {R"(["lateral", "1 mm", "0 cm/s"])", "stage 2: the speed of a move must be positive"},
        {R"(["lateral", "0 mm", "1 cm/s"])", "stage 2: the move ends where it begins"},
        {R"(["-1 cm", "1 cm/s"])", "stage 2: the indentation must lie between minus the clearance"},
        {R"(["5 cm", "1 cm/s"])", "stage 2: the indentation must lie between"}}) {
    const std::string text = refusal({start + ", " + stage + "]"});
    EXPECT_TRUE(says(text, {words, "press.program"}));
  }
  for (const char* other :
       {"press.depth=0.25 cm", "press.speed=2 cm/s", R"(press.samples=["0.1 cm", "0.4 cm"])"}) {
    const std::string text = refusal({start + "]", other});
    EXPECT_TRUE(says(text, {std::string("--set ") + other, "press.program"}));
  }
  EXPECT_TRUE(says(refusal({start + "]", "press.lateral=1 mm", "press.lateral_path=after"}),
                   "no lateral motion and no twist follow"));
}

TEST(Loader, AFileMayStandBelowAFolderThatTheEnvironmentNames) {
  const TemporaryFolder folder;
  write_text(folder / "case.toml",
             "[calibration]\nproblem = \"experiment\"\n"
             "data = [\"own.csv\", \"$FINGERTIP_TEST_DATA/gel/forces.csv\"]\n");
  unsetenv("FINGERTIP_TEST_DATA");
  const auto refused = problems([&] { config_in(folder / "case.toml"); });
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].rule, "no environment variable FINGERTIP_TEST_DATA is set");
  setenv("FINGERTIP_TEST_DATA", "/data", 1);
  const auto files = config_in(folder / "case.toml").config.calibration.data;
  unsetenv("FINGERTIP_TEST_DATA");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], folder / "own.csv");
  EXPECT_EQ(files[1], "/data/gel/forces.csv");
}
