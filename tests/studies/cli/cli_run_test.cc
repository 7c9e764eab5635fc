// Runs of the real program on a coarse lattice.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes/tables/csv_table.h"
#include "tests/studies/workplace.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

const Words coarse = {"lattice.spacing=tip_radius/6", "press.depth=0.05 cm"};

}  // namespace

TEST(Run, PressWritesACompleteFolderThatCanBeRunAgain) {
  const Workplace folder;
  folder.run("press --out one", coarse);
  folder.expect_files("one", {"parameters.toml", "manifest.json", "log.txt", "summary.json",
                              "response.csv", "trace.csv", "boundary.csv", "boundary_springs.csv"});
  const json manifest = folder.json("one/manifest.json");
  EXPECT_EQ(manifest["status"], "finished");
  EXPECT_EQ(manifest["exit_code"], 0);
  const json summary = folder.json("one/summary.json");
  EXPECT_EQ(summary["model"], "hookean");
  EXPECT_LT(summary["momentum_defect"].get<double>(), 1e-9);
  EXPECT_NEAR(folder.response("one").depth(), 0.0005, 1e-9);

  folder.forget_cache();
  folder.run("press --config one/parameters.toml --out two --threads 1");
  EXPECT_EQ(folder.text("one/response.csv"), folder.text("two/response.csv"));
}

TEST(Run, EqualInputComesFromTheCache) {
  const Workplace folder;
  folder.run("press --out one", coarse);
  EXPECT_TRUE(says(folder.run("press --out two", coarse).out, "earlier run"));
  EXPECT_EQ(folder.text("one/trace.csv"), folder.text("two/trace.csv"));
  EXPECT_TRUE(says(folder.text("two/log.txt"), "from the cache"));
}

TEST(Run, AMovieIsPartOfAPressWithAKeyOfItsOwn) {
  const Workplace folder;
  folder.run("press --out plain", coarse);
  EXPECT_FALSE(folder.has("plain/movie"));
  EXPECT_TRUE(folder.has("plain/snapshot_points.csv"));
  EXPECT_TRUE(omits(folder.run("press --movie 5 --out one", coarse).out, "earlier run"));
  EXPECT_TRUE(folder.has("one/movie/frame_0004.vtu"));
  EXPECT_FALSE(folder.has("one/movie/frame_0005.vtu"));
  EXPECT_TRUE(says(folder.run("press --movie 5 --out two", coarse).out, "earlier run"));
  EXPECT_EQ(folder.text("one/movie/movie.pvd"), folder.text("two/movie/movie.pvd"));
  EXPECT_EQ(folder.text("plain/trace.csv"), folder.text("one/trace.csv"));
  folder.expect_refused("press --movie --out none", {"press.mode=static"},
                        {"a press without time has no movie"});
}

TEST(Run, ForceReplacesAndResumeKeeps) {
  const Workplace folder;
  folder.run("press --out run", coarse);
  folder.run("press --out run", coarse, 2);
  folder.run("press --out run --force", coarse);
  folder.run("press --out run --resume auto", coarse);
  // Bad input after --force costs nothing of what is there.
  folder.run("press --out run --force", coarse + Words{"run.time_step=1 s"}, 2);
  EXPECT_EQ(folder.json("run/manifest.json")["status"], "finished");
}

TEST(Run, QuietAndJsonProgress) {
  const Workplace folder;
  const ProgramResult quiet = folder.run("press --out quiet --quiet", coarse);
  EXPECT_EQ(quiet.out + quiet.err, "");
  folder.forget_cache();
  std::istringstream lines(folder.run("press --out json --progress json", coarse).err);
  Words jobs;  // one after the other
  for (std::string line; std::getline(lines, line);) {
    const json entry = json::parse(line);
    if (jobs.empty() || jobs.back() != entry["job"]) jobs.push_back(entry["job"]);
    EXPECT_GE(entry["fraction"].get<double>(), 0.0);
    EXPECT_LE(entry["fraction"].get<double>(), 1.0);
  }
  EXPECT_EQ(jobs, Words({"press", "continuum"}));
}

