// Every kind of bad input, through the real program: exit code 2, one line that says where, what,
// which rule and what to do, and nothing written.

#include <gtest/gtest.h>

#include "tests/studies/workplace.h"

namespace {

/// What is refused, and what the message must contain.
struct BadInput {
  Words settings, told;
};

void expect_refused(const Workplace& folder, const std::string& command, const Words& settings,
                    const Words& told) {
  folder.expect_refused(command, settings, told + Words{"; "});  // "; ": there is a remedy
}

}  // namespace

TEST(BadInput, IsRefusedByEveryVerbThatComputes) {
  const Workplace folder;
  for (const auto& [settings, told] : std::vector<BadInput>{
           {{"rubber.yongs_modulus=40 gf/cm^2"}, {"unknown key", "rubber.youngs_modulus"}},
           {{"rubber.youngs_modulus=40 cm"}, {"40 cm", "wrong dimension", "Pa"}},
           {{"rubber.youngs_modulus=40"}, {"unit is missing", "40 gf/cm^2"}},
           {{"rubber.poissons_ratio=0.5"}, {"0.5", "> -1 and <= 0.4999"}},
           {{"rubber.shore_hardness=100"}, {"100", ">= 10 and <= 90"}},
           {{"rubber.young=3 MPa"}, {"unknown key", "rubber.youngs_modulus"}},
           {{"geometry.rod_radius=1 cm"}, {"smaller than tip_radius"}},
           {{"geometry.tip_radius=0.4 cm"}, {"smaller than tip_radius", "0.4 cm"}},
           {{"geometry.rod_length=1 cm"}, {"sleeve_length"}},
           {{"lattice.spacing=0.26 cm"}, {"(R - r)/2"}},
           {{"lattice.spacing=tip_radius/3"}, {"(R - r)/2"}},
           {{"press.depth=0 cm"}, {"> 0"}},
           {{"press.depth=-1 mm"}, {"> 0"}},
           {{"press.depth=0.5 cm"}, {"R - r"}},
           {{"press.depth=nan cm"}, {"finite"}},
           {{"press.depth=nan"}, {"finite"}},
           {{"rubber.density=inf kg/m^3"}, {"finite"}},
           {{"press.contact=slippery"}, {"stick | frictionless | coulomb"}},
           {{"reference.degree=7"}, {"<= 3"}},
           {{"lattice.constants=absent.toml"}, {"absent.toml"}}})
    for (const char* verb : {"press", "reference", "calibrate", "validate"})
      expect_refused(folder, std::string(verb) + " --out run", settings,
                     told + Words{"--set " + settings[0]});
}

TEST(BadInput, OfALatticeAtRestIsRefusedBeforeAnythingIsComputed) {
  const Workplace folder;
  const std::string e = "rubber.youngs_modulus=", g = "rubber.shear_modulus=";
  for (const auto& [settings, told] : std::vector<BadInput>{
           {{"lattice.spacing=0.26 cm"},
            {"--set lattice.spacing=0.26 cm", "(R - r)/2", "two cells", "finer lattice"}},
           {{"geometry.rod_radius=0.9 cm", "lattice.spacing=tip_radius/12"},
            {"lattice.spacing = tip_radius/12", "(R - r)/2", "finer lattice"}},
           {{"lattice.spacing=tip_radius/400"},
            {"--set lattice.spacing=tip_radius/400", "20 million", "coarser lattice"}},
           {{"lattice.model=network", e + "20 gf/cm^2", g + "14 gf/cm^2"},
            {"--set " + e + "20 gf/cm^2", "Poisson's ratio >= 0", "lattice.kinematics = small"}},
           {{e + "40 gf/cm^2", g + "13.3 gf/cm^2"}, {"13.3 gf/cm^2", "G must exceed E/3"}},
           {{e + "42 gf/cm^2", g + "14 gf/cm^2"}, {"G must exceed E/3", "42 gf/cm^2"}},
           {{"lattice.model=network", e + "42 gf/cm^2", g + "14 gf/cm^2"},
            {"--set " + e + "42 gf/cm^2", "Poisson's ratio", "reaches 1/2",
             "lower youngs_modulus"}},
           {{"lattice.model=hookean", "lattice.kinematics=finite", e + "30 gf/cm^2",
             g + "14 gf/cm^2"},
            {"--set lattice.kinematics=finite", "kappa >= 0", "network"}},
           {{"lattice.offset=[0.0, 1.5, 0.0]"},
            {"--set lattice.offset=[0.0, 1.5, 0.0]", ">= -1 and <= 1"}},
           {{"lattice.model=published", R"(lattice.rotation=["9 deg", "0 deg", "0 deg"])"},
            {"lattice.rotation", "aligned with the rod", "at 0"}},
           {{"lattice.ligament_stiffness=0"}, {"--set lattice.ligament_stiffness=0", "> 0"}}})
    for (const char* verb : {"press", "modes"})
      expect_refused(folder, std::string(verb) + " --out run",
                     Words{"press.mode=static"} + settings, told);
}

