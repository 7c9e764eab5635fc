#include "studies/fits/setup/fit_tolerances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "calibration/press_fit/lattice_forward_model.h"
#include "studies/files/json_entry.h"
#include "studies/fits/models/described_numbers.h"
#include "studies/fits/runs/fit_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

/// Presses of a coarse lattice, frictionless on a plane; Poisson's ratio 0.45 unless it is untold.
class FitTolerances : public testing::Test {
 protected:
  FitTolerances() {
    std::ofstream csv(folder_ / "press.csv");
    csv << "indentation [mm];force [mN]\n";
    for (const double depth : {0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6})
      csv << depth << ';' << 30.0 * std::pow(depth, 1.5) << '\n';
  }

  FitSetup setup(const std::vector<std::string>& further, int files = 1,
                 const std::string& ratio = "rubber.poissons_ratio=0.45") {
    std::string data;
    for (int i = 0; i < files; ++i)
      data += (i > 0 ? ", \"" : "\"") + (folder_ / "press.csv").string() + '"';
    std::vector<std::string> sets = {"calibration.problem=experiment",
                                     "calibration.data=[" + data + "]",
                                     "calibration.parameters=[\"modulus\"]",
                                     "calibration.candidates=[]",
                                     "lattice.spacing=tip_radius/6",
                                     "lattice.kinematics=small",
                                     "lattice.model=hookean",
                                     "press.contact=frictionless"};
    if (!ratio.empty()) sets.push_back(ratio);
    sets.insert(sets.end(), further.begin(), further.end());
    return fit_setup(load_config({{}, sets, {}}));
  }

  static const KnownError* found(const FitSetup& fit, const std::string& name) {
    const auto place = std::ranges::find(fit.input.known_errors, name, &KnownError::name);
    return place == fit.input.known_errors.end() ? nullptr : &*place;
  }

  /// calibration.json of a fit to what `pressed` answers at this modulus [Pa].
  nlohmann::ordered_json fitted(FitSetup fit, const FitSetup& pressed, double modulus,
                                const std::string& name) {
    for (std::size_t i = 0; i < fit.input.curves.size(); ++i) {
      const Eigen::VectorXd forces = calibration::LatticeForwardModel(pressed.input.curves[i].press,
                                                                      parameters_of(pressed.input))
                                         .evaluate(Eigen::VectorXd::Constant(1, modulus))
                                         .value;
      fit.input.curves[i].y.assign(forces.begin(), forces.end());
    }
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    fs::create_directories(folder_ / name);
    fit_job(fit.input).run(folder_ / name, context);
    return parse_json(folder_ / name / "calibration.json");
  }

  const TemporaryFolder folder_;
};

}  // namespace

TEST_F(FitTolerances, NumbersNobodyTellsDoNotCount) {
  const FitSetup fit = setup({});
  EXPECT_TRUE(fit.input.known_errors.empty());
  const std::vector<KnownError> untold = untold_numbers(fit.input);
  ASSERT_EQ(untold.size(), 3u) << "a plane has no radius";
  EXPECT_EQ(untold[0].name, "tip_radius");
  EXPECT_DOUBLE_EQ(untold[0].step, 1e-4) << "a hundredth";
  EXPECT_EQ(untold[1].name, "rod_radius");
  EXPECT_EQ(untold[2].name, "poissons_ratio");
  EXPECT_DOUBLE_EQ(untold[2].step, 0.01);
}

TEST_F(FitTolerances, AnUntoldRatioIsAnywhereFrom045To05) {
  const KnownError* untold = nullptr;
  const FitSetup fit = setup({}, 1, "rubber.youngs_modulus=60 kPa");
  ASSERT_NE(untold = found(fit, "poissons_ratio"), nullptr);
  EXPECT_NEAR(untold->step, (0.4999 - 0.45) / std::sqrt(12.0), 1e-12);
  const FitSetup told = setup({"calibration.poisson_range=[0.4, 0.48]"});
  EXPECT_NEAR(found(told, "poissons_ratio")->step, 0.08 / std::sqrt(12.0), 1e-12);
  // Nothing of it is held where it is sought.
  const FitSetup sought =
      setup({"calibration.parameters=[\"youngs_modulus\", \"shear_modulus\"]"}, 1);
  EXPECT_EQ(found(sought, "poissons_ratio"), nullptr);
}

