/// `calibrate` from data to files, on lattices coarse enough for a test.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "meshes/press_response.h"
#include "program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

json read(const fs::path& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream content;
  content << stream.rdbuf();
  return content.str();
}

/// Forces of the lattice itself as a measured file with 1 % sigma and a fixed zigzag of half that.
void write_measured(const fs::path& folder, const std::string& contact, const std::string& name) {
  const ProgramResult press = run_program(
      folder, {"press", "--set", "press.mode=static", "--set", "press.contact=" + contact, "--set",
               "lattice.spacing=tip_radius/5", "--set",
               "press.samples=[\"0.02 cm\",\"0.04 cm\",\"0.06 cm\",\"0.08 cm\",\"0.1 cm\"]",
               "--out", "press_" + contact});
  ASSERT_EQ(press.code, 0) << press.err;
  const auto response =
      fingertip::meshes::PressResponse::read_csv(folder / ("press_" + contact) / "response.csv");
  std::ostringstream csv;
  csv << "# press.contact = \"" << contact << "\"\nindentation [mm],force [mN],sigma [mN]\n";
  double sign = 1.0;
  for (const auto& sample : response.samples()) {
    const double force = 1e3 * sample.normal_force;
    csv << 1e3 * sample.indentation << ',' << force * (1.0 + 0.005 * sign) << ',' << 0.01 * force
        << '\n';
    sign = -sign;
  }
  write_text(folder / name, csv.str());
}

const std::vector<std::string> experiment = {"calibrate",
                                             "--set",
                                             "calibration.problem=experiment",
                                             "--set",
                                             "calibration.bias=false",
                                             "--set",
                                             "lattice.spacing=tip_radius/5"};

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST(Calibrate, FindsTheRubberOfMeasuredPresses) {
  const TemporaryFolder folder;
  write_measured(folder.path(), "frictionless", "a.csv");
  write_measured(folder.path(), "stick", "b.csv");
  const ProgramResult run = run_program(
      folder.path(), with(experiment, {"--set", "calibration.data=[\"a.csv\",\"b.csv\"]", "--set",
                                       "calibration.surrogate=true", "--out", "fit"}));
  ASSERT_EQ(run.code, 0) << run.err;
  const json fit = read(folder / "fit/calibration.json");
  EXPECT_EQ(fit["problem"], "experiment");
  ASSERT_EQ(fit["parameters"].size(), 2u);
  EXPECT_NEAR(fit["parameters"][0]["estimate"].get<double>(), 3922.66, 0.05 * 3922.66);
  EXPECT_NEAR(fit["parameters"][1]["estimate"].get<double>(), 1372.93, 0.05 * 1372.93);
  for (const json& one : fit["parameters"])
    EXPECT_LT(one["lower"].get<double>(), one["upper"].get<double>());
  EXPECT_EQ(fit["curves"][0]["condition"], "frictionless");
  EXPECT_EQ(fit["curves"][1]["condition"], "stick");
  EXPECT_FALSE(fit["chi_square"].is_null());
  EXPECT_FALSE(fit["curves"][0]["left_out"].is_null());
  EXPECT_NE(run.out.find("youngs_modulus"), std::string::npos) << run.out;
  EXPECT_TRUE(fs::exists(folder / "fit/fit_data.csv"));
  EXPECT_TRUE(fs::exists(folder / "fit/surrogate.json"));

  // The material goes into a press.
  const ProgramResult press =
      run_program(folder.path(),
                  {"press", "--set", "press.mode=static", "--set", "lattice.spacing=tip_radius/5",
                   "--set", "press.contact=frictionless", "--set", "press.samples=[\"0.06 cm\"]",
                   "--set", "lattice.constants=fit/material.toml", "--out", "use"});
  ASSERT_EQ(press.code, 0) << press.err;
  const auto was =
      fingertip::meshes::PressResponse::read_csv(folder / "press_frictionless/response.csv");
  const auto is = fingertip::meshes::PressResponse::read_csv(folder / "use/response.csv");
  EXPECT_NEAR(is.normal_force_at(6e-4) / was.normal_force_at(6e-4), 1.0, 0.01);
}

