/// Fits of presses whose rubber relaxes: the truth is a continuum that relaxes by itself, pressed
/// in time; what fits it knows equilibria and Lee & Radok's integral alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

/// As the key's default, 40 gf/cm².
constexpr double modulus = 3922.66, share = 0.25, fading_time = 0.3;
constexpr const char* given = "rubber.relaxation=[[0.25, \"0.3 s\"]]";
const Words small = {"press.contact=frictionless", "lattice.kinematics=small",
                     "reference.fields=false"};

/// Pressed at 1 cm/s by 2 mm, held for a second, touched at 0.28 mm; `noise` of the largest force.
void measure(const Workplace& folder, double noise) {
  const ProgramResult run =
      folder.run("reference --out press",
                 small + Words{"press.mode=quasi-static", given,
                               R"(press.program=[["2 mm", "1 cm/s"], ["hold", "1 s"]])"},
                 any_code);
  ASSERT_TRUE(run.code == 0 || run.code == 3) << run.err;  // 3: error bars above the tolerance
  const auto response = folder.response("press");
  double largest = 0.0;
  for (const auto& sample : response.samples()) largest = std::max(largest, sample.normal_force);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::ostringstream text;
  text.precision(12);
  text << "position [mm];force [mN];time [s];sigma [mN]\n0.2;0;-0.008;" << 1e3 * noise * largest
       << '\n';
  for (const auto& sample : response.samples())
    text << 0.28 + 1e3 * sample.indentation << ';'
         << 1e3 * (sample.normal_force + noise * largest * normal(random)) << ';' << sample.time
         << ';' << 1e3 * noise * largest << '\n';
  folder.put("travel.csv", text.str());
}

/// E and G of the default, told: an untold Poisson's ratio would be in the intervals.
const Words fit_settings = {"calibration.problem=experiment",   "calibration.data=[\"travel.csv\"]",
                            "calibration.candidates=[]",        "calibration.forward=continuum",
                            "rubber.youngs_modulus=40 gf/cm^2", "rubber.shear_modulus=14 gf/cm^2"};

json fitted(const Workplace& folder, const std::string& out, const Words& settings) {
  folder.run("calibrate --out " + out, small + fit_settings + settings, judged);
  return folder.json(out + "/calibration.json");
}

const json& parameter(const json& fit, const std::string& name) {
  for (const json& each : fit["parameters"])
    if (each["name"] == name) return each;
  ADD_FAILURE() << name;
  return fit["parameters"][0];
}

/// Within three standard errors of the truth, which are no more than `width` of it; what the model
/// may miss unseen is most of that. How often the intervals hold it: fit_coverage_test.
void expect_found(const json& fit, const std::string& name, double truth, double width) {
  const json& own = parameter(fit, name);
  const double estimate = own["estimate"], error = own["standard_error"];
  EXPECT_NEAR(estimate, truth, 3.0 * error) << name;
  EXPECT_LT(3.0 * error, width * truth) << name;
  std::printf("%s = %.5g (%.5g to %.5g), truth %.5g\n", name.c_str(), estimate,
              own["lower"].get<double>(), own["upper"].get<double>(), truth);
}

}  // namespace

TEST(RelaxingPressFit, FindsModulusAndBranchThatAnElasticFitMisses) {
  const Workplace folder;
  measure(folder, 0.002);
  const json elastic = fitted(folder, "elastic", {"calibration.parameters=[\"modulus\"]"});
  const double wrong = parameter(elastic, "modulus")["estimate"];
  std::printf("elastic: modulus = %.5g\n", wrong);
  EXPECT_GT(wrong, 1.15 * modulus) << "what is at once is G0, a third more";
  EXPECT_TRUE(says(elastic["statement"], "\"relaxation\""));

  const json known = fitted(folder, "known", {"calibration.parameters=[\"modulus\"]", given});
  expect_found(known, "modulus", modulus, 0.06);
  EXPECT_GT(known["chi_square_probability"], 1e-2) << known["statement"];

  const json sought =
      fitted(folder, "sought", {"calibration.parameters=[\"modulus\", \"relaxation\"]"});
  expect_found(sought, "modulus", modulus, 0.08);
  expect_found(sought, "relaxation_g1", share, 0.05);
  expect_found(sought, "relaxation_tau1", fading_time, 0.15);
  EXPECT_GT(sought["chi_square_probability"], 1e-2) << sought["statement"];
  EXPECT_EQ(sought["rubber"]["relaxation"].size(), 1U);
  EXPECT_EQ(sought["failed"].size(), 0U) << sought["failed"];

  // The material takes its branches along.
  folder.run("press --out again",
             {"lattice.constants=sought/material.toml", "lattice.spacing=tip_radius/6",
              "press.mode=quasi-static", "press.contact=frictionless", "press.depth=0.5 mm",
              "press.samples=[]"});
  EXPECT_TRUE(says(folder.text("again/parameters.toml"), "relaxation = [[0.2"));
}

TEST(RelaxingPressFit, RefusesWhatItCannotKnow) {
  const Workplace folder;
  std::ostringstream rows;
  for (int i = 1; i <= 20; ++i) rows << 0.1 * i << ';' << std::pow(0.1 * i, 1.5) << '\n';
  folder.put("travel.csv", "indentation [mm];force [mN]\n" + rows.str());
  for (const auto& [settings, words] : std::vector<std::pair<Words, std::string>>{
           {{given}, "depend on time"},
           {{given, "rubber.relaxation_bulk=false", "press.speed=1 mm/s"},
            "rubber.relaxation_bulk"},
           {{R"(calibration.parameters=["modulus", "relaxation_g1"])"}, "relaxation_tau1"},
           {{given, "press.speed=1 mm/s", "calibration.bias=true", "calibration.forward=lattice"},
            "calibration.bias"}})
    folder.expect_refused("calibrate --out out", small + fit_settings + settings, {words});
  const json timed = fitted(folder, "timed",
                            {given, "press.speed=1 mm/s", "calibration.parameters=[\"modulus\"]"});
  EXPECT_EQ(timed["rubber"]["relaxation"][0][1], 0.3);
}
