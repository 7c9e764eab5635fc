// `reference` when the continuum's program ends early, and how it goes on: the real `fingertip`
// beside a script in the place of fingertip-fem, which fails where and how a test wants it to.

#include <gtest/gtest.h>
#include <signal.h>

#include <thread>

#include "tests/studies/workplace.h"

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

const Words two_samples = {R"(press.samples=["0.1 cm", "0.2 cm"])"};

class LostProcess : public testing::Test {
 protected:
  void SetUp() override {
    std::error_code failed;
    fs::create_hard_link(FINGERTIP_PROGRAM, bin_ / "fingertip", failed);
    if (failed) fs::copy_file(FINGERTIP_PROGRAM, bin_ / "fingertip");
  }
  /// A fake continuum that ends like `ending` in its first attempt.
  void ends_with(const std::string& ending) const {
    write_text(bin_ / "fingertip-fem", fake_continuum + ending);
    fs::permissions(bin_ / "fingertip-fem", fs::perms::owner_all);
  }
  ProgramResult reference(const std::string& more, int code) const {
    return place_.run("reference --out run" + more, two_samples, code);
  }
  std::string status() const { return place_.json("run/manifest.json")["status"]; }
  /// The failed run must tell all that is needed to go on, and going on must work.
  void expect_it_goes_on(const ProgramResult& failed,
                         const std::string& advice = "--out run --resume auto") const {
    EXPECT_TRUE(says(failed.err, {"run is kept", advice}));
    EXPECT_TRUE(says(place_.text("run/response.csv"), "0.001,0.1"));
    EXPECT_TRUE(says(reference(" --resume auto", 0).out, "300.0"));
    EXPECT_EQ(status(), "finished");
    EXPECT_EQ(place_.text("run/attempts"), "started\nstarted\n");
    EXPECT_FALSE(place_.has("run/checkpoint"));
    EXPECT_TRUE(place_.has("run/convergence.csv"));
  }

  const TemporaryFolder bin_;
  const Workplace place_{(bin_ / "fingertip").string()};
};

}  // namespace

TEST_F(LostProcess, AKilledContinuumIsTold3AndGoesOn) {
  ends_with("kill -KILL $$\n");
  const ProgramResult result = reference("", 3);
  EXPECT_TRUE(
      says(result.err, {"a process of the continuum was lost", "signal 9", "run/response.csv"}));
  EXPECT_EQ(status(), "process lost");
  expect_it_goes_on(result);
}

TEST_F(LostProcess, ALostRankIsTold3AndGoesOnWithAnyNumberOfRanks) {
  ends_with("kill -SEGV $$\n");
  const ProgramResult result = reference(" --ranks 2", 3);
  EXPECT_TRUE(says(result.err, "signal 11"));
  expect_it_goes_on(result);
}

TEST_F(LostProcess, AContinuumThatDidNotConvergeGoesOn) {
  ends_with("echo 'the contact did not converge' >&2; exit 3\n");
  const ProgramResult result = reference("", 3);
  EXPECT_TRUE(says(result.err, "the contact did not converge"));
  EXPECT_EQ(status(), "not converged");
  expect_it_goes_on(result, "run it with other settings");
}

/// Data deeper than the continuum finds equilibrium: how deep it does, and the rows it can answer
/// for, as text to copy.
TEST_F(LostProcess, AFitTellsWhichRowsLieBeyondEquilibrium) {
  std::string csv = "indentation [mm];force [mN]\n";
  for (int i = 1; i <= 48; ++i) csv += std::to_string(0.1 * i) + ';' + std::to_string(3 * i) + '\n';
  place_.put("deep.csv", csv);
  ends_with(
      "echo '{\"reached\": 0.0033}' > summary.json\n"
      "echo 'no equilibrium beyond an indentation of 0.0033 m' >&2; exit 3\n");
  const auto fit = [&](const std::string& data, const std::string& out, int code) {
    return place_
        .run("calibrate --out " + out,
             {"calibration.problem=experiment", "calibration.forward=continuum",
              "calibration.data=[\"" + data + "\"]", "calibration.parameters=[\"modulus\"]",
              "calibration.candidates=[]", "lattice.spacing=tip_radius/4",
              "lattice.kinematics=small", "press.contact=stick"},
             code)
        .err;
  };
  const std::string told = fit("deep.csv", "whole", 3);
  EXPECT_TRUE(says(told, "no equilibrium beyond an indentation of 0.0033 m"));
  // 2 % less deep than 3.3 mm: the rows down to 3.2 mm.
  const auto begin = told.find("[[press]]"), end = told.find("rows = [1, 32]", begin);
  ASSERT_NE(end, std::string::npos) << told;
  place_.put("press.toml", told.substr(begin, end - begin) + "rows = [1, 32]\n");
  fit("press.toml", "cut", any_code);
  ASSERT_TRUE(place_.has("cut/continuum_1")) << "the copied text describes the file";
  for (const auto& folder : fs::directory_iterator(place_ / "cut/continuum_1")) {
    const json samples = json::parse(read_text(folder.path() / "job.json"))["protocol"]["samples"];
    EXPECT_NEAR(samples.back().get<double>(), 3.2e-3, 1e-12);
    EXPECT_EQ(samples.size(), 18U) << "between which the rows are interpolated";
  }
}

TEST_F(LostProcess, AnInterruptedContinuumGoesOn) {
  ends_with("trap 'exit 130' INT\ntouch waiting\nwhile true; do sleep 0.05; done\n");
  Program program = place_.start("reference --out run", two_samples);
  ASSERT_TRUE(place_.comes("run/waiting"));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_EQ(status(), "interrupted");
  expect_it_goes_on(result);
}

TEST_F(LostProcess, WhenFingertipItselfIsKilledTheContinuumEndsAndGoesOn) {
  ends_with("echo $$ > pid.part; mv pid.part pid; while true; do sleep 0.05; done\n");
  Program program = place_.start("reference --out run", two_samples);
  ASSERT_TRUE(place_.comes("run/pid"));
  const pid_t continuum = std::stoi(place_.text("run/pid"));
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().code, 128 + SIGKILL);
  bool gone = false;
  for (int i = 0; i < 250 && !gone; ++i) {
    gone = ::kill(continuum, 0) != 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_TRUE(gone) << "the continuum outlives its master";
  EXPECT_EQ(status(), "running");
  reference(" --resume auto", 0);
  EXPECT_EQ(status(), "finished");
}

TEST_F(LostProcess, OtherInputDoesNotGoOn) {
  ends_with("kill -KILL $$\n");
  reference("", 3);
  place_.run("reference --out run --resume auto", two_samples + Words{"reference.degree=1"}, 3);
  EXPECT_EQ(place_.text("run/attempts"), "started\n") << "the folder was emptied";
}