TEST(Calibrate, ResumesAndDoesNotDependOnThreads) {
  const TemporaryFolder folder;
  write_measured(folder.path(), "frictionless", "a.csv");
  write_measured(folder.path(), "stick", "b.csv");
  const auto data = with(experiment, {"--set", "calibration.data=[\"a.csv\",\"b.csv\"]"});
  Program killed(folder.path(), with(data, {"--threads", "1", "--out", "killed"}));
  const fs::path evaluations = folder / "killed/fit/evaluations/curve_2.jsonl";
  for (int wait = 0; wait < 600 && !fs::exists(evaluations); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  killed.send(SIGTERM);
  const ProgramResult stopped = killed.wait();
  if (stopped.code == 0) GTEST_SKIP() << "too fast to be interrupted";
  ASSERT_EQ(stopped.code, 130) << stopped.err;
  const std::string before = text_of(evaluations);
  ASSERT_FALSE(before.empty());

  const ProgramResult resumed = run_program(
      folder.path(), with(data, {"--threads", "1", "--out", "killed", "--resume", "auto"}));
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_TRUE(text_of(evaluations).starts_with(before)) << "evaluations were done again";
  fs::remove_all(folder / "cache");
  const ProgramResult whole =
      run_program(folder.path(), with(data, {"--threads", "2", "--out", "whole"}));
  ASSERT_EQ(whole.code, 0) << whole.err;
  json first = read(folder / "killed/calibration.json"),
       second = read(folder / "whole/calibration.json");
  for (json* one : {&first, &second}) one->erase("wall_time");
  for (std::size_t p = 0; p < 2; ++p) {
    const double a = first["parameters"][p]["estimate"], b = second["parameters"][p]["estimate"];
    const double deviation = first["parameters"][p]["standard_error"];
    EXPECT_NEAR(a, b, 1e-6 * deviation);
  }
}

TEST(Calibrate, RefusesWhatCannotBeFitted) {
  const TemporaryFolder folder;
  write_text(folder / "good.csv", "indentation [mm],force [mN]\n0.2,2\n0.4,6\n0.6,11\n");
  write_text(folder / "no_unit.csv", "indentation,force [mN]\n0.2,2\n");
  struct Attempt {
    std::vector<std::string> words;
    std::string said;
  };
  const std::vector<Attempt> attempts = {
      {{}, "needs measured data"},
      {{"--set", "calibration.data=[\"absent.csv\"]"}, "absent.csv"},
      {{"--set", "calibration.data=[\"no_unit.csv\"]"}, "no_unit.csv:1"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set", "calibration.parameters=[\"young\"]"},
       "calibration.parameters"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set",
        "calibration.profile=[\"youngs_modulus\"]"},
       "calibration.profile"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set", "lattice.model=published"},
       "published"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set", "calibration.prior=0.1"}, "sigma"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set",
        "calibration.conditions=[\"press.contact=stick\", \"press.tilt=5 deg\"]"},
       "calibration.conditions"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set",
        "calibration.conditions=[\"lattice.spacing=tip_radius/4\"]"},
       "press, geometry and reference"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set", "calibration.forward=continuum",
        "--set", "calibration.parameters=[\"k1\"]"},
       "E and G alone"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set",
        "calibration.parameters=[\"youngs_modulus\", \"k1\"]"},
       "described in one way"},
      {{"--set", "calibration.data=[\"good.csv\"]", "--set", "calibration.problem=moduli"},
       "calibration.data"},
  };
  for (const Attempt& attempt : attempts) {
    const ProgramResult run =
        run_program(folder.path(), with(with(experiment, attempt.words), {"--out", "bad"}));
    EXPECT_EQ(run.code, 2) << attempt.said << "\n" << run.err;
    EXPECT_NE(run.err.find(attempt.said), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(folder / "bad"));
  }
}
