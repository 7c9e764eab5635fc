// `reference` with the real fingertip-fem: a lost process costs nothing that was finished, and
// neither resuming nor the number of ranks changes a result.

#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>

#include "meshes/base/files.h"
#include "studies/jobs/fem_launch.h"
#include "tests/studies/workplace.h"

namespace fs = std::filesystem;
using nlohmann::json;
namespace meshes = fingertip::meshes;
using fingertip::meshes::PressResponse;
using fingertip::studies::children_of;

namespace {

/// A press on one mesh of some 28 000 unknowns: three seconds, the last of them with samples. On
/// one of several ranks, which solve by multigrid and take longer, it is smaller.
Words press_settings(bool shared) {
  return {"reference.symmetry=none", "reference.estimate_error=false",
          shared ? "reference.refinement=0.3" : "reference.refinement=0.7"};
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
  /// On one process, of the size that several would take.
  PressResponse whole_run(bool shared) const {
    folder_.run(shared ? "reference --out whole --ranks 1" : "reference --out whole",
                press_settings(shared));
    folder_.forget_cache();
    return folder_.response("whole");
  }

  /// Kills the last of the processes that compute when there are samples, and resumes.
  void kill_and_resume(bool shared) const {
    const std::string command = shared ? "reference --out run --ranks 2" : "reference --out run";
    const PressResponse whole = whole_run(shared);
    Program program = folder_.start(command, press_settings(shared));
    ASSERT_TRUE(folder_.comes("run/response.csv"));
    std::vector<pid_t> workers = children_of(program.process());
    ASSERT_EQ(workers.size(), 1U);
    if (shared) workers = children_of(workers.front());
    ASSERT_FALSE(workers.empty());
    ::kill(workers.back(), SIGKILL);
    const ProgramResult killed = program.wait();
    EXPECT_EQ(killed.code, 3) << killed.err;
    EXPECT_TRUE(says(killed.err, "signal 9"));
    EXPECT_FALSE(folder_.response("run").empty());
    folder_.run(command + " --resume auto", press_settings(shared));
    expect_equal(whole, folder_.response("run"));
    EXPECT_FALSE(folder_.has("run/checkpoint"));
  }

  const Workplace folder_;
};

}  // namespace

TEST_F(Continuum, ErrorBarsWiderThanAskedInTimeEndWithThree) {
  // So shallow and fast that steps and mesh leave more than a fifth of the smallest forces open.
  for (const std::string run : {"computed", "cached"}) {
    const ProgramResult result =
        folder_.run("reference --out " + run,
                    {"reference.mode=transient", "press.contact=frictionless",
                     "press.speed=20 cm/s", "press.depth=0.03 cm", "reference.tolerance=0.2",
                     "reference.refinement=0.3", "reference.fields=false"},
                    3);
    EXPECT_TRUE(says(result.out, "NOT REACHED at"));
    EXPECT_TRUE(says(result.err, "not converged"));
    EXPECT_EQ(folder_.response(run).samples().size(), 10U);
  }
}

/// Of a lattice, from the continuum beside it.
TEST_F(Continuum, GivesEveryForceOfALatticeItsError) {
  const Words coarse = {"lattice.spacing=tip_radius/6", "press.depth=0.05 cm"};
  const std::string told = folder_.run("press --out run", coarse).out;
  EXPECT_TRUE(says(told, {"Estimated error",
                          "force error from the continuum at small strain: at "
                          "most "}));
  const PressResponse lattice = folder_.response("run"),
                      continuum = folder_.response("run/continuum");
  ASSERT_FALSE(continuum.empty());
  double largest = 0.0;
  for (const auto& sample : continuum.samples()) {
    const auto own = std::ranges::find_if(lattice.samples(), [&](const auto& other) {
      return std::abs(other.indentation - sample.indentation) < 1e-9;
    });
    ASSERT_NE(own, lattice.samples().end());
    EXPECT_NEAR(own->force_error,
                std::abs(own->normal_force - sample.normal_force) + sample.force_error,
                1e-9 * sample.normal_force);
    largest = std::max(largest, own->force_error / own->normal_force);
  }
  EXPECT_NEAR(folder_.json("run/summary.json")["force_error"]["largest"].get<double>(), largest,
              1e-12);
  folder_.run("report run");
  EXPECT_TRUE(says(folder_.text("run/report.html"), "from the continuum at small strain: at most"));

  folder_.run("press --out run --resume auto", coarse);
  EXPECT_EQ(folder_.response("run").samples().back().force_error,
            lattice.samples().back().force_error);
  EXPECT_TRUE(says(folder_.text("run/log.txt"), "kept from the resumed run"));
  // What was found stays no longer than it is wanted.
  for (const std::string run : {"off", "run"}) {
    const ProgramResult off =
        folder_.run("press --resume auto --set run.error=off --out " + run, coarse);
    EXPECT_TRUE(omits(off.out, "error")) << off.out;
    EXPECT_TRUE(std::isnan(folder_.response(run).samples().back().force_error));
    EXPECT_FALSE(folder_.json(run + "/summary.json").contains("force_error"));
  }
  EXPECT_FALSE(folder_.has("off/continuum"));
  // Nothing that happens to the continuum takes the press away.
  const Words too_small = {"reference.max_unknowns=1000", "reference.tolerance=1e-5"};
  const ProgramResult alone = folder_.run("press --out alone", coarse + too_small);
  EXPECT_TRUE(says(alone.out, "force error estimated, for the continuum failed: ")) << alone.out;
  EXPECT_GT(folder_.response("alone").samples().back().force_error, 0.0);
}

