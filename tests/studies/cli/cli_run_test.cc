// Runs of the real program on a coarse lattice.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "meshes/press/press_response.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

const std::vector<std::string> coarse_press = {"press", "--set", "lattice.spacing=tip_radius/6",
                                               "--set", "press.depth=0.05 cm"};

std::vector<std::string> with(std::vector<std::string> words, std::vector<std::string> more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

json json_of(const fs::path& file) {
  return json::parse(read_text(file));
}

}  // namespace

TEST(Run, PressWritesACompleteFolderThatCanBeRunAgain) {
  const TemporaryFolder folder;
  const ProgramResult first = run_program(folder.path(), with(coarse_press, {"--out", "one"}));
  ASSERT_EQ(first.code, 0) << first.err;
  for (const char* file : {"parameters.toml", "manifest.json", "log.txt", "summary.json",
                           "response.csv", "trace.csv", "boundary.csv", "boundary_springs.csv"}) {
    EXPECT_TRUE(fs::exists(folder / "one" / file)) << file;
  }
  const json manifest = json_of(folder / "one/manifest.json");
  EXPECT_EQ(manifest["status"], "finished");
  EXPECT_EQ(manifest["exit_code"], 0);
  const json summary = json_of(folder / "one/summary.json");
  EXPECT_EQ(summary["model"], "hookean");
  EXPECT_LT(summary["momentum_defect"].get<double>(), 1e-9);
  const PressResponse response = PressResponse::read_csv(folder / "one/response.csv");
  EXPECT_NEAR(response.depth(), 0.0005, 1e-9);

  fs::remove_all(folder / "cache");
  const ProgramResult again =
      run_program(folder.path(),
                  {"press", "--config", "one/parameters.toml", "--out", "two", "--threads", "1"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_text(folder / "one/response.csv"), read_text(folder / "two/response.csv"));
}

TEST(Run, EqualInputComesFromTheCache) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), with(coarse_press, {"--out", "one"})).code, 0);
  const ProgramResult again = run_program(folder.path(), with(coarse_press, {"--out", "two"}));
  EXPECT_EQ(again.code, 0);
  EXPECT_NE(again.out.find("earlier run"), std::string::npos) << again.out;
  EXPECT_EQ(read_text(folder / "one/trace.csv"), read_text(folder / "two/trace.csv"));
  EXPECT_NE(read_text(folder / "two/log.txt").find("from the cache"), std::string::npos);
}

TEST(Run, AMovieIsPartOfAPressWithAKeyOfItsOwn) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), with(coarse_press, {"--out", "plain"})).code, 0);
  EXPECT_FALSE(fs::exists(folder / "plain/movie"));
  EXPECT_TRUE(fs::exists(folder / "plain/snapshot_points.csv"));
  const std::vector<std::string> filmed = with(coarse_press, {"--movie", "5"});
  const ProgramResult first = run_program(folder.path(), with(filmed, {"--out", "one"}));
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.out.find("earlier run"), std::string::npos) << first.out;
  EXPECT_TRUE(fs::exists(folder / "one/movie/frame_0004.vtu"));
  EXPECT_FALSE(fs::exists(folder / "one/movie/frame_0005.vtu"));
  const ProgramResult again = run_program(folder.path(), with(filmed, {"--out", "two"}));
  EXPECT_NE(again.out.find("earlier run"), std::string::npos) << again.out;
  EXPECT_EQ(read_text(folder / "one/movie/movie.pvd"), read_text(folder / "two/movie/movie.pvd"));
  EXPECT_EQ(read_text(folder / "plain/trace.csv"), read_text(folder / "one/trace.csv"));
  const ProgramResult none = run_program(
      folder.path(), {"press", "--movie", "--set", "press.mode=static", "--out", "none"});
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("a press without time has no movie"), std::string::npos) << none.err;
}

TEST(Run, ForceReplacesAndResumeKeeps) {
  const TemporaryFolder folder;
  const auto words = with(coarse_press, {"--out", "run"});
  ASSERT_EQ(run_program(folder.path(), words).code, 0);
  EXPECT_EQ(run_program(folder.path(), words).code, 2);
  EXPECT_EQ(run_program(folder.path(), with(words, {"--force"})).code, 0);
  EXPECT_EQ(run_program(folder.path(), with(words, {"--resume", "auto"})).code, 0);
  // Bad input after --force costs nothing of what is there.
  EXPECT_EQ(run_program(folder.path(), with(words, {"--force", "--set", "run.time_step=1 s"})).code,
            2);
  EXPECT_EQ(json_of(folder / "run/manifest.json")["status"], "finished");
}

