// The real program: the verb's options, its address, its end.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <regex>
#include <thread>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

const std::string coarse = "lattice.spacing=tip_radius/4";

std::string quoted_address(const std::string& out) {
  const std::regex address(R"(http://127\.0\.0\.1:[1-9]\d*/\?token=[0-9a-f]{32}\n)");
  std::smatch match;
  return std::regex_search(out, match, address) ? match.str() : "";
}

}  // namespace

TEST(LiveVerb, PrintsItsAddressAndEndsByItself) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), {"live", "--set", coarse, "--exit-after", "0.3"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(quoted_address(result.out), "") << result.out;
  EXPECT_TRUE(made_in(folder.path()).empty());
}

TEST(LiveVerb, EndsCleanlyWhenInterrupted) {
  const TemporaryFolder folder;
  Program program(folder.path(),
                  {"live", "--set", coarse, "--rate", "0", "--running", "--exit-after", "60"});
  std::this_thread::sleep_for(std::chrono::seconds(2));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(quoted_address(result.out), "") << result.out;
}

TEST(LiveVerb, InRealTimeItKeepsWhatItChose) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(
      folder.path(), {"live", "--real-time", "--set", coarse, "--running", "--exit-after", "1.5"});
  if (result.code == 3 && result.err.find("not even the coarsest") != std::string::npos)
    GTEST_SKIP() << "this machine keeps up with no lattice";
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(quoted_address(result.out), "") << result.out;
  EXPECT_NE(result.err.find("--real-time: spacing"), std::string::npos) << result.err;
  EXPECT_NE(result.out.find("force error"), std::string::npos) << result.out;
  const auto runs = std::filesystem::directory_iterator(folder / "runs");
  const std::filesystem::path run = runs->path();
  const std::string kept = read_text(run / "real_time.json");
  EXPECT_NE(kept.find("\"slowest_factor\""), std::string::npos) << kept;
  const ProgramResult again = run_program(
      folder.path(), {"live", "--config", run / "parameters.toml", "--exit-after", "0.1"});
  EXPECT_EQ(again.code, 0) << again.err;
}

TEST(LiveVerb, SaysInWhatTheReferenceDiffers) {
  const TemporaryFolder folder;
  const std::vector<std::string> press = {"press",
                                          "--set",
                                          coarse,
                                          "--set",
                                          "press.mode=static",
                                          "--set",
                                          "press.samples=[\"0.05 cm\"]",
                                          "--set"};
  auto stick = press, free = press;
  stick.insert(stick.end(), {"press.contact=stick", "--out", "stick"});
  free.insert(free.end(), {"press.contact=frictionless", "--out", "free"});
  ASSERT_EQ(run_program(folder.path(), stick).code, 0);
  ASSERT_EQ(run_program(folder.path(), free).code, 0);
  const auto live = [&](const char* reference) {
    return run_program(folder.path(),
                       {"live", "--set", coarse, "--exit-after", "0.1", "--reference", reference})
        .err;
  };
  EXPECT_EQ(live("stick"), "");
  EXPECT_NE(live("free").find("contact: stick, not frictionless"), std::string::npos);
}

TEST(LiveVerb, RefusesWhatItCannotUse) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program(folder.path(), {"live", "--reference", "nothing"}).code, 2);
  EXPECT_EQ(run_program(folder.path(), {"live", "--port", "99999"}).code, 2);
  EXPECT_EQ(run_program(folder.path(), {"live", "--rate", "2"}).code, 2);
  const ProgramResult empty =
      run_program(folder.path(), {"live", "--set", coarse, "--reference", folder.path().string()});
  EXPECT_EQ(empty.code, 2);
  EXPECT_NE(empty.err.find("response.csv"), std::string::npos) << empty.err;
}