TEST_F(Continuum, CheckTellsWhatASolidTakes) {
  folder_.run("init check.toml");
  EXPECT_FALSE(says(folder_.run("check check.toml").out, "the continuum"));  // a second
  const std::string told = folder_.run("check check.toml", {"press.tilt=5 deg"}).out;
  EXPECT_TRUE(
      says(told, {"note: the continuum takes at least some ", " GB, from ", " unknowns on", "OK"}));
}

TEST_F(Continuum, KilledAndResumedGivesTheSameForces) {
  kill_and_resume(false);
}

TEST_F(Continuum, ALostRankAndAResumedRunGiveTheSameForces) {
  kill_and_resume(true);
}

TEST_F(Continuum, RanksDoNotChangeTheForces) {
  Words settings = press_settings(true);
  settings.push_back("press.samples=[\"0.5 mm\"]");  // ranks beyond the cores wait for each other
  folder_.run("reference --out whole --ranks 1", settings);
  folder_.forget_cache();
  folder_.run("reference --out shared --ranks 3 --threads 2", settings);
  expect_equal(folder_.response("whole"), folder_.response("shared"));
}

/// A fit runs the continuum where its search goes; what it ran serves the next fit.
TEST_F(Continuum, IsRunInsideTheFit) {
  folder_.run("reference --out press",
              {"press.contact=stick", R"(press.samples=["0.2 mm", "0.4 mm", "0.8 mm", "1.5 mm"])",
               "reference.strain=finite", "reference.tolerance=0.003", "reference.fields=false",
               "rubber.youngs_modulus=30 kPa", "rubber.shear_modulus=10.5 kPa"});
  std::string data = "# press.contact = \"stick\"\nindentation [m],force [N],sigma [N]\n";
  for (const auto& sample : folder_.samples("press"))
    data += meshes::to_text(sample.indentation) + ',' + meshes::to_text(sample.normal_force) + ',' +
            meshes::to_text(0.005 * sample.normal_force) + '\n';
  folder_.put("data.csv", data);
  const auto fit = [&](const std::string& out, const std::string& parameters) {
    folder_.run(
        "calibrate --force --out " + out,
        {"calibration.problem=experiment", "calibration.forward=continuum",
         "calibration.data=[\"data.csv\"]", "lattice.model=network", "reference.tolerance=0.01",
         "calibration.candidates=[]", "calibration.parameters=" + parameters},
        judged);
    return folder_.json(out + "/calibration.json")["parameters"];
  };
  const json moduli = fit("moduli", R"(["youngs_modulus", "shear_modulus"])");
  // What a lattice makes of the rubber is not told: none was pressed.
  const std::string material = folder_.text("moduli/material.toml");
  EXPECT_TRUE(says(material, "largest_indentation"));
  EXPECT_TRUE(omits(material, {"model_error", "smallest_spacing"}));
  EXPECT_NEAR(moduli[0]["estimate"].get<double>(), 30e3, 0.01 * 30e3);
  EXPECT_NEAR(moduli[1]["estimate"].get<double>(), 10.5e3, 0.01 * 10.5e3);
  const json constants = fit("constants", R"(["lame_shear", "lambda"])");
  EXPECT_NEAR(constants[0]["estimate"].get<double>() / moduli[1]["estimate"].get<double>(), 1.0,
              1e-3);
  for (const auto& node : fs::directory_iterator(folder_ / "constants/continuum_1"))
    EXPECT_TRUE(folder_.has("moduli/continuum_1/" + node.path().filename().string()))
        << node.path() << " is computed again";
}