/// Two fingers from two moulds; one obstacle.
TEST_F(FitTolerances, OneNumberIsOneError) {
  const FitSetup fit =
      setup({"calibration.conditions=[\"geometry.rod_radius=5 mm\", \"geometry.rod_radius=6 mm\"]",
             "calibration.tolerances={rod_radius = \"0.1 mm\", tip_radius = \"0.2 mm\"}"},
            2);
  const KnownError *first = found(fit, "rod_radius of 0.005"),
                   *second = found(fit, "rod_radius of 0.006"), *tip = found(fit, "tip_radius");
  ASSERT_TRUE(first && second && tip);
  const auto at = [&](const KnownError* error, std::size_t curve) {
    return fit.input.curves[curve].known_errors[std::size_t(error - fit.input.known_errors.data())];
  };
  EXPECT_FALSE(at(first, 0).empty());
  EXPECT_TRUE(at(first, 1).empty());
  EXPECT_TRUE(at(second, 0).empty());
  EXPECT_GT(at(second, 1).back(), at(first, 0).back()) << "of a thinner layer it is more";
  for (const std::size_t curve : {0u, 1u}) EXPECT_LT(at(tip, curve).back(), 0.0);
}

TEST_F(FitTolerances, RefusesWhatIsNoneOrOfNoPress) {
  EXPECT_THROW_SAYING(setup({"calibration.tolerances={rod_radius = \"fit\"}"}),
                      meshes::InvalidInput, Parts({"rod_radius", "one positive quantity"}));
  EXPECT_THROW_SAYING(setup({"calibration.tolerances={tilt = \"0 deg\"}"}), meshes::InvalidInput,
                      "one positive quantity");
  EXPECT_THROW_SAYING(setup({"calibration.tolerances={obstacle_radius = \"1 mm\"}"}),
                      meshes::InvalidInput, "no press of the fit has this number");
  EXPECT_THROW_SAYING(setup({"calibration.tolerances={thickness = \"1 mm\"}"}),
                      meshes::InvalidInput, Parts({"knows no thickness", "did you mean"}));
}

/// Fingers whose rod is 0.15 mm thicker than told: the estimate is off by what is told of such an
/// error, and the interval of who told that tolerance holds the truth.
TEST_F(FitTolerances, WhatAWrongSizeDoesIsToldAndCovered) {
  const double truth = 60e3;
  const FitSetup thicker = setup({"geometry.rod_radius=5.15 mm"}, 2);
  const auto told = [&](const char* tolerance, const std::string& name) {
    return fitted(setup({"geometry.rod_radius=5 mm", tolerance}, 2), thicker, truth, name);
  };
  const auto exact = told("calibration.tolerances={tilt = \"0.1 deg\"}", "exact"),
             known = told("calibration.tolerances={rod_radius = \"0.15 mm\"}", "known");
  const double estimate = exact["parameters"][0]["estimate"].get<double>();
  EXPECT_GT(estimate, 1.02 * truth);
  const auto half = [](const nlohmann::ordered_json& fit) {
    const auto& entry = fit["parameters"][0];
    return 0.5 * (entry["upper"].get<double>() - entry["lower"].get<double>());
  };
  EXPECT_GT(half(known), std::hypot(half(exact), 1.5 * (estimate - truth)));
  for (const auto& entry : known["sensitivities"]) {
    if (entry["name"] != "rod_radius") continue;
    EXPECT_TRUE(entry["counts"].get<bool>());
    EXPECT_NEAR(entry["changes"]["modulus"].get<double>(), truth - estimate,
                0.3 * (estimate - truth));
  }
  EXPECT_TRUE(says(known["statement"].get<std::string>(),
                   Parts({"3 % more of rod_radius would make modulus", "the intervals hold"})));
}