TEST(BadInput, WhatTheLatticeCannotDoIsRefusedToItAndGoesToTheContinuum) {
  const Workplace folder;
  folder.put("tilted.toml",
             "[press]\ntwist = \"5 deg\"\ntilt = \"5 deg\"\n[lattice]\nmodel = "
             "\"published\"\n");
  for (const char* verb : {"press", "validate"})
    expect_refused(folder, std::string(verb) + " --config tilted.toml --out run", {},
                   {"tilted.toml:3: press.tilt = 5 deg: ", "press.mode = static"});
  expect_refused(folder, "press --config tilted.toml --out run", {},
                 {"tilted.toml:2: press.twist = 5 deg: ", "a straight way", "press.mode = static"});
  EXPECT_TRUE(says(folder.run("check tilted.toml").out, "tilted.toml:3: press.tilt = 5 deg"));
}

TEST(BadInput, RulesOfTheContinuumNameFileAndLine) {
  const Workplace folder;
  folder.put("finite.toml",
             "[rubber]\nshear_modulus = \"25 gf/cm^2\"\nyoungs_modulus = \"40 gf/cm^2\"\n"
             "[reference]\nstrain = \"finite\"\n");
  folder.put("transient.toml", "[press]\nlateral = \"1 mm\"\n[reference]\nmode = \"transient\"\n");
  for (const std::string verb : {"check --quiet", "reference", "calibrate"}) {
    expect_refused(folder, verb + " --config finite.toml", {},
                   {"finite.toml:5: reference.strain = finite: ", "nu >= 0", "finite.toml:2",
                    "without bound"});
    expect_refused(folder, verb + " --config transient.toml", {},
                   {"transient.toml:4: reference.mode = transient: ", "along the axis",
                    "press.lateral = 1 mm, transient.toml:2"});
  }
  expect_refused(folder, "validate", {"reference.mode=modes"},
                 {"--set reference.mode=modes", "compares forces"});
}

TEST(BadInput, UnstableTimeStepIsRefusedWithItsBound) {
  expect_refused(Workplace(), "press --out run",
                 {"run.time_step=1 ms", "lattice.spacing=tip_radius/5"},
                 {"--set run.time_step=1 ms", "bound"});
}

TEST(BadInput, FilesAreNamedWithTheLine) {
  const Workplace folder;
  folder.put("bad.toml", "[rubber]\n# a comment\nyoungs_modulus = \"40 N\"\nfoo = 1\n");
  for (const char* command : {"press --config bad.toml", "check bad.toml",
                              "validate --config bad.toml", "validate bad.toml"})
    expect_refused(
        folder, command, {},
        {"bad.toml:3: rubber.youngs_modulus = 40 N: ", "bad.toml:4: rubber.foo = 1: unknown key"});
  folder.put("truncated.toml", "[rubber]\nyoungs_modulus = \"40 gf");
  expect_refused(folder, "press --config truncated.toml", {}, {"truncated.toml:2: "});
  expect_refused(folder, "press --config absent.toml", {}, {"absent.toml", "cannot be read"});
}

TEST(BadInput, OutputFoldersAreNotOverwritten) {
  const Workplace folder;
  std::filesystem::create_directory(folder / "there");
  folder.put("there/note.txt", "mine");
  expect_refused(folder, "press --out there", {}, {"--out there", "exists already"});
  expect_refused(folder, "calibrate --out there --force", {},
                 {"not the folder of a run", "--out there"});
  EXPECT_EQ(folder.text("there/note.txt"), "mine");
  expect_refused(folder, "calibrate --out there/note.txt/x", {}, {"cannot be written"});
  expect_refused(folder, "calibrate --out /proc/run", {}, {"cannot be written"});
}

TEST(BadInput, UnknownWordsOnTheCommandLine) {
  const Workplace folder;
  for (const auto& [command, told] : std::vector<std::pair<std::string, Words>>{
           {"valdate", {"valdate", "validate"}},
           {"press --depth 1", {"--depth"}},
           {"press --set press.depth", {"section.key=value"}},
           {"press --progress loud", {"loud"}},
           {"press --resume always", {"always"}},
           {"reference --ranks 0", {"--ranks", "1 to 1024"}},
           {"reference --ranks two", {"--ranks", "two"}},
           {"press --ranks 2", {"--ranks"}},
           {"press --threads two", {"--threads two", "integer"}},
           {"validate 99_nothing", {"99_nothing", "01_paper_rubber"}},
           {"explain rubber.densiti", {"rubber.density"}},
           {"compare nowhere nothing", {"nowhere"}},
           {"report nowhere", {"nowhere"}},
           {"", {"--help"}}})
    expect_refused(folder, command, {}, told);
}

TEST(BadInput, AllProblemsAreToldAtOnce) {
  expect_refused(Workplace(), "press",
                 {"press.speed=1 cm", "rubber.foo=1", "geometry.rod_radius=2 cm"},
                 {"press.speed", "rubber.foo", "geometry.rod_radius"});
}
