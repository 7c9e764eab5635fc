// `reference` when the continuum's program ends early, and how it goes on: the real `fingertip`
// beside a script in the place of fingertip-fem, which fails where and how a test wants it to.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// Shell: finishes one sample and a checkpoint, then does what the test says; when there is a
/// checkpoint, finishes the second sample, too.
constexpr const char* fake_continuum = R"(#!/bin/sh
cd "$1" || exit 1
[ "${OMPI_COMM_WORLD_RANK:-0}" = 0 ] || exec sleep 60
echo started >> attempts
columns='indentation [m],normal_force [N],lateral_force_x [N],lateral_force_y [N],torque_x [N m]'
columns="$columns,torque_y [N m],torque_z [N m],contact_radius [m],max_pressure [Pa]"
columns="$columns,force_error [N],time [s]"
first='0.001,0.1,,,,,,,,0.0001,'
if [ -e checkpoint/state ]; then
  printf '%s\n%s\n%s\n' "$columns" "$first" '0.002,0.3,,,,,,,,0.0001,' > response.csv
  echo 'mesh,unknowns,cells' > convergence.csv
  echo '1,900,100' >> convergence.csv
  exit 0
fi
printf '%s\n%s\n' "$columns" "$first" > response.csv
mkdir -p checkpoint && touch checkpoint/state
)";

