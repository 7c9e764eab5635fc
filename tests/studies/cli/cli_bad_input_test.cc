// Every kind of bad input, through the real program: exit code 2, one line that says where, what,
// which rule and what to do, and nothing written.

#include <gtest/gtest.h>

#include <ostream>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;

namespace {

struct BadInput {
  std::string set;                ///< section.key=value
  std::vector<std::string> told;  ///< what the message must contain
};

void PrintTo(const BadInput& bad, std::ostream* out) {
  *out << bad.set;
}

void expect_refused(const fs::path& folder, const std::vector<std::string>& arguments,
                    const std::vector<std::string>& told) {
  const std::vector<std::string> before = made_in(folder);
  const ProgramResult result = run_program(folder, arguments);
  EXPECT_EQ(result.code, 2) << result.err;
  for (const std::string& part : told) {
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\nin\n" << result.err;
  }
  EXPECT_NE(result.err.find("; "), std::string::npos) << "no remedy in " << result.err;
  EXPECT_EQ(made_in(folder), before) << "something was written";
}

class BadSet : public testing::TestWithParam<BadInput> {};

}  // namespace

TEST_P(BadSet, IsRefusedByEveryVerbThatComputes) {
  const TemporaryFolder folder;
  std::vector<std::string> told = GetParam().told;
  told.push_back("--set " + GetParam().set);
  for (const char* verb : {"press", "reference", "calibrate", "validate"}) {
    expect_refused(folder.path(), {verb, "--out", "run", "--set", GetParam().set}, told);
  }
}

INSTANTIATE_TEST_SUITE_P(
    MustShow, BadSet,
    testing::Values(
        BadInput{"rubber.yongs_modulus=40 gf/cm^2", {"unknown key", "rubber.youngs_modulus"}},
        BadInput{"rubber.youngs_modulus=40 cm", {"40 cm", "wrong dimension", "Pa"}},
        BadInput{"rubber.youngs_modulus=40", {"unit is missing", "40 gf/cm^2"}},
        BadInput{"rubber.poissons_ratio=0.5", {"0.5", "> -1 and <= 0.4999"}},
        BadInput{"rubber.shore_hardness=100", {"100", ">= 10 and <= 90"}},
        BadInput{"rubber.young=3 MPa", {"unknown key", "rubber.youngs_modulus"}},
        BadInput{"geometry.rod_radius=1 cm", {"smaller than tip_radius"}},
        BadInput{"geometry.tip_radius=0.4 cm", {"smaller than tip_radius", "0.4 cm"}},
        BadInput{"geometry.rod_length=1 cm", {"sleeve_length"}},
        BadInput{"lattice.spacing=0.26 cm", {"(R - r)/2"}},
        BadInput{"lattice.spacing=tip_radius/3", {"(R - r)/2"}},
        BadInput{"press.depth=0 cm", {"> 0"}}, BadInput{"press.depth=-1 mm", {"> 0"}},
        BadInput{"press.depth=0.5 cm", {"R - r"}}, BadInput{"press.depth=nan cm", {"finite"}},
        BadInput{"press.depth=nan", {"finite"}}, BadInput{"rubber.density=inf kg/m^3", {"finite"}},
        BadInput{"press.contact=slippery", {"stick | frictionless | coulomb"}},
        BadInput{"reference.degree=7", {"<= 3"}},
        BadInput{"lattice.constants=absent.toml", {"absent.toml"}}));

namespace {

struct BadLattice {
  std::vector<std::string> sets;  ///< section.key=value
  std::vector<std::string> told;  ///< what the message must contain
};

void PrintTo(const BadLattice& bad, std::ostream* out) {
  for (const std::string& set : bad.sets) *out << (&set == &bad.sets.front() ? "" : ", ") << set;
}

class BadStaticLattice : public testing::TestWithParam<BadLattice> {};

}  // namespace

TEST_P(BadStaticLattice, IsRefusedBeforeAnythingIsComputed) {
  const TemporaryFolder folder;
  for (const char* verb : {"press", "modes"}) {
    std::vector<std::string> words{verb, "--out", "run", "--set", "press.mode=static"};
    for (const std::string& set : GetParam().sets) words.insert(words.end(), {"--set", set});
    expect_refused(folder.path(), words, GetParam().told);
  }
}

