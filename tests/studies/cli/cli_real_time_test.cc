// --real-time with the real program. What a machine is fast enough for is not asked here, only that
// whatever was chosen is told, kept and repeated.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/workplace.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

const Words press = {"lattice.spacing=tip_radius/6", "press.depth=0.1 cm"};

/// Of a machine on which the coarsest lattice is too slow, as under a sanitizer or load.
bool too_slow(const ProgramResult& result) {
  return result.code == 3 && says(result.err, "not even the coarsest lattice");
}

/// What a machine has chosen for real_time_press: R/4, scaled masses at 500 us.
json choice_for(const std::string& key) {
  return {
      {"asked", key + ", threads 0, any integrator"},
      {"spacing_asked", 0.01 / 6},
      {"spacing", 0.01 / 4},
      {"integrator", "mass-scaled"},
      {"step", 5e-4},
      {"threads", 1},
      {"expected_factor", 1.3125},
      {"tried", true},
      {"trials",
       {{{"spacing", 0.01 / 4}, {"step", 5e-4}, {"threads", 1}, {"real_time_factor", 1.3125}}}}};
}

/// A run that was ended after its choice, whatever this machine would choose.
class BegunInRealTime : public testing::Test {
 protected:
  void SetUp() override {
    // The press that is asked for, by the same name.
    folder_.run("press --out a", press + Words{"run.integrator=auto"});
    put_choice(choice_for(folder_.json("a/finished.json")["key"]));
    fs::remove(folder_ / "a/finished.json");
  }
  void put_choice(const json& content) const { folder_.put("a/real_time.json", content.dump(2)); }
  json choice() const { return folder_.json("a/real_time.json"); }
  ProgramResult resume(int code = 0, const Words& more = {}) const {
    return folder_.run("press --real-time --out a --resume auto", press + more, code);
  }
  const Workplace folder_;
};

}  // namespace

TEST_F(BegunInRealTime, KeepsTheChoiceAndTellsItWithItsCost) {
  const json begun = choice();
  const ProgramResult result = resume();
  const json kept = choice(), summary = folder_.json("a/summary.json");
  for (const char* chosen : {"asked", "spacing", "integrator", "step", "trials", "expected_factor"})
    EXPECT_EQ(kept[chosen], begun[chosen]) << chosen;
  EXPECT_EQ(summary["spacing"], 0.01 / 4);
  EXPECT_EQ(summary["step"]["step"], 5e-4);
  EXPECT_EQ(summary["real_time"], kept);
  EXPECT_EQ(kept["slowest_factor"], summary["slowest_real_time_factor"]);
  EXPECT_EQ(kept["whole_factor"], summary["real_time_factor"]);
  EXPECT_TRUE(says(result.err, {"2.5 mm (tip_radius/4)", "1.667 mm (tip_radius/6) was asked",
                                "mass-scaled", "500 us", "threads: 1", "1.31"}));
  EXPECT_TRUE(says(result.out, {"real-time factor", "force error"}));
  folder_.run("report a");
  EXPECT_TRUE(says(folder_.text("a/report.html"), {"Real time", "1.667 mm was asked for", "1.31",
                                                   "Force error from the continuum"}));

  // Its parameters make the same result again; the machine's speed is no part of its identity.
  EXPECT_TRUE(omits(folder_.run("press --config a/parameters.toml --out b").out, "earlier run"))
      << "times of here are not kept";
  for (const char* file : {"/response.csv", "/trace.csv", "/boundary.csv"})
    EXPECT_EQ(folder_.text(std::string("a") + file), folder_.text(std::string("b") + file)) << file;
  EXPECT_EQ(folder_.json("a/finished.json")["key"], folder_.json("b/finished.json")["key"]);
}

TEST_F(BegunInRealTime, AsAnotherPressIsAnotherChoice) {
  const json begun = choice();
  const ProgramResult anew = resume(any_code, {"press.contact=frictionless"});
  if (too_slow(anew)) return;  // it was searched for
  EXPECT_EQ(anew.code, 0) << anew.err;
  EXPECT_NE(choice()["trials"], begun["trials"]);
}

TEST_F(BegunInRealTime, TellsADamagedChoiceByItsWord) {
  json kept = choice();
  kept["integrator"] = "guesswork";
  put_choice(kept);
  EXPECT_TRUE(says(resume(2).err, "guesswork"));
}

/// That of any press.
TEST_F(BegunInRealTime, TellsTheForceErrorOfThePress) {
  resume(0, {"run.error=estimate"});
  const json kept = choice(), summary = folder_.json("a/summary.json");
  EXPECT_EQ(kept["force_error"], summary["force_error"]);
  const PressResponse response = folder_.response("a");
  double largest = 0.0;
  for (const auto& sample : response.samples())
    largest = std::fmax(largest, sample.force_error / sample.normal_force);
  EXPECT_GT(kept["force_error"]["largest"], 0.0);
  EXPECT_LE(kept["force_error"]["largest"], largest * (1.0 + 1e-9));
}

TEST(RealTime, TheSearchEndsWithALatticeOrAFigure) {
  const Workplace folder;
  const ProgramResult result = folder.run("press --real-time --out a", press, any_code);
  if (result.code == 3) {
    EXPECT_TRUE(too_slow(result)) << result.err;
    EXPECT_FALSE(folder.has("a"));
    return;
  }
  ASSERT_EQ(result.code, 0) << result.err;
  const json kept = folder.json("a/real_time.json");
  EXPECT_NEAR(kept["spacing_asked"].get<double>(), 0.01 / 6, 1e-15);
  EXPECT_GE(kept["spacing"].get<double>(), 0.01 / 6 * (1.0 - 1e-12));
  EXPECT_LE(kept["spacing"].get<double>(), 0.01 / 4 * (1.0 + 1e-12));
  EXPECT_GE(kept["expected_factor"].get<double>(), 1.25);
  EXPECT_FALSE(kept["trials"].empty());
}

TEST(RealTime, WhatNoMachineKeepsUpWithIsRefusedWithItsFigure) {
  const Workplace folder;
  const ProgramResult result =
      folder.run("press --real-time --out a",
                 press + Words{"rubber.youngs_modulus=20 MPa", "rubber.shear_modulus=7 MPa",
                               "run.integrator=symplectic-euler"},
                 3);
  EXPECT_TRUE(too_slow(result));
  EXPECT_TRUE(says(result.err, "a real-time factor of 0."));
  EXPECT_FALSE(folder.has("a"));
}

TEST(RealTime, AnEquilibriumHasNoTime) {
  Workplace().expect_refused("press --real-time", press + Words{"press.mode=static"}, "press.mode");
}

TEST(Threads, TheFastestNumberGivesTheBitsOfOne) {
  const Workplace folder;
  for (const std::string threads : {"0", "1", "2"}) {
    folder.run("press --threads " + threads + " --out " + threads,
               {"lattice.spacing=tip_radius/12", "lattice.model=network",
                "run.integrator=mass-scaled", "run.time_step=1 ms", "press.depth=0.03 cm"});
    folder.forget_cache();
    for (const char* file : {"/response.csv", "/trace.csv", "/boundary.csv"})
      EXPECT_EQ(folder.text(threads + file), folder.text(std::string("0") + file)) << threads;
  }
  EXPECT_EQ(folder.json("1/summary.json")["threads"], 1);
  EXPECT_EQ(folder.json("2/summary.json")["threads"], 2) << "what is given is taken";
}