TEST(Run, QuietAndJsonProgress) {
  const TemporaryFolder folder;
  ProgramResult result =
      run_program(folder.path(), with(coarse_press, {"--out", "quiet", "--quiet"}));
  EXPECT_EQ(result.out + result.err, "");
  fs::remove_all(folder / "cache");
  result = run_program(folder.path(), with(coarse_press, {"--out", "json", "--progress", "json"}));
  std::istringstream lines(result.err);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const json entry = json::parse(line);
    EXPECT_EQ(entry["job"], "press");
    EXPECT_GE(entry["fraction"].get<double>(), 0.0);
    EXPECT_LE(entry["fraction"].get<double>(), 1.0);
  }
  EXPECT_GT(count, 0);
}

TEST(Run, DefaultFolderLiesUnderRuns) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"calibrate"}).code, 0);
  ASSERT_TRUE(fs::is_directory(folder / "runs"));
  const fs::path made = fs::directory_iterator(folder / "runs")->path();
  EXPECT_TRUE(made.filename().string().starts_with("calibrate-")) << made;
  const json calibration = json_of(made / "calibration.json");
  EXPECT_NEAR(calibration["achieved"]["youngs_modulus_110"].get<double>(), 3922.66, 1e-5);
  EXPECT_TRUE(fs::exists(made / "material.toml"));
}

TEST(Run, CalibratedConstantsGoIntoAPress) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"calibrate", "--out", "fit"}).code, 0);
  const ProgramResult result = run_program(
      folder.path(),
      with(coarse_press, {"--set", "lattice.constants=fit/material.toml", "--out", "pressed"}));
  ASSERT_EQ(result.code, 0) << result.err;
  const json moduli = json_of(folder / "pressed/summary.json")["moduli"];
  EXPECT_NEAR(moduli["E_100"].get<double>(), 3922.66, 1e-5);
}

TEST(Run, APressBeyondItsMaterialSaysSoEverywhere) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"calibrate", "--out", "fit"}).code, 0);
  std::string material = read_text(folder / "fit/material.toml");
  EXPECT_NE(material.find("program = \"fingertip "), std::string::npos);
  const std::string section = "[validity]\n";
  ASSERT_NE(material.find(section), std::string::npos);
  material.insert(material.find(section) + section.size(),
                  "largest_indentation = \"0.0001 m\"\nthickness = \"0.005 m\"\n");
  write_text(folder / "fit/material.toml", material);
  const std::vector<std::string> sets = {"--set", "lattice.constants=fit/material.toml",
                                         "--set", "lattice.spacing=tip_radius/6",
                                         "--set", "press.mode=static"};
  const std::string warning = "material.toml: the press goes to 60 % of the rubber's thickness";
  const auto run = [&](const char* verb, const std::string& out) {
    std::vector<std::string> words = {verb};
    words.insert(words.end(), sets.begin(), sets.end());
    words.insert(words.end(), {"--out", out});
    return run_program(folder.path(), words);
  };
  for (const char* out : {"computed", "cached"}) {
    const ProgramResult result = run("press", out);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.err.find("note: " + warning), std::string::npos) << result.err;
    EXPECT_NE(read_text(folder / out / "log.txt").find(warning), std::string::npos);
    const json warnings = json_of(folder / out / "summary.json")["warnings"];
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0].get<std::string>().find(warning), 0U);
  }
  const ProgramResult modes = run("modes", "modes");
  ASSERT_EQ(modes.code, 0) << modes.err;
  EXPECT_EQ(modes.err.find(warning), std::string::npos) << "nothing is pressed";
  EXPECT_FALSE(json_of(folder / "modes/summary.json").contains("warnings"));
}

