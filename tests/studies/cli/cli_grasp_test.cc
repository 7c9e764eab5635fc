// The verb grasp on a coarse lattice.

#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

const Words coarse = {"lattice.spacing=tip_radius/6", "grasp.lift_speed=2 cm/s",
                      "grasp.lift_height=2 mm", "grasp.hold_time=0.05 s"};

class GraspVerb : public testing::Test {
 protected:
  ProgramResult grasp(const Words& settings, int code = 0, const std::string& out = "run") {
    return folder_.run("grasp --threads 1 --out " + out, coarse + settings, code);
  }
  const Workplace folder_;
};

}  // namespace

TEST_F(GraspVerb, LiftsTheBlockAndKeepsEverything) {
  EXPECT_TRUE(says(grasp({"press.contact=coulomb"}).out, "the block was held"));
  const json summary = folder_.json("run/summary.json");
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_EQ(summary["fate"], "held");
  EXPECT_NEAR(summary["least_force_at_rest"].get<double>(), 0.005 * 9.80665 / (2.0 * 0.5), 1e-12);
  EXPECT_NEAR(summary["held_load"].get<double>(), 1.0, 0.05);
  const std::string table = folder_.text("run/grasp.csv");
  EXPECT_TRUE(table.starts_with("time [s],phase,height [m],velocity [m/s],tilt [rad],"));
  EXPECT_TRUE(says(grasp({"press.contact=coulomb"}, 0, "two").out, "earlier run"));
  EXPECT_EQ(folder_.text("two/grasp.csv"), table);
}

TEST_F(GraspVerb, RefusesBadInputWithRuleAndRemedy) {
  for (const auto& [setting, told] : std::vector<std::pair<std::string, Words>>{
           {"press.contact=frictionless", {"without friction", "take coulomb"}},
           {"grasp.block_mass=-1 g", {"> 0"}},
           {"grasp.block_mass=0.1 g", {"outweigh", "heavier block"}},
           {"grasp.time_constant=1 ms", {"four of its periods", "longer"}},
           {"grasp.eccentricity=2 cm", {"inside the block", "smaller"}},
           {"lattice.model=published", {"does not follow", "hookean"}},
           {"grasp.forces=1 N", {"grasp.force"}}})
    folder_.expect_refused("grasp --out run", coarse + Words{setting},
                           told + Words{"--set " + setting});
}

TEST_F(GraspVerb, TooMuchForceEndsWithWhatWasComputed) {
  EXPECT_TRUE(says(grasp({"grasp.force=3 N", "grasp.closing_speed=10 cm/s"}, 3).err, "70 %"));
  EXPECT_GT(folder_.text("run/grasp.csv").size(), 1000U);
  const std::string status = folder_.json("run/summary.json")["status"];
  EXPECT_TRUE(status.starts_with("not converged"));
}

TEST_F(GraspVerb, CtrlCKeepsTheTimeSeries) {
  Program program = folder_.start("grasp --out run", coarse + Words{"grasp.hold_time=60 s"});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_GT(folder_.text("run/grasp.csv").size(), 1000U);
  EXPECT_EQ(folder_.json("run/summary.json")["status"], "interrupted");
}