INSTANTIATE_TEST_SUITE_P(
    MustShow, BadStaticLattice,
    testing::Values(
        BadLattice{{"lattice.spacing=0.26 cm"},
                   {"--set lattice.spacing=0.26 cm", "(R - r)/2", "two cells", "finer lattice"}},
        BadLattice{{"geometry.rod_radius=0.9 cm", "lattice.spacing=tip_radius/12"},
                   {"lattice.spacing = tip_radius/12", "(R - r)/2", "finer lattice"}},
        BadLattice{{"lattice.spacing=tip_radius/400"},
                   {"--set lattice.spacing=tip_radius/400", "20 million", "coarser lattice"}},
        BadLattice{{"lattice.model=network", "rubber.youngs_modulus=20 gf/cm^2",
                    "rubber.shear_modulus=14 gf/cm^2"},
                   {"--set rubber.youngs_modulus=20 gf/cm^2", "Poisson's ratio >= 0",
                    "lattice.kinematics = small"}},
        BadLattice{{"rubber.youngs_modulus=40 gf/cm^2", "rubber.shear_modulus=13.3 gf/cm^2"},
                   {"13.3 gf/cm^2", "G must exceed E/3"}},
        BadLattice{{"rubber.youngs_modulus=42 gf/cm^2", "rubber.shear_modulus=14 gf/cm^2"},
                   {"G must exceed E/3", "42 gf/cm^2"}},
        BadLattice{{"lattice.model=network", "rubber.youngs_modulus=42 gf/cm^2",
                    "rubber.shear_modulus=14 gf/cm^2"},
                   {"--set rubber.youngs_modulus=42 gf/cm^2", "Poisson's ratio", "reaches 1/2",
                    "lower youngs_modulus"}},
        BadLattice{{"lattice.model=hookean", "lattice.kinematics=finite",
                    "rubber.youngs_modulus=30 gf/cm^2", "rubber.shear_modulus=14 gf/cm^2"},
                   {"--set lattice.kinematics=finite", "kappa >= 0", "network"}},
        BadLattice{{"lattice.offset=[0.0, 1.5, 0.0]"},
                   {"--set lattice.offset=[0.0, 1.5, 0.0]", ">= -1 and <= 1"}},
        BadLattice{
            {"lattice.model=published", "lattice.rotation=[\"9 deg\", \"0 deg\", \"0 deg\"]"},
            {"lattice.rotation", "aligned with the rod", "at 0"}},
        BadLattice{{"lattice.ligament_stiffness=0"},
                   {"--set lattice.ligament_stiffness=0", "> 0"}}));

TEST(BadInput, WhatTheLatticeCannotDoIsRefusedToItAndGoesToTheContinuum) {
  const TemporaryFolder folder;
  write_text(folder / "tilted.toml",
             "[press]\ncontact = \"coulomb\"\ntilt = \"5 deg\"\n[lattice]\nmodel = "
             "\"published\"\n");
  for (const char* verb : {"press", "validate"}) {
    expect_refused(folder.path(), {verb, "--config", "tilted.toml", "--out", "run"},
                   {"tilted.toml:3: press.tilt = 5 deg: ", "press.mode = static"});
  }
  expect_refused(
      folder.path(),
      {"press", "--config", "tilted.toml", "--set", "press.mode=static", "--out", "run"},
      {"tilted.toml:2: press.contact = coulomb: ", "in equilibrium", "press.mode = quasi-static"});
  const ProgramResult check = run_program(folder.path(), {"check", "tilted.toml"});
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_NE(check.out.find("tilted.toml:3: press.tilt = 5 deg"), std::string::npos);
}

TEST(BadInput, RulesOfTheContinuumNameFileAndLine) {
  const TemporaryFolder folder;
  write_text(folder / "finite.toml",
             "[rubber]\nshear_modulus = \"25 gf/cm^2\"\nyoungs_modulus = \"40 gf/cm^2\"\n"
             "[reference]\nstrain = \"finite\"\n");
  write_text(folder / "transient.toml",
             "[press]\nlateral = \"1 mm\"\n[reference]\nmode = \"transient\"\n");
  for (const char* verb : {"check", "reference", "calibrate"}) {
    const std::string option = verb == std::string("check") ? "--quiet" : "--progress=off";
    expect_refused(folder.path(), {verb, "--config", "finite.toml", option},
                   {"finite.toml:5: reference.strain = finite: ", "nu >= 0", "finite.toml:2",
                    "without bound"});
    expect_refused(folder.path(), {verb, "--config", "transient.toml", option},
                   {"transient.toml:4: reference.mode = transient: ", "along the axis",
                    "press.lateral = 1 mm, transient.toml:2"});
  }
  expect_refused(folder.path(), {"validate", "--set", "reference.mode=modes"},
                 {"--set reference.mode=modes", "compares forces"});
}

