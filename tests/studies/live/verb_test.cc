// The real program: the verb's options, its address, its end.
#include <gtest/gtest.h>
#include <signal.h>

#include <regex>

#include "tests/studies/workplace.h"

namespace {

const Words coarse = {"lattice.spacing=tip_radius/4"};

std::string quoted_address(const std::string& out) {
  const std::regex address(R"(http://127\.0\.0\.1:[1-9]\d*/\?token=[0-9a-f]{32}\n)");
  std::smatch match;
  return std::regex_search(out, match, address) ? match.str() : "";
}

}  // namespace

TEST(LiveVerb, PrintsItsAddressAndEndsByItself) {
  const Workplace folder;
  const std::string told = folder.run("live --exit-after 0.3", coarse).out;
  EXPECT_NE(quoted_address(told), "") << told;
  EXPECT_TRUE(made_in(folder.path()).empty());
}

TEST(LiveVerb, TakesAnyPressThatAPersonThenMoves) {
  const Workplace folder;
  const std::string examples = std::string(FINGERTIP_SOURCES) + "/studies/examples/";
  for (const std::string start : {"aside.toml", "relaxing.toml", "skin.toml", "edge.toml"}) {
    const std::string told = folder.run("live --exit-after 0.1 --config " + examples + start).out;
    EXPECT_TRUE(says(told, "expected real-time factor")) << start << told;
  }
}

TEST(LiveVerb, EndsCleanlyWhenInterrupted) {
  const Workplace folder;
  Program program = folder.start("live --rate 0 --running --exit-after 60", coarse);
  EXPECT_TRUE(folder.hears("token="));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(quoted_address(result.out), "") << result.out;
}

TEST(LiveVerb, InRealTimeItKeepsWhatItChose) {
  const Workplace folder;
  const ProgramResult result =
      folder.run("live --real-time --running --exit-after 1.5", coarse, any_code);
  if (result.code == 3 && says(result.err, "not even the coarsest"))
    GTEST_SKIP() << "this machine keeps up with no lattice";
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(quoted_address(result.out), "") << result.out;
  EXPECT_TRUE(says(result.err, "real time: spacing"));
  EXPECT_TRUE(says(result.out, "force error"));
  const std::filesystem::path run = std::filesystem::directory_iterator(folder / "runs")->path();
  EXPECT_TRUE(says(read_text(run / "real_time.json"), "\"slowest_factor\""));
  folder.run("live --exit-after 0.1 --config " + (run / "parameters.toml").string());
}

TEST(LiveVerb, SaysInWhatTheReferenceDiffers) {
  const Workplace folder;
  const auto live = [&](const std::string& contact) {
    folder.run("press --out " + contact,
               coarse + Words{"press.mode=static", "press.samples=[\"0.05 cm\"]",
                              "press.contact=" + contact});
    return folder.run("live --exit-after 0.1 --reference " + contact, coarse).err;
  };
  EXPECT_EQ(live("stick"), "");
  EXPECT_TRUE(says(live("frictionless"), "contact: stick, not frictionless"));
}

TEST(LiveVerb, RefusesWhatItCannotUse) {
  const Workplace folder;
  for (const char* command : {"live --reference nothing", "live --port 99999", "live --rate 2"})
    folder.run(command, {}, 2);
  folder.expect_refused("live --reference " + folder.path().string(), coarse, "response.csv");
}