TEST(Run, CalibratesIntoRunsAndItsConstantsGoIntoAPress) {
  const Workplace folder;
  folder.run("calibrate");
  ASSERT_TRUE(fs::is_directory(folder / "runs"));
  const std::string name = fs::directory_iterator(folder / "runs")->path().filename();
  EXPECT_TRUE(name.starts_with("calibrate-")) << name;
  EXPECT_NEAR(folder.json("runs/" + name + "/calibration.json")["achieved"]["youngs_modulus_110"],
              3922.66, 1e-5);
  folder.run("press --out pressed",
             coarse + Words{"lattice.constants=runs/" + name + "/material.toml"});
  EXPECT_NEAR(folder.json("pressed/summary.json")["moduli"]["E_100"], 3922.66, 1e-5);
}

TEST(Run, APressBeyondItsMaterialSaysSoEverywhere) {
  const Workplace folder;
  folder.run("calibrate --out fit");
  std::string material = folder.text("fit/material.toml");
  EXPECT_TRUE(says(material, "program = \"fingertip "));
  const std::string section = "[validity]\n";
  ASSERT_TRUE(says(material, section));
  material.insert(material.find(section) + section.size(),
                  "largest_indentation = \"0.0001 m\"\nthickness = \"0.005 m\"\n");
  folder.put("fit/material.toml", material);
  const Words settings = {"lattice.constants=fit/material.toml", "lattice.spacing=tip_radius/6",
                          "press.mode=static"};
  const std::string warning = "material.toml: the press goes to 60 % of the rubber's thickness";
  for (const std::string out : {"computed", "cached"}) {
    EXPECT_TRUE(says(folder.run("press --out " + out, settings).err, "note: " + warning));
    EXPECT_TRUE(says(folder.text(out + "/log.txt"), warning));
    const json warnings = folder.json(out + "/summary.json")["warnings"];
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].get<std::string>().find(warning), 0U);
  }
  EXPECT_TRUE(omits(folder.run("modes --out modes", settings).err, warning)) << "none is pressed";
  EXPECT_FALSE(folder.json("modes/summary.json").contains("warnings"));
}

TEST(Run, InterruptLeavesAReadableFolderThatCanBeResumed) {
  const Workplace folder;
  Program program =
      folder.start("press --out run", {"lattice.spacing=tip_radius/10", "press.speed=0.3 cm/s"});
  // Long enough for first results, far from long enough to finish.
  ASSERT_TRUE(folder.comes("run/summary.json"));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  EXPECT_EQ(folder.json("run/manifest.json")["status"], "interrupted");
  EXPECT_EQ(folder.json("run/summary.json")["status"], "interrupted");
  EXPECT_NO_THROW(folder.response("run"));
  EXPECT_FALSE(folder.has("run/finished.json"));
  // What is half done is not mistaken for a result.
  folder.run("press --out run --resume auto",
             {"lattice.spacing=tip_radius/6", "press.depth=0.02 cm"});
  EXPECT_EQ(folder.json("run/manifest.json")["status"], "finished");
}

// Within 2 % of the continuum's known curve (tests/fem_reference/data), with the shape of a run.
TEST(Run, StaticPressAgreesWithTheContinuum) {
  const Workplace folder;
  folder.run("press --out run",
             {"press.mode=static", "press.contact=frictionless", "lattice.spacing=tip_radius/8",
              R"(press.samples=["0.1 cm", "0.3 cm"])"});
  folder.expect_files("run",
                      {"parameters.toml", "manifest.json", "response.csv", "contact_field.csv"});
  EXPECT_EQ(folder.json("run/summary.json")["status"], "finished");
  const PressResponse response = folder.response("run");
  ASSERT_EQ(response.samples().size(), 2U);
  const double gram_force = 9.80665e-3;
  EXPECT_NEAR(response.samples()[0].normal_force / gram_force, 3.25628, 0.02 * 3.25628);
  EXPECT_NEAR(response.samples()[1].normal_force / gram_force, 19.42179, 0.02 * 19.42179);
  EXPECT_TRUE(std::isnan(response.samples()[0].time)) << "there is none";
}