class LostProcess : public testing::Test {
 protected:
  /// A fake continuum that ends like `ending` in its first attempt.
  void SetUp() override {
    fs::create_directory(place_ / "bin");
    std::error_code failed;
    fs::create_hard_link(FINGERTIP_PROGRAM, program_, failed);
    if (failed) fs::copy_file(FINGERTIP_PROGRAM, program_);
  }
  void ends_with(const std::string& ending) {
    const fs::path fake = place_ / "bin/fingertip-fem";
    write_text(fake, fake_continuum + ending);
    fs::permissions(fake, fs::perms::owner_all);
  }
  std::vector<std::string> words(std::vector<std::string> more = {}) const {
    std::vector<std::string> all = {"reference", "--out", "run", "--set",
                                    "press.samples=[\"0.1 cm\", \"0.2 cm\"]"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramResult run(std::vector<std::string> more = {}) {
    return run_program(place_.path(), words(std::move(more)), program_.string());
  }
  std::string status() const {
    return json::parse(read_text(place_ / "run/manifest.json"))["status"];
  }
  /// The failed run must tell all that is needed to go on, and going on must work.
  void expect_it_goes_on(const ProgramResult& failed,
                         const std::string& advice = "--out run --resume auto") {
    for (const std::string& part : {std::string("run is kept"), advice}) {
      EXPECT_NE(failed.err.find(part), std::string::npos) << part << "\nin\n" << failed.err;
    }
    EXPECT_NE(read_text(place_ / "run/response.csv").find("0.001,0.1"), std::string::npos);
    const ProgramResult resumed = run({"--resume", "auto"});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_NE(resumed.out.find("300.0000"), std::string::npos) << resumed.out;
    EXPECT_EQ(status(), "finished");
    EXPECT_EQ(read_text(place_ / "run/attempts"), "started\nstarted\n");
    EXPECT_FALSE(fs::exists(place_ / "run/checkpoint"));
    EXPECT_TRUE(fs::exists(place_ / "run/convergence.csv"));
  }

  TemporaryFolder place_;
  fs::path program_ = place_ / "bin/fingertip";
};

}  // namespace

TEST_F(LostProcess, AKilledContinuumIsTold3AndGoesOn) {
  ends_with("kill -KILL $$\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.code, 3) << result.err;
  for (const char* part : {"a process of the continuum was lost", "signal 9", "run/response.csv"}) {
    EXPECT_NE(result.err.find(part), std::string::npos) << part << "\nin\n" << result.err;
  }
  EXPECT_EQ(status(), "process lost");
  expect_it_goes_on(result);
}

TEST_F(LostProcess, ALostRankIsTold3AndGoesOnWithAnyNumberOfRanks) {
  ends_with("kill -SEGV $$\n");
  const ProgramResult result = run({"--ranks", "2"});
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_NE(result.err.find("signal 11"), std::string::npos) << result.err;
  expect_it_goes_on(result);
}

TEST_F(LostProcess, AContinuumThatDidNotConvergeGoesOn) {
  ends_with("echo 'the contact did not converge' >&2; exit 3\n");
  const ProgramResult result = run();
  EXPECT_EQ(result.code, 3);
  EXPECT_NE(result.err.find("the contact did not converge"), std::string::npos);
  EXPECT_EQ(status(), "not converged");
  expect_it_goes_on(result, "run it with other settings");
}

/// Data deeper than the continuum finds equilibrium: how deep it does, and the rows it can answer
/// for, as text to copy.
TEST_F(LostProcess, AFitTellsWhichRowsLieBeyondEquilibrium) {
  std::string csv = "indentation [mm];force [mN]\n";
  for (int i = 1; i <= 48; ++i) csv += std::to_string(0.1 * i) + ';' + std::to_string(3 * i) + '\n';
  write_text(place_ / "deep.csv", csv);
  ends_with(
      "echo '{\"reached\": 0.0033}' > summary.json\n"
      "echo 'no equilibrium beyond an indentation of 0.0033 m' >&2; exit 3\n");
  const auto fit = [&](const char* data, const char* out) {
    return run_program(
        place_.path(),
        {"calibrate", "--set", "calibration.problem=experiment", "--set",
         "calibration.forward=continuum", "--set",
         "calibration.data=[\"" + std::string(data) + "\"]", "--set",
         "calibration.parameters=[\"modulus\"]", "--set", "calibration.candidates=[]", "--set",
         "lattice.spacing=tip_radius/4", "--set", "lattice.kinematics=small", "--set",
         "press.contact=stick", "--out", out},
        program_.string());
  };
  const ProgramResult whole = fit("deep.csv", "whole");
  ASSERT_EQ(whole.code, 3) << whole.err;
  EXPECT_NE(whole.err.find("no equilibrium beyond an indentation of 0.0033 m"), std::string::npos);
  // 2 % less deep than 3.3 mm: the rows down to 3.2 mm.
  const auto begin = whole.err.find("[[press]]"), end = whole.err.find("rows = [1, 32]", begin);
  ASSERT_NE(end, std::string::npos) << whole.err;
  write_text(place_ / "press.toml", whole.err.substr(begin, end - begin) + "rows = [1, 32]\n");
  fit("press.toml", "cut");
  const std::filesystem::path job = place_ / "cut/continuum_1";
  ASSERT_TRUE(fs::exists(job)) << "the copied text describes the file";
  for (const auto& folder : fs::directory_iterator(job)) {
    const json samples = json::parse(read_text(folder.path() / "job.json"))["protocol"]["samples"];
    EXPECT_NEAR(samples.back().get<double>(), 3.2e-3, 1e-12);
    EXPECT_EQ(samples.size(), 32U);
  }
}

TEST_F(LostProcess, AnInterruptedContinuumGoesOn) {
  ends_with("trap 'exit 130' INT\ntouch waiting\nwhile true; do sleep 0.05; done\n");
  Program program(place_.path(), words(), program_.string());
  for (int i = 0; i < 500 && !fs::exists(place_ / "run/waiting"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_EQ(status(), "interrupted");
  expect_it_goes_on(result);
}

TEST_F(LostProcess, WhenFingertipItselfIsKilledTheContinuumEndsAndGoesOn) {
  ends_with("echo $$ > pid; while true; do sleep 0.05; done\n");
  Program program(place_.path(), words(), program_.string());
  for (int i = 0; i < 500 && !fs::exists(place_ / "run/pid"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const pid_t continuum = std::stoi(read_text(place_ / "run/pid"));
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().code, 128 + SIGKILL);
  bool gone = false;
  for (int i = 0; i < 250 && !gone; ++i) {
    gone = ::kill(continuum, 0) != 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(gone) << "the continuum outlives its master";
  EXPECT_EQ(status(), "running");
  const ProgramResult resumed = run({"--resume", "auto"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(status(), "finished");
}

TEST_F(LostProcess, OtherInputDoesNotGoOn) {
  ends_with("kill -KILL $$\n");
  EXPECT_EQ(run().code, 3);
  EXPECT_EQ(run({"--resume", "auto", "--set", "reference.degree=1"}).code, 3);
  EXPECT_EQ(read_text(place_ / "run/attempts"), "started\n") << "the folder was emptied";
}
