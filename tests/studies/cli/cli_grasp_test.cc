// The verb grasp on a coarse lattice.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using nlohmann::json;

namespace {

std::vector<std::string> grasp(std::vector<std::string> sets, const std::string& out = "run") {
  std::vector<std::string> words{"grasp", "--out", out, "--threads", "1"};
  sets.insert(sets.begin(), {"lattice.spacing=tip_radius/6", "grasp.lift_speed=2 cm/s",
                             "grasp.lift_height=2 mm", "grasp.hold_time=0.05 s"});
  for (const std::string& set : sets) words.insert(words.end(), {"--set", set});
  return words;
}

void expect_refused(const std::vector<std::string>& sets, const std::vector<std::string>& told) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(folder.path(), grasp(sets));
  EXPECT_EQ(result.code, 2) << result.err;
  for (const std::string& text : told) {
    EXPECT_NE(result.err.find(text), std::string::npos) << text << " in " << result.err;
  }
  EXPECT_TRUE(made_in(folder.path()).empty());
}

}  // namespace

TEST(GraspVerb, LiftsTheBlockAndKeepsEverything) {
  const TemporaryFolder folder;
  const ProgramResult first = run_program(folder.path(), grasp({"press.contact=coulomb"}));
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("the block was held"), std::string::npos) << first.out;
  const json summary = json::parse(read_text(folder / "run/summary.json"));
  EXPECT_EQ(summary["status"], "finished");
  EXPECT_EQ(summary["fate"], "held");
  EXPECT_NEAR(summary["least_force_at_rest"].get<double>(), 0.005 * 9.80665 / (2.0 * 0.5), 1e-12);
  EXPECT_NEAR(summary["held_load"].get<double>(), 1.0, 0.05);
  std::istringstream table(read_text(folder / "run/grasp.csv"));
  std::string header;
  std::getline(table, header);
  EXPECT_TRUE(header.starts_with("time [s],phase,height [m],velocity [m/s],tilt [rad],"));

  const ProgramResult again = run_program(folder.path(), grasp({"press.contact=coulomb"}, "two"));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_NE(again.out.find("earlier run"), std::string::npos);
  EXPECT_EQ(read_text(folder / "run/grasp.csv"), read_text(folder / "two/grasp.csv"));
}

TEST(GraspVerb, RefusesBadInputWithRuleAndRemedy) {
  expect_refused({"press.contact=frictionless"},
                 {"press.contact=frictionless", "without friction", "take coulomb"});
  expect_refused({"grasp.block_mass=-1 g"}, {"--set grasp.block_mass=-1 g", "> 0"});
  expect_refused({"grasp.block_mass=0.1 g"},
                 {"--set grasp.block_mass=0.1 g", "outweigh", "heavier block"});
  expect_refused({"grasp.time_constant=1 ms"},
                 {"--set grasp.time_constant=1 ms", "four of its periods", "longer"});
  expect_refused({"grasp.eccentricity=2 cm"},
                 {"--set grasp.eccentricity=2 cm", "inside the block", "smaller"});
  expect_refused({"lattice.model=published"},
                 {"--set lattice.model=published", "does not follow", "hookean"});
  expect_refused({"grasp.forces=1 N"}, {"grasp.force"});
}

TEST(GraspVerb, TooMuchForceEndsWithWhatWasComputed) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), grasp({"grasp.force=3 N", "grasp.closing_speed=10 cm/s"}));
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.err.find("70 %"), std::string::npos) << result.err;
  EXPECT_GT(read_text(folder / "run/grasp.csv").size(), 1000U);
  const json summary = json::parse(read_text(folder / "run/summary.json"));
  EXPECT_TRUE(summary["status"].get<std::string>().starts_with("not converged"));
}

TEST(GraspVerb, CtrlCKeepsTheTimeSeries) {
  const TemporaryFolder folder;
  Program program(folder.path(), grasp({"grasp.hold_time=60 s"}));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_GT(read_text(folder / "run/grasp.csv").size(), 1000U);
  EXPECT_EQ(json::parse(read_text(folder / "run/summary.json"))["status"], "interrupted");
}