TEST(BadInput, UnstableTimeStepIsRefusedWithItsBound) {
  const TemporaryFolder folder;
  expect_refused(folder.path(),
                 {"press", "--out", "run", "--set", "run.time_step=1 ms", "--set",
                  "lattice.spacing=tip_radius/5"},
                 {"--set run.time_step=1 ms", "bound"});
}

TEST(BadInput, FilesAreNamedWithTheLine) {
  const TemporaryFolder folder;
  write_text(folder / "bad.toml", "[rubber]\n# a comment\nyoungs_modulus = \"40 N\"\nfoo = 1\n");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"press", "--config", "bad.toml"},
        {"check", "bad.toml"},
        {"validate", "--config", "bad.toml"},
        {"validate", "bad.toml"}}) {
    expect_refused(
        folder.path(), words,
        {"bad.toml:3: rubber.youngs_modulus = 40 N: ", "bad.toml:4: rubber.foo = 1: unknown key"});
  }
  write_text(folder / "truncated.toml", "[rubber]\nyoungs_modulus = \"40 gf");
  expect_refused(folder.path(), {"press", "--config", "truncated.toml"}, {"truncated.toml:2: "});
  expect_refused(folder.path(), {"press", "--config", "absent.toml"},
                 {"absent.toml", "cannot be read"});
}

TEST(BadInput, OutputFoldersAreNotOverwritten) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "there");
  write_text(folder / "there/note.txt", "mine");
  expect_refused(folder.path(), {"press", "--out", "there"}, {"--out there", "exists already"});
  expect_refused(folder.path(), {"calibrate", "--out", "there", "--force"},
                 {"not the folder of a run", "--out there"});
  EXPECT_EQ(read_text(folder / "there/note.txt"), "mine");
  expect_refused(folder.path(), {"calibrate", "--out", "there/note.txt/x"}, {"cannot be written"});
  expect_refused(folder.path(), {"calibrate", "--out", "/proc/run"}, {"cannot be written"});
}

TEST(BadInput, UnknownWordsOnTheCommandLine) {
  const TemporaryFolder folder;
  expect_refused(folder.path(), {"valdate"}, {"valdate", "validate"});
  expect_refused(folder.path(), {"press", "--depth", "1"}, {"--depth"});
  expect_refused(folder.path(), {"press", "--set", "press.depth"}, {"section.key=value"});
  expect_refused(folder.path(), {"press", "--progress", "loud"}, {"loud"});
  expect_refused(folder.path(), {"press", "--resume", "always"}, {"always"});
  expect_refused(folder.path(), {"reference", "--ranks", "0"}, {"--ranks", "1 to 1024"});
  expect_refused(folder.path(), {"reference", "--ranks", "two"}, {"--ranks", "two"});
  expect_refused(folder.path(), {"press", "--ranks", "2"}, {"--ranks"});
  expect_refused(folder.path(), {"press", "--threads", "two"}, {"--threads two", "integer"});
  expect_refused(folder.path(), {"validate", "99_nothing"}, {"99_nothing", "01_paper_rubber"});
  expect_refused(folder.path(), {"explain", "rubber.densiti"}, {"rubber.density"});
  expect_refused(folder.path(), {"compare", "nowhere", "nothing"}, {"nowhere"});
  expect_refused(folder.path(), {"report", "nowhere"}, {"nowhere"});
  expect_refused(folder.path(), {}, {"--help"});
}

TEST(BadInput, AllProblemsAreToldAtOnce) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), {"press", "--set", "press.speed=1 cm", "--set", "rubber.foo=1",
                                  "--set", "geometry.rod_radius=2 cm"});
  EXPECT_EQ(result.code, 2);
  for (const char* part : {"press.speed", "rubber.foo", "geometry.rod_radius"}) {
    EXPECT_NE(result.err.find(part), std::string::npos) << part;
  }
}