// From the fields of lattice and continuum; Hertz' 3 pi/16 mu N a is not far.
TEST(Run, TheLimitSurfaceOfAPress) {
  const Workplace folder;
  const Words stick = {"press.mode=static", "press.contact=stick", "lattice.spacing=tip_radius/8",
                       R"(press.samples=["0.1 cm", "0.2 cm"])"};
  folder.run("press --out run", stick);
  const std::string screen = folder.run("limit-surface run").out;
  EXPECT_TRUE(says(screen, {"Greatest moment/mu", "gamma = 0.2", "limit_surface.csv"})) << screen;
  const auto table = fingertip::meshes::read_csv(folder / "run/limit_surface.csv");
  ASSERT_GT(table.rows.size(), 20U);
  const double force = folder.response("run").samples()[0].normal_force;
  const auto samples = table.numbers("sample"), forces = table.numbers("force [N]"),
             moments = table.numbers("moment [N m]");
  double greatest = 0.0, most = 0.0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (samples[i] != 1.0) continue;
    greatest = std::max(greatest, forces[i]);
    most = std::max(most, moments[i]);
  }
  EXPECT_NEAR(greatest, force, 1e-6 * force);
  const double radius = folder.response("run").samples()[0].contact_radius;
  EXPECT_NEAR(most, 0.589 * force * radius, 0.03 * most);
  folder.run("press --out slides", stick + Words{"press.contact=frictionless"});
  EXPECT_TRUE(says(folder.run("limit-surface slides", {}, 2).err, "without friction"));
  EXPECT_TRUE(says(folder.run("limit-surface", {}, 2).err, "no run folder"));
  EXPECT_TRUE(says(folder.run("limit-surface run slides/nothing", {}, 2).err, "no such folder"));
}

// Pressed and then turned under friction, there and back, beside the continuum: on the screen, in
// the folder, on its page and beside another run.
TEST(Run, ATwistFollowsTheStaticPressUnderFriction) {
  const Workplace folder;
  const Words settings = {"press.mode=static",
                          "lattice.spacing=tip_radius/4",
                          "press.contact=coulomb",
                          "press.lateral_samples=1",
                          R"(press.samples=["0.1 cm"])",
                          R"(press.program=[["1 mm", "1 cm/s"], ["twist", "5 deg", "1 deg/s"], )"
                          R"(["twist", "-5 deg", "1 deg/s"]])"};
  const std::string screen = folder.run("press --out one", settings).out;
  EXPECT_TRUE(says(screen, {"then along the plane at 1 mm", "Torque about the normal",
                            "twist to -5 deg", "force error from the continuum"}));
  const PressResponse response = folder.response("one");
  ASSERT_EQ(response.following().size(), 2U);
  EXPECT_GT(response.following()[0].spin_torque, 0.0);
  EXPECT_LT(response.following()[1].spin_torque, 0.0);
  EXPECT_GT(response.following()[1].torque_error, 0.0);
  EXPECT_GT(folder.json("one/summary.json").at("loop_area").get<double>(), 0.0);
  folder.run("report one");
  const std::string title = "Torque about the normal against twist";
  EXPECT_TRUE(says(folder.text("one/report.html"), title));
  folder.run("reference --out two", settings);
  const std::string both = folder.run("compare two one").out;
  EXPECT_TRUE(says(both, "torque about the normal at full depth"));
  folder.expect_refused("press --out three", {"press.twist=5 deg"}, {"press.twist = 5 deg"});
}

// Pressed first and moved then: on the screen, in the folder, on its page and beside another run.
TEST(Run, ALateralMotionFollowsTheStaticPress) {
  const Workplace folder;
  const Words lateral = {"press.lateral=0.2 mm", "press.lateral_path=after"};
  const auto press = [&](const std::string& out, const std::string& change) {
    return folder.run("press --out " + out,
                      Words{"press.mode=static", "lattice.spacing=tip_radius/4", change,
                            R"(press.samples=["0.05 cm", "0.1 cm"])", "press.lateral_samples=2"} +
                          lateral);
  };
  EXPECT_TRUE(
      says(press("one", "lattice.spacing=tip_radius/4").out, "then along the plane at 1 mm"));
  const PressResponse response = folder.response("one");
  ASSERT_EQ(response.pressing().size(), 2U);
  ASSERT_EQ(response.sliding().size(), 2U);
  EXPECT_EQ(response.sliding()[0].lateral_displacement, 1e-4);
  EXPECT_EQ(response.sliding()[1].lateral_displacement, 2e-4);
  EXPECT_GT(response.sliding()[1].lateral_force_x, response.sliding()[0].lateral_force_x);
  folder.run("report one");
  const std::string title = "Lateral force against lateral displacement";
  EXPECT_TRUE(says(folder.text("one/report.html"), title));
  press("two", "lattice.spacing=tip_radius/5");
  const std::string both = folder.run("compare one two").out;
  EXPECT_TRUE(says(both, "lateral force at full depth"));
  EXPECT_TRUE(omits(both, "WARNING"));

  // Without friction the page tells that, not what solvers leave of nothing.
  press("free", "press.contact=frictionless");
  folder.run("report free");
  const std::string free = folder.text("free/report.html");
  EXPECT_TRUE(says(free, "the plane slides free and pushes it with"));
  EXPECT_TRUE(omits(free, title));

  folder.expect_refused("press --out three", lateral, {"press.lateral_path = after"});
  folder.expect_refused("calibrate --out four", Words{"calibration.problem=curve"} + lateral,
                        {"press.lateral_path = after"});
}

