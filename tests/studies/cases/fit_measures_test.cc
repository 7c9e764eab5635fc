#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "studies/cases/measures.h"
#include "tests/studies/cases/case_tables.h"

using namespace fingertip::studies;
using fingertip::calibration::FitFile, fingertip::calibration::ParameterEntry;

namespace {

Case two_fits() {
  Case study_case;
  for (const char* name : {"good", "bad"})
    study_case.runs.push_back({.kind = "fit", .verb = "fit", .name = name});
  for (const char* name : {"deeper", "stick"})
    study_case.runs.push_back({.kind = "prediction", .verb = "press", .name = name});
  study_case.loaded.config.press.rubber.youngs_modulus = 4000.0;
  return study_case;
}

FitFile fit_with(double estimate, double lower, double upper, bool open) {
  FitFile fit;
  fit.problem = "experiment";
  fit.parameters.resize(1);
  ParameterEntry& parameter = fit.parameters.front();
  parameter.name = "youngs_modulus";
  parameter.estimate = estimate;
  parameter.lower = lower;
  parameter.upper = upper;
  fit.unidentifiable.resize(open ? 1 : 0);
  return fit;
}

const std::vector<FitFile> found = {fit_with(4040.0, 3990.0, 4090.0, false),
                                    fit_with(4400.0, 4200.0, 4600.0, true)};

/// `errors` per fit and prediction; those that are not asked do not count.
Measures measures_with(const Case& study_case, const std::vector<std::vector<double>>& errors) {
  RunResults results;
  for (std::size_t f = 0; f < 2; ++f) {
    RunResult fit = finished_run(study_case.runs[f], {});
    fit.found = found[f];
    fit.measures = measures_of_run(study_case, fit, {});
    results.push_back(fit);
    for (std::size_t p = 0; p < 2; ++p) {
      if (!is_asked(study_case.runs[2 + p], study_case.runs[f])) continue;
      RunResult press = finished_run(study_case.runs[2 + p], {});
      press.fit = &study_case.runs[f];
      press.forces.error = {errors[f][p]};
      press.measures = measures_of_run(study_case, press, {});
      results.push_back(press);
    }
  }
  return take_measures(study_case, results);
}

}  // namespace

TEST(FitMeasures, AreTakenPerFitAndPrediction) {
  const Case study_case = two_fits();
  const auto measures = measures_with(study_case, {{0.01, 0.02}, {0.05, 0.03}});
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
  const Case study_case = two_fits();
  const double gap = std::nan("");
  const auto measures = measures_with(study_case, {{0.01, gap}, {0.05, 0.03}});
  EXPECT_TRUE(measures.contains("good.deeper"));
  EXPECT_FALSE(measures.contains("good.stick"));
  EXPECT_FALSE(measures.contains("good.worst_error"));
  EXPECT_FALSE(measures.contains("transfer.worst_error"));
}

TEST(FitMeasures, APredictionOfASeriesIsAskedOfItsFitsAlone) {
  Case study_case = two_fits();
  study_case.runs[0].series = study_case.runs[3].series = "small strain";
  const double gap = std::nan("");
  const auto measures = measures_with(study_case, {{0.01, 0.02}, {0.05, gap}});
  EXPECT_DOUBLE_EQ(measures.at("bad.worst_error"), 0.05) << "not asked for stick";
  EXPECT_DOUBLE_EQ(measures.at("good.worst_error"), 0.02);
  EXPECT_FALSE(measures.contains("bad.stick"));
}

/// Correlations of 0.6 and 0.8: of what is most alike 0.6 of an interval stays.
TEST(FitMeasures, TellWhatAMisfitIsPutDownTo) {
  const Case study_case = two_fits();
  RunResult fit = finished_run(study_case.runs[0], {});
  fit.found = found[0];
  fit.found.parameters[0].name = "modulus";
  fit.found.correlation = {{1.0, 0.6, -0.8}, {0.6, 1.0, 0.0}, {-0.8, 0.0, 1.0}};
  fit.found.chi_square_probability = 1e-5;
  fit.found.lack_of_fit = {{"compliance", "", "", "m/N", 1.0, 20.0, 1e-5},
                           {"finite strain", "", "", "1", 1.0, 18.0, 1e-5}};
  auto measures = measures_of_run(study_case, fit, {});
  EXPECT_NEAR(measures.at("told_apart"), 0.6, 1e-12);
  EXPECT_DOUBLE_EQ(measures.at("fit_probability"), 1e-5);
  EXPECT_DOUBLE_EQ(measures.at("rig_unnamed"), 0.0);
  EXPECT_DOUBLE_EQ(measures.at("strain_unnamed"), 0.0) << "told second";
  EXPECT_DOUBLE_EQ(measures.at("contact_unnamed"), 1.0);
  EXPECT_NEAR(measures.at("modulus_error"), 0.01, 1e-12);
  fit.found.lack_of_fit[0].probability = 0.2;
  EXPECT_DOUBLE_EQ(measures_of_run(study_case, fit, {}).at("rig_unnamed"), 1.0) << "by chance";
}

TEST(FitMeasures, EveryMeasureHasAName) {
  const Case study_case = two_fits();
  const std::vector<std::string> names = measure_names(study_case);
  for (const auto& [name, value] : measures_with(study_case, {{0.0, 0.0}, {0.0, 0.0}}))
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
}
