#include "studies/cases/fit_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace fingertip::studies;
using nlohmann::ordered_json;

namespace {

Case two_fits() {
  Case one;
  for (const char* name : {"good", "bad"}) one.fits.push_back({name, "", 0.0, {}, ""});
  for (const char* name : {"deeper", "stick"}) one.predictions.push_back({name, "", 0.0, {}, ""});
  one.loaded.config.press.rubber.youngs_modulus = 4000.0;
  return one;
}

ordered_json calibration(double estimate, double lower, double upper, bool open) {
  return {
      {"parameters",
       {{{"name", "youngs_modulus"}, {"estimate", estimate}, {"lower", lower}, {"upper", upper}}}},
      {"unidentifiable", open ? ordered_json::array({1}) : ordered_json::array()}};
}

const std::vector<ordered_json> found = {calibration(4040.0, 3990.0, 4090.0, false),
                                         calibration(4400.0, 4200.0, 4600.0, true)};

}  // namespace

TEST(FitMeasures, AreTakenPerFitAndPrediction) {
  const Case one = two_fits();
  const auto measures = take_fit_measures(one, {{0.01, 0.02}, {0.05, 0.03}}, found);
  EXPECT_DOUBLE_EQ(measures.at("good.deeper"), 0.01);
  EXPECT_DOUBLE_EQ(measures.at("bad.stick"), 0.03);
  EXPECT_DOUBLE_EQ(measures.at("good.worst_error"), 0.02);
  EXPECT_DOUBLE_EQ(measures.at("transfer.worst_error"), 0.05);
  EXPECT_NEAR(measures.at("good.youngs_modulus_error"), 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(measures.at("good.youngs_modulus_outside"), 0.0);
  EXPECT_NEAR(measures.at("bad.youngs_modulus_outside"), 200.0 / 4000.0, 1e-12);
  EXPECT_DOUBLE_EQ(measures.at("good.claims_certainty"), 1.0);
  EXPECT_DOUBLE_EQ(measures.at("bad.claims_certainty"), 0.0);
  EXPECT_DOUBLE_EQ(measures.at("bad.open_directions"), 1.0);
}

/// A criterion on what is missing must fail, so the measure must not be there.
TEST(FitMeasures, AGapIsNoSmallError) {
  const Case one = two_fits();
  const double gap = std::nan("");
  const auto measures = take_fit_measures(one, {{0.01, gap}, {0.05, 0.03}}, found);
  EXPECT_TRUE(measures.contains("good.deeper"));
  EXPECT_FALSE(measures.contains("good.stick"));
  EXPECT_FALSE(measures.contains("good.worst_error"));
  EXPECT_FALSE(measures.contains("transfer.worst_error"));
}

TEST(FitMeasures, APredictionOfASeriesIsAskedOfItsFitsAlone) {
  Case one = two_fits();
  one.fits[0].series = one.predictions[1].series = "small strain";
  const double gap = std::nan("");
  const auto measures = take_fit_measures(one, {{0.01, 0.02}, {0.05, gap}}, found);
  EXPECT_DOUBLE_EQ(measures.at("bad.worst_error"), 0.05) << "not asked for stick";
  EXPECT_DOUBLE_EQ(measures.at("good.worst_error"), 0.02);
  EXPECT_FALSE(measures.contains("bad.stick"));
}

TEST(FitMeasures, EveryMeasureHasAName) {
  const Case one = two_fits();
  const std::vector<std::string> names = fit_measure_names(one);
  for (const auto& [name, value] : take_fit_measures(one, {{0.0, 0.0}, {0.0, 0.0}}, found))
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}