TEST(Run, InterruptLeavesAReadableFolderThatCanBeResumed) {
  const TemporaryFolder folder;
  const std::vector<std::string> words = {
      "press", "--set", "lattice.spacing=tip_radius/10", "--set", "press.speed=0.3 cm/s",
      "--out", "run"};
  Program program(folder.path(), words);
  // Long enough for first results, far from long enough to finish.
  for (int i = 0; i < 600 && !fs::exists(folder / "run/summary.json"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  program.send(SIGINT);
  const ProgramResult result = program.wait();
  EXPECT_EQ(result.code, 130) << result.err;
  const json manifest = json_of(folder / "run/manifest.json");
  EXPECT_EQ(manifest["status"], "interrupted");
  EXPECT_EQ(json_of(folder / "run/summary.json")["status"], "interrupted");
  EXPECT_NO_THROW(PressResponse::read_csv(folder / "run/response.csv"));
  EXPECT_FALSE(fs::exists(folder / "run/finished.json"));
  // What is half done is not mistaken for a result.
  const ProgramResult resumed =
      run_program(folder.path(), {"press", "--set", "lattice.spacing=tip_radius/6", "--set",
                                  "press.depth=0.02 cm", "--out", "run", "--resume", "auto"});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(json_of(folder / "run/manifest.json")["status"], "finished");
}

// Within 2 % of the continuum's known curve (tests/fem_reference/data), with the shape of a run.
TEST(Run, StaticPressAgreesWithTheContinuum) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(
      folder.path(),
      {"press", "--out", "run", "--set", "press.mode=static", "--set", "press.contact=frictionless",
       "--set", "lattice.spacing=tip_radius/8", "--set", "press.samples=[\"0.1 cm\", \"0.3 cm\"]"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* file : {"parameters.toml", "manifest.json", "response.csv", "contact.csv"}) {
    EXPECT_TRUE(fs::exists(folder / "run" / file)) << file;
  }
  EXPECT_EQ(json_of(folder / "run/summary.json")["status"], "finished");
  const PressResponse response = PressResponse::read_csv(folder / "run/response.csv");
  ASSERT_EQ(response.samples().size(), 2U);
  const double gram_force = 9.80665e-3;
  EXPECT_NEAR(response.samples()[0].normal_force / gram_force, 3.25628, 0.02 * 3.25628);
  EXPECT_NEAR(response.samples()[1].normal_force / gram_force, 19.42179, 0.02 * 19.42179);
  EXPECT_TRUE(std::isnan(response.samples()[0].time)) << "there is none";
}

// Pressed first and moved then: on the screen, in the folder, on its page and beside another run.
TEST(Run, ALateralMotionFollowsTheStaticPress) {
  const TemporaryFolder folder;
  const auto press = [&](const char* out, const char* change) {
    return run_program(folder.path(),
                       {"press", "--out", out, "--set", "press.mode=static", "--set",
                        "lattice.spacing=tip_radius/4", "--set", change, "--set",
                        "press.samples=[\"0.05 cm\", \"0.1 cm\"]", "--set", "press.lateral=0.2 mm",
                        "--set", "press.lateral_path=after", "--set", "press.lateral_samples=2"});
  };
  const ProgramResult result = press("one", "lattice.spacing=tip_radius/4");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("then along the plane at 1 mm"), std::string::npos) << result.out;
  const PressResponse response = PressResponse::read_csv(folder / "one/response.csv");
  ASSERT_EQ(response.pressing().size(), 2U);
  ASSERT_EQ(response.sliding().size(), 2U);
  EXPECT_EQ(response.sliding()[0].lateral_displacement, 1e-4);
  EXPECT_EQ(response.sliding()[1].lateral_displacement, 2e-4);
  EXPECT_GT(response.sliding()[1].lateral_force_x, response.sliding()[0].lateral_force_x);
  ASSERT_EQ(run_program(folder.path(), {"report", "one"}).code, 0);
  EXPECT_NE(
      read_text(folder / "one/report.html").find("Lateral force against lateral displacement"),
      std::string::npos);
  ASSERT_EQ(press("two", "lattice.spacing=tip_radius/5").code, 0);
  const ProgramResult beside = run_program(folder.path(), {"compare", "one", "two"});
  ASSERT_EQ(beside.code, 0) << beside.err;
  EXPECT_NE(beside.out.find("lateral force at full depth"), std::string::npos) << beside.out;
  EXPECT_EQ(beside.out.find("WARNING"), std::string::npos) << beside.out;

  // Without friction the page tells that, not what solvers leave of nothing.
  ASSERT_EQ(press("free", "press.contact=frictionless").code, 0);
  ASSERT_EQ(run_program(folder.path(), {"report", "free"}).code, 0);
  const std::string free = read_text(folder / "free/report.html");
  EXPECT_NE(free.find("the plane slides free and pushes it with"), std::string::npos);
  EXPECT_EQ(free.find("Lateral force against lateral displacement"), std::string::npos);

  const ProgramResult moving =
      run_program(folder.path(), {"press", "--out", "three", "--set", "press.lateral=0.2 mm",
                                  "--set", "press.lateral_path=after"});
  EXPECT_EQ(moving.code, 2);
  EXPECT_NE(moving.err.find("press.lateral_path = after"), std::string::npos) << moving.err;
  const ProgramResult fit = run_program(
      folder.path(), {"calibrate", "--set", "calibration.problem=curve", "--out", "four", "--set",
                      "press.lateral=0.2 mm", "--set", "press.lateral_path=after"});
  EXPECT_EQ(fit.code, 2);
  EXPECT_NE(fit.err.find("press.lateral_path = after"), std::string::npos) << fit.err;
}

// Pressed, held and lifted: on the screen, in the folder, on its page and beside another run.
TEST(Run, APressInStagesTellsRelaxationAndLoop) {
  const TemporaryFolder folder;
  const auto press = [&](const char* out, const char* change, const char* last) {
    return run_program(
        folder.path(),
        {"press", "--out", out, "--set", "press.mode=quasi-static", "--set",
         "lattice.spacing=tip_radius/4", "--set", change, "--set",
         std::string(R"(press.program=[["1 mm", "20 mm/s"], ["hold", "0.1 s"], )") + last + "]"});
  };
  const char* const up = R"(["-0.1 mm", "20 mm/s"])";
  const ProgramResult result = press("one", "rubber.retardation_time=1 ms", up);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("stage 2: hold at 1 mm, "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("relaxed by "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("(area of the loop)"), std::string::npos) << result.out;
  const PressResponse response = PressResponse::read_csv(folder / "one/response.csv");
  EXPECT_EQ(response.pressing().back().indentation, 1e-3);
  ASSERT_EQ(response.following().size(), 20U);
  EXPECT_EQ(response.following()[9].stage, 2.0);
  EXPECT_EQ(response.following().back().indentation, -1e-4);
  const auto summary = nlohmann::json::parse(read_text(folder / "one/summary.json"));
  ASSERT_EQ(summary["program"].size(), 3U);
  EXPECT_EQ(summary["program"][1]["kind"], "hold");
  EXPECT_NEAR(double(summary["program"][1]["end"]) - double(summary["program"][1]["begin"]), 0.1,
              1e-9);
  EXPECT_NEAR(summary["program"][1]["relaxation"],
              1.0 - double(summary["program"][1]["end_force"]) /
                        double(summary["program"][1]["begin_force"]),
              1e-12);
  EXPECT_GT(summary["loop_area"], 0.0);
  EXPECT_GT(summary["work_in"], summary["loop_area"]);
  ASSERT_EQ(run_program(folder.path(), {"report", "one"}).code, 0);
  EXPECT_NE(read_text(folder / "one/report.html").find("Normal force and indentation in time"),
            std::string::npos);
  EXPECT_EQ(
      run_program(folder.path(), {"press", "--config", "one/parameters.toml", "--out", "again"})
          .code,
      0);

  ASSERT_EQ(press("two", "rubber.retardation_time=2 ms", up).code, 0);
  const ProgramResult beside = run_program(folder.path(), {"compare", "one", "two"});
  ASSERT_EQ(beside.code, 0) << beside.err;
  EXPECT_NE(beside.out.find("after the first loading"), std::string::npos) << beside.out;
  ASSERT_EQ(press("other", "rubber.retardation_time=2 ms", R"(["0.5 mm", "20 mm/s"])").code, 0);
  const ProgramResult other = run_program(folder.path(), {"compare", "one", "other"});
  ASSERT_EQ(other.code, 0) << other.err;
  EXPECT_NE(other.out.find("do not go through the same stages"), std::string::npos) << other.out;

  const ProgramResult rest = press("rest", "press.mode=static", up);
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(PressResponse::read_csv(folder / "rest/response.csv").following().size(), 10U);
  ASSERT_EQ(run_program(folder.path(), {"report", "rest"}).code, 0);
  const ProgramResult force = run_program(
      folder.path(), {"press", "--out", "force", "--set", "controller.type=force", "--set",
                      R"(press.program=[["1 mm", "20 mm/s"], ["hold", "0.1 s"]])"});
  EXPECT_EQ(force.code, 2);
  EXPECT_NE(force.err.find("press.program"), std::string::npos) << force.err;
}

// The continuum's lowest frequencies are 49.18, 54.15 (twice) and 62.57 Hz
// (fem_reference/README.md).
TEST(Run, ModesOfTheLatticeAreThoseOfTheContinuum) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), {"modes", "--out", "run", "--set", "lattice.spacing=tip_radius/6",
                                  "--set", "lattice.modes=4"});
  ASSERT_EQ(result.code, 0) << result.err;
  std::istringstream table(read_text(folder / "run/modes.csv"));
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
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), with(coarse_press, {"--out", "hookean"})).code, 0);
  ASSERT_EQ(run_program(folder.path(),
                        with(coarse_press, {"--out", "central", "--set", "lattice.model=central"}))
                .code,
            0);
  const ProgramResult result = run_program(folder.path(), {"compare", "hookean", "central"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("relative L2 difference"), std::string::npos);
  EXPECT_EQ(result.out.find("WARNING"), std::string::npos) << result.out;
  // A second one leaves the first as it is.
  EXPECT_EQ(run_program(folder.path(), {"compare", "hookean", "central"}).code, 0);
  EXPECT_EQ(made_in(folder / "runs").size(), 2U);
  const std::vector<std::string> named = {"compare", "hookean", "central", "--out", "named"};
  EXPECT_EQ(run_program(folder.path(), named).code, 0);
  EXPECT_EQ(run_program(folder.path(), named).code, 2);
  EXPECT_EQ(run_program(folder.path(), with(named, {"--force"})).code, 0);
  EXPECT_EQ(run_program(folder.path(), {"compare", "hookean"}).code, 2);
}