// Pressed, held and lifted: on the screen, in the folder, on its page and beside another run.
TEST(Run, APressInStagesTellsRelaxationAndLoop) {
  const Workplace folder;
  const std::string program = R"(press.program=[["1 mm", "20 mm/s"], ["hold", "0.1 s"])";
  const auto press = [&](const std::string& out, const std::string& change,
                         const std::string& last = R"(["-0.1 mm", "20 mm/s"])") {
    return folder.run("press --out " + out,
                      {"press.mode=quasi-static", "lattice.spacing=tip_radius/4", change,
                       program + ", " + last + "]"});
  };
  EXPECT_TRUE(says(press("one", "rubber.retardation_time=1 ms").out,
                   {"hold ", "Relaxed\n", "(area of the loop)"}));
  const PressResponse response = folder.response("one");
  EXPECT_EQ(response.pressing().back().indentation, 1e-3);
  ASSERT_EQ(response.following().size(), 20U);
  EXPECT_EQ(response.following()[9].stage, 2.0);
  EXPECT_EQ(response.following().back().indentation, -1e-4);
  const json summary = folder.json("one/summary.json");
  ASSERT_EQ(summary["program"].size(), 3U);
  const json& hold = summary["program"][1];
  EXPECT_EQ(hold["kind"], "hold");
  EXPECT_NEAR(double(hold["end"]) - double(hold["begin"]), 0.1, 1e-9);
  EXPECT_NEAR(hold["relaxation"], 1.0 - double(hold["end_force"]) / double(hold["begin_force"]),
              1e-12);
  EXPECT_GT(summary["loop_area"], 0.0);
  EXPECT_GT(summary["work_in"], summary["loop_area"]);
  folder.run("report one");
  EXPECT_TRUE(says(folder.text("one/report.html"), "Normal force and indentation in time"));
  folder.run("press --config one/parameters.toml --out again");

  press("two", "rubber.retardation_time=2 ms");
  EXPECT_TRUE(says(folder.run("compare one two").out, "after the first loading"));
  press("other", "rubber.retardation_time=2 ms", R"(["0.5 mm", "20 mm/s"])");
  EXPECT_TRUE(says(folder.run("compare one other").out, "do not go through the same stages"));

  press("rest", "press.mode=static");
  EXPECT_EQ(folder.response("rest").following().size(), 10U);
  folder.run("report rest");
  folder.expect_refused("press --out force", {"controller.type=force", program + "]"},
                        {"press.program"});
}

// The continuum's lowest frequencies are 49.18, 54.15 (twice) and 62.57 Hz
// (fem_reference/README.md).
TEST(Run, ModesOfTheLatticeAreThoseOfTheContinuum) {
  const Workplace folder;
  folder.run("modes --out run", {"lattice.spacing=tip_radius/6", "lattice.modes=4"});
  std::istringstream table(folder.text("run/modes.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_TRUE(line.starts_with("mode,frequency [Hz],motion,")) << line;
  for (const double wanted : {49.18, 54.15, 54.15, 62.57}) {
    ASSERT_TRUE(std::getline(table, line));
    EXPECT_NEAR(std::stod(line.substr(line.find(',') + 1)), wanted, 0.04 * wanted) << line;
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST(Run, CompareTellsDifferences) {
  const Workplace folder;
  folder.run("press --out hookean", coarse);
  folder.run("press --out central", coarse + Words{"lattice.model=central"});
  const std::string told = folder.run("compare hookean central").out;
  EXPECT_TRUE(says(told, "relative L2 difference"));
  EXPECT_TRUE(omits(told, "WARNING"));
  // A second one leaves the first as it is.
  folder.run("compare hookean central");
  EXPECT_EQ(made_in(folder / "runs").size(), 2U);
  folder.run("compare hookean central --out named");
  folder.run("compare hookean central --out named", {}, 2);
  folder.run("compare hookean central --out named --force");
  folder.run("compare hookean", {}, 2);
}
