// `reference` with the real fingertip-fem: a lost process costs nothing that was finished, and
// neither resuming nor the number of ranks changes a result.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "meshes/base/files.h"
#include "meshes/press/press_response.h"
#include "studies/jobs/fem_launch.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;
namespace meshes = fingertip::meshes;
using fingertip::meshes::PressResponse;
using fingertip::studies::children_of;

namespace {

/// A press on one mesh of some 28 000 unknowns: three seconds, the last of them with samples.
std::vector<std::string> reference(const std::string& out, std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"reference", "--out", out, "--set", "reference.symmetry=none",
                                    "--set", "reference.estimate_error=false", "--set",
                                    // Several ranks solve by multigrid, which takes longer.
                                    more.empty() || more.front() != "--ranks"
                                        ? "reference.refinement=0.7"
                                        : "reference.refinement=0.3"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Waits until the run has written samples; false when it does not within a minute.
bool has_samples(const fs::path& run) {
  for (int i = 0; i < 6000 && !fs::exists(run / "response.csv"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return fs::exists(run / "response.csv");
}

void expect_equal(const PressResponse& a, const PressResponse& other) {
  ASSERT_EQ(a.samples().size(), other.samples().size());
  for (std::size_t i = 0; i < a.samples().size(); ++i) {
    const double force = a.samples()[i].normal_force;
    EXPECT_EQ(a.samples()[i].indentation, other.samples()[i].indentation);
    EXPECT_NEAR(other.samples()[i].normal_force, force, 1e-8 * force) << i;
  }
}

class Continuum : public testing::Test {
 protected:
  /// On one process, of the size that `ranks` asks for.
  PressResponse whole_run(const std::vector<std::string>& ranks) {
    const bool many = !ranks.empty();
    const ProgramResult result = run_program(
        folder_.path(), reference("whole", many ? std::vector<std::string>{"--ranks", "1"}
                                                : std::vector<std::string>{}));
    EXPECT_EQ(result.code, 0) << result.err;
    fs::remove_all(folder_ / "cache");
    return PressResponse::read_csv(folder_ / "whole/response.csv");
  }

  /// Kills the last of the processes that compute when there are samples, and resumes.
  void kill_and_resume(const std::vector<std::string>& ranks) {
    const PressResponse whole = whole_run(ranks);
    Program program(folder_.path(), reference("run", ranks));
    ASSERT_TRUE(has_samples(folder_ / "run"));
    std::vector<pid_t> workers = children_of(program.process());
    ASSERT_EQ(workers.size(), 1U);
    if (!ranks.empty()) workers = children_of(workers.front());
    ASSERT_FALSE(workers.empty());
    ::kill(workers.back(), SIGKILL);
    const ProgramResult killed = program.wait();
    EXPECT_EQ(killed.code, 3) << killed.err;
    EXPECT_NE(killed.err.find("signal 9"), std::string::npos) << killed.err;
    const PressResponse part = PressResponse::read_csv(folder_ / "run/response.csv");
    EXPECT_FALSE(part.empty());
    std::vector<std::string> more = ranks;
    more.insert(more.end(), {"--resume", "auto"});
    const ProgramResult resumed = run_program(folder_.path(), reference("run", more));
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    expect_equal(whole, PressResponse::read_csv(folder_ / "run/response.csv"));
    EXPECT_FALSE(fs::exists(folder_ / "run/checkpoint"));
  }

  TemporaryFolder folder_;
};

}  // namespace

TEST_F(Continuum, ErrorBarsWiderThanAskedInTimeEndWithThree) {
  // So shallow and fast that steps and mesh leave more than a fifth of the smallest forces open.
  const std::vector<std::string> words = {"reference",
                                          "--set",
                                          "reference.mode=transient",
                                          "--set",
                                          "press.contact=frictionless",
                                          "--set",
                                          "press.speed=20 cm/s",
                                          "--set",
                                          "press.depth=0.03 cm",
                                          "--set",
                                          "reference.tolerance=0.2",
                                          "--set",
                                          "reference.refinement=0.3",
                                          "--set",
                                          "reference.fields=false",
                                          "--out"};
  for (const std::string run : {"computed", "cached"}) {
    std::vector<std::string> all = words;
    all.push_back(run);
    const ProgramResult result = run_program(folder_.path(), all);
    EXPECT_EQ(result.code, 3) << run;
    EXPECT_NE(result.out.find("NOT REACHED at"), std::string::npos) << result.out;
    EXPECT_NE(result.err.find("not converged"), std::string::npos) << result.err;
    EXPECT_EQ(PressResponse::read_csv(folder_ / (run + "/response.csv")).samples().size(), 10U);
  }
}

TEST_F(Continuum, KilledAndResumedGivesTheSameForces) {
  kill_and_resume({});
}

TEST_F(Continuum, ALostRankAndAResumedRunGiveTheSameForces) {
  kill_and_resume({"--ranks", "2"});
}
TEST_F(Continuum, RanksDoNotChangeTheForces) {
  const PressResponse whole = whole_run({"--ranks", "3"});
  const ProgramResult result =
      run_program(folder_.path(), reference("shared", {"--ranks", "3", "--threads", "2"}));
  ASSERT_EQ(result.code, 0) << result.err;
  expect_equal(whole, PressResponse::read_csv(folder_ / "shared/response.csv"));
}

/// A fit runs the continuum where its search goes; what it ran serves the next fit.
TEST_F(Continuum, IsRunInsideTheFit) {
  std::vector<std::string> press = {"reference", "--out", "press", "--set", "press.contact=stick"};
  for (const char* setting :
       {"press.samples=[\"0.2 mm\", \"0.4 mm\", \"0.8 mm\", \"1.5 mm\"]", "reference.strain=finite",
        "reference.tolerance=0.003", "reference.fields=false", "rubber.youngs_modulus=30 kPa",
        "rubber.shear_modulus=10.5 kPa"})
    press.insert(press.end(), {"--set", setting});
  ASSERT_EQ(run_program(folder_.path(), press).code, 0);
  std::ofstream data(folder_ / "data.csv");
  data << "# press.contact = \"stick\"\nindentation [m],force [N],sigma [N]\n";
  const PressResponse measured = PressResponse::read_csv(folder_ / "press/response.csv");
  for (const auto& sample : measured.samples())
    data << meshes::to_text(sample.indentation) << ',' << meshes::to_text(sample.normal_force)
         << ',' << meshes::to_text(0.005 * sample.normal_force) << '\n';
  data.close();
  const auto fit = [&](const std::string& out, const std::string& parameters) {
    const ProgramResult result = run_program(
        folder_.path(),
        {"calibrate", "--out", out, "--force", "--set", "calibration.problem=experiment", "--set",
         "calibration.forward=continuum", "--set", "calibration.data=[\"data.csv\"]", "--set",
         "lattice.model=network", "--set", "reference.tolerance=0.01", "--set",
         "calibration.candidates=[]", "--set", "calibration.parameters=" + parameters});
    EXPECT_TRUE(result.code == 0 || result.code == 4) << result.err;
    return json::parse(read_text(folder_ / (out + "/calibration.json")))["parameters"];
  };
  const json moduli = fit("moduli", "[\"youngs_modulus\", \"shear_modulus\"]");
  // What a lattice makes of the rubber is not told: none was pressed.
  const std::string material = read_text(folder_ / "moduli/material.toml");
  EXPECT_NE(material.find("largest_indentation"), std::string::npos) << material;
  EXPECT_EQ(material.find("model_error"), std::string::npos) << material;
  EXPECT_EQ(material.find("smallest_spacing"), std::string::npos) << material;
  EXPECT_NEAR(moduli[0]["estimate"].get<double>(), 30e3, 0.01 * 30e3);
  EXPECT_NEAR(moduli[1]["estimate"].get<double>(), 10.5e3, 0.01 * 10.5e3);
  const json constants = fit("constants", "[\"lame_shear\", \"lambda\"]");
  EXPECT_NEAR(constants[0]["estimate"].get<double>() / moduli[1]["estimate"].get<double>(), 1.0,
              1e-3);
  for (const auto& node : fs::directory_iterator(folder_ / "constants/continuum_1"))
    EXPECT_TRUE(fs::exists(folder_ / "moduli/continuum_1" / node.path().filename()))
        << node.path() << " is computed again";
}
