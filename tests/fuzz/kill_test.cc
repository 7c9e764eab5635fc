// kill -9 at random times; going on gives the same bits, and nothing is left over.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cstdio>
#include <random>
#include <thread>

#include "attacks.h"
#include "tests/temporary_folder.h"

using namespace attacks;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

namespace {

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Kills the program `kills` times in all, up to three times in one run, and lets it go on.
void kill_and_go_on(const std::vector<std::string>& words, int kills, unsigned seed) {
  const TemporaryFolder place;
  fs::create_directory(place / "whole");
  const auto out = [&](const std::vector<std::string>& more) {
    return with(words, with({"--out", "run"}, more));
  };
  const auto start = Clock::now();
  const ProgramResult whole = run_program(place / "whole", out({}));
  ASSERT_TRUE(whole.code == 0 || whole.code == 4) << whole.err;
  const double duration = std::chrono::duration<double>(Clock::now() - start).count();
  const auto expected = results_in(place / "whole/run");
  ASSERT_FALSE(expected.empty());

  std::mt19937 random(seed);
  std::uniform_real_distribution<double> moment(0.0, duration);
  int struck = 0;
  for (int done = 0, round = 0; done < kills; ++round) {
    const fs::path folder = place / std::to_string(round);
    fs::create_directory(folder);
    for (int strike = 0; strike < 3 && done < kills; ++strike, ++done) {
      Program program(folder, out({"--resume", "auto"}));
      std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
      program.send(SIGKILL);
      if (program.wait().code == 128 + SIGKILL) ++struck;
    }
    const ProgramResult end = run_program(folder, out({"--resume", "auto"}));
    ASSERT_EQ(end.code, whole.code) << "round " << round << ": " << end.err;
    ASSERT_EQ(results_in(folder / "run"), expected) << "round " << round;
    EXPECT_EQ(leftovers(folder), std::vector<std::string>()) << "round " << round;
    fs::remove_all(folder);
  }
  std::printf("%d kills, %d of them before the end, %.2f s undisturbed\n", kills, struck, duration);
  EXPECT_TRUE(struck > 0 || kills < 3) << "every run had ended before it was killed";
}

}  // namespace

/// Seed 1 strikes first after 99.7 % of the time that the undisturbed run took.
TEST(Kill, PressInTime) {
  kill_and_go_on(moving_press(), wanted_kills(), 9);
}

TEST(Kill, PressInEquilibrium) {
  kill_and_go_on(static_press(), wanted_kills(), 2);
}

TEST(Kill, CalibrationToModuli) {
  kill_and_go_on({"calibrate", "--set", "lattice.model=central"}, wanted_kills(), 3);
}

TEST(Kill, CalibrationToMeasuredForces) {
  const TemporaryFolder data;
  write_text(data / "measured.csv",
             "# press.contact = \"frictionless\"\nindentation [mm], force [mN], sigma [mN]\n"
             "0.2, 2.5, 0.1\n0.4, 8, 0.1\n0.6, 16, 0.2\n");
  kill_and_go_on({"calibrate", "--set", "calibration.problem=experiment", "--set",
                  "calibration.data=[\"" + (data / "measured.csv").string() + "\"]", "--set",
                  "lattice.spacing=tip_radius/4", "--set", "calibration.starts=1", "--set",
                  "calibration.parameters=[\"youngs_modulus\"]", "--set", "calibration.bias=false"},
                 wanted_kills(), 4);
}

/// Two repeats behind a rig: starts, search, scatter, curves left out.
TEST(Kill, CalibrationOfTravels) {
  const TemporaryFolder data;
  for (const char* name : {"a", "b"}) {
    std::string text = "position [mm];force [mN]\n";
    for (int i = 0; i <= 20; ++i) {
      const double depth = 0.05 * i - 0.2, factor = *name == 'a' ? 30.0 : 33.0;
      text += std::to_string(0.05 * i) + ";" +
              std::to_string(depth > 0.0 ? factor * depth * std::sqrt(depth) : 0.0) + "\n";
    }
    write_text(data / (std::string(name) + ".csv"), text);
  }
  write_text(data / "presses.toml", "[[press]]\npath = [\"a.csv\", \"b.csv\"]\n");
  kill_and_go_on(
      {"calibrate", "--set", "calibration.problem=experiment", "--set",
       "calibration.data=[\"" + (data / "presses.toml").string() + "\"]", "--set",
       "lattice.spacing=tip_radius/4", "--set", "calibration.parameters=[\"modulus\"]", "--set",
       "calibration.rig={force_offset = \"fit\"}", "--set", "lattice.model=hookean", "--set",
       "calibration.contact=given", "--set", "calibration.candidates=[]"},
      wanted_kills(), 8);
}

TEST(Kill, Sweep) {
  kill_and_go_on(
      {"sweep", "--set", "press.mode=static", "--set", "press.contact=frictionless", "--set",
       "press.samples=[\"0.05 cm\"]", "--set", "lattice.model=[\"hookean\", \"network\"]", "--set",
       "lattice.spacing=[\"tip_radius/4\", \"0.22 cm\"]"},
      wanted_kills(), 5);
}

#ifdef FINGERTIP_HAS_FEM
TEST(Kill, Validation) {
  kill_and_go_on(
      {"validate", "--set", "lattice.spacing=tip_radius/4", "--set", "press.samples=[\"0.05 cm\"]",
       "--set", "reference.estimate_error=false", "--set", "reference.refinement=0.3"},
      wanted_kills(), 6);
}

TEST(Kill, ContinuumOnTwoRanks) {
  kill_and_go_on({"reference", "--ranks", "2", "--set", "reference.estimate_error=false", "--set",
                  "reference.refinement=0.25", "--set", "press.samples=[\"0.05 cm\", \"0.1 cm\"]"},
                 wanted_kills(), 7);
}
#endif
