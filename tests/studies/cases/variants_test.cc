// Studies: what a case file's variants become, and what their presses say together.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "studies/cases/measures.h"
#include "studies/config/documents.h"
#include "tests/studies/cases/case_tables.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

/// How many continua and presses a case of the project plans.
std::pair<std::size_t, std::size_t> planned(const std::string& name) {
  const Case study_case = load_case(find_case(name), {});
  std::pair<std::size_t, std::size_t> counts{0, 0};
  for (const PlannedJob& job : planned_jobs(study_case))
    ++(job.job.kind == "reference" ? counts.first : counts.second);
  return counts;
}

/// A press whose worst error is among its measures.
RunResult result_with(const CaseRun& run, double spacing, const std::vector<double>& error) {
  RunResult result = finished_run(run, {{"worst_error", largest(error)}});
  result.setup.lattice.spacing = spacing;
  for (std::size_t i = 0; i < error.size(); ++i)
    result.forces.depth.push_back(1e-3 * double(i + 1));
  result.forces.error = error;
  result.forces.reference_error.assign(error.size(), 1e-3);
  return result;
}

SeriesMeasures measure(const RunResults& results) {
  return measure_series(members(results, "variant", "s"));
}

/// Variants of one series at the given x.
Case series_at(const std::vector<double>& x) {
  Case study_case;
  for (const double at : x)
    study_case.runs.push_back(
        {.kind = "variant", .name = std::to_string(at), .series = "s", .x = at});
  return study_case;
}

}  // namespace

TEST(Variants, EveryCaseOfTheProjectCanBePlanned) {
  ASSERT_FALSE(all_cases().empty());
  for (const fs::path& file : all_cases()) {
    const Case study_case = load_case(file, {});
    if (!missing_data(study_case).empty()) continue;
    EXPECT_NO_THROW(check_case(study_case)) << file;
  }
}

TEST(Variants, LatticesOfTheSameSpecimenAndContactShareAContinuum) {
  // Small strain with either contact, finite strain.
  EXPECT_EQ(planned("02"), (std::pair<std::size_t, std::size_t>{3, 17}));
  // Bond and contact meet in the press as used, at three spacings.
  EXPECT_EQ(planned("03"), (std::pair<std::size_t, std::size_t>{1, 30 - 3}));
  EXPECT_EQ(planned("04").first, 1U);
  EXPECT_EQ(planned("05").first, 7U);
  EXPECT_EQ(planned("06"), (std::pair<std::size_t, std::size_t>{2, 10}));
}

TEST(Variants, BesideAnotherOneTakeItsContinuum) {
  const TemporaryFolder folder;
  const Case study_case = case_with(
      folder,
      "variant = [\n"
      "{ name = \"a\", set = {} },\n"
      "{ name = \"b\", beside = \"a\", set = { \"geometry.tip_radius\" = \"1.01 cm\" } } ]\n");
  std::size_t continua = 0;
  for (const PlannedJob& job : planned_jobs(study_case)) continua += job.job.kind == "reference";
  EXPECT_EQ(continua, 1U);
  const std::vector<std::string> names = measure_names(study_case);
  for (const char* name : {"b.change", "variants.change", "b.worst_error"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  EXPECT_EQ(std::ranges::find(names, "a.change"), names.end());
}

TEST(Variants, AreStaticPressesAgainstTheContinuumOfTheirKinematics) {
  const TemporaryFolder folder;
  const Case study_case =
      case_with(folder,
                "variant = [\n"
                "{ name = \"a\", set = {} },\n"
                "{ name = \"b\", set = { \"lattice.model\" = \"network\" } },\n"
                "{ name = \"c\", set = { \"lattice.offset\" = [0.5, 0.0, 0.0] } } ]\n");
  std::set<std::string> strains;
  for (const PlannedJob& job : planned_jobs(study_case)) {
    const auto& inputs = job.job.inputs;
    EXPECT_EQ(job.exhibit, job.job.kind == "press") << job.name;
    if (job.job.kind == "press") {
      EXPECT_EQ(inputs["protocol"]["mode"], "static") << job.name;
    } else {
      strains.insert(inputs["strain"]);
      EXPECT_EQ(inputs["analysis"], "static");
      EXPECT_FALSE(inputs["rubber"].contains("energy"));  // of the usual law
    }
  }
  EXPECT_EQ(strains, (std::set<std::string>{"linear", "finite"}));
}

TEST(Variants, WithAProgramMoveSlowlyBesideTheContinuumOfTheSameProgram) {
  const TemporaryFolder folder;
  const Case study_case = case_with(folder,
                                    "variant = [ { name = \"a\", set = { \"press.program\" = "
                                    "[[\"0.2 cm\", \"1 cm/s\"], [\"hold\", "
                                    "\"1 s\"]] } } ]\n");
  const auto jobs = planned_jobs(study_case);
  ASSERT_EQ(jobs.size(), 2U);
  for (const PlannedJob& job : jobs) {
    const auto& protocol = job.job.inputs["protocol"];
    EXPECT_EQ(protocol["program"].size(), 2U);
    if (job.job.kind == "press") {
      EXPECT_EQ(protocol["mode"], "quasi-static");
    }
  }
}

TEST(Variants, ParametersOfARunAreTheStudyAgain) {
  const TemporaryFolder folder;
  const Case first = load_case(find_case("03"), {});
  write_text(folder / "parameters.toml", parameters_toml(first.loaded, "test") + first.text);
  const Case again = load_case(folder / "parameters.toml", {});
  EXPECT_EQ(again.abscissa, first.abscissa);
  EXPECT_EQ(again.budgets.size(), first.budgets.size());
  const auto before = planned_jobs(first), after = planned_jobs(again);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].name, after[i].name);
    EXPECT_EQ(before[i].job.key(), after[i].job.key());
  }
}

TEST(Variants, ProblemsAreToldWithTheLineOfTheVariant) {
  const TemporaryFolder folder;
  const auto variant_with = [](const std::string& set) {
    return "[[case.variant]]\nname = \"odd\"\nset = { " + set + " }\n";
  };
  EXPECT_TRUE(
      says(refusal(folder, variant_with("\"lattice.spacin\" = \"1 mm\"")), "lattice.spacing"));
  const std::string coarse = refusal(folder, variant_with("\"lattice.spacing\" = \"0.3 cm\""));
  EXPECT_TRUE(says(coarse, "case.toml:5 (variant odd): lattice.spacing = 0.3 cm")) << coarse;
  const std::string unknown = refusal(folder, variant_with("\"lattice.spacing\" = \"1 furlongg\""));
  EXPECT_TRUE(says(unknown, "case.toml:5 (variant odd)")) << unknown;
  EXPECT_TRUE(says(refusal(folder, variant_with("\"press.mode\" = \"pid\"")), "static press"));
  EXPECT_TRUE(
      says(refusal(folder, variant_with("\"reference.strain\" = \"finite\"")), "kinematics"));
  EXPECT_TRUE(says(refusal(folder, variant_with("lattice = { spacing = \"1 mm\" }")), "in quotes"));
  EXPECT_TRUE(
      says(refusal(folder, variant_with("\"press.contact\" = \"sticky\"")), "press.contact"));
  EXPECT_EQ(refusal(folder, variant_with("\"press.contact\" = \"coulomb\"")), "");
  EXPECT_TRUE(says(refusal(folder, variant_with("") + variant_with("")), "once in a series"));
  EXPECT_TRUE(
      says(refusal(folder, variant_with("") + "[[case.budget]]\nname = \"b\"\nparts = [\"s\"]\n"),
           "x = 1"));
  EXPECT_TRUE(says(refusal(folder, variant_with("") + "[[case.criteria]]\nname = \"c\"\nmeasure = "
                                                      "\"variants.worst_eror\"\nlimit = 1\n"),
                   "variants.worst_error"));
  EXPECT_EQ(refusal(folder, variant_with("\"lattice.spacing\" = \"tip_radius/7\"")), "");
}

TEST(VariantMeasures, ProgramsAreMeasuredAfterTheirFirstLoading) {
  const auto sample = [](double indentation, double force, double stage, double time) {
    return fingertip::meshes::PressSample{
        .indentation = indentation, .normal_force = force, .time = time, .stage = stage};
  };
  const fingertip::meshes::PressResponse wanted(
      {sample(1e-3, 1.0, 1, 0.1), sample(2e-3, 4.0, 1, 0.2), sample(2e-3, 3.0, 2, 1.2),
       sample(1e-3, 0.5, 3, 1.3), sample(0.0, 0.0, 3, 1.4)});
  // 1 % off at the end of the hold, 0.02 N of 4 N off on the way back; it began 0.1 s earlier.
  const fingertip::meshes::PressResponse pressed(
      {sample(1e-3, 1.0, 1, 0.2), sample(2e-3, 4.0, 1, 0.3), sample(2e-3, 3.03, 2, 1.3),
       sample(1e-3, 0.48, 3, 1.4), sample(0.0, 0.0, 3, 1.5)});
  const Case study_case = series_at({1});
  RunResult result = finished_run(study_case.runs[0], {});
  result.setup.protocol.program = {{2e-3, 0.01}, {.indentation = 2e-3, .hold = 1.0}, {0.0, 0.01}};
  result.forces = compare_forces(pressed, wanted, {1e-3, 2e-3});
  const Measures measures = measures_of_run(study_case, result, {});
  EXPECT_NEAR(measures.at("worst_error"), 0.0, 1e-12);
  EXPECT_NEAR(measures.at("hold_error"), 0.01, 1e-12);
  EXPECT_NEAR(measures.at("later_error"), 0.03 / 4.0, 1e-12);
  // Straight lines between so few: up 0.5 + 2.5 mJ, back 1.75 + 0.25 and 1.755 + 0.24 mJ.
  EXPECT_NEAR(measures.at("loop_error"), 1.005 / 1.0 - 1.0, 1e-12);
  // Other stages: nothing to compare.
  result.forces =
      compare_forces(wanted, fingertip::meshes::PressResponse({sample(2e-3, 4.0, 1, 0.2)}), {2e-3});
  EXPECT_FALSE(measures_of_run(study_case, result, {}).contains("hold_error"));
}

TEST(VariantMeasures, OrderIsTheSlopeInLogarithms) {
  const Case study_case = series_at({6, 8, 12, 16});
  RunResults results;
  for (const CaseRun& variant : study_case.runs) {
    const double a = 0.01 / variant.x;
    results.push_back(result_with(variant, a, {-300.0 * a * a, 900.0 * a * a}));
  }
  const SeriesMeasures measures = measure(results);
  EXPECT_NEAR(measures.order, 2.0, 1e-12);
  EXPECT_NEAR(measures.worst_error, 900.0 * std::pow(0.01 / 6, 2), 1e-15);
  EXPECT_NEAR(measures.finest_error, 900.0 * std::pow(0.01 / 16, 2), 1e-15);
  EXPECT_NEAR(measures.spread, 900.0 * (std::pow(0.01 / 6, 2) - std::pow(0.01 / 16, 2)), 1e-15);
  results[2].setup.lattice.spacing = results[1].setup.lattice.spacing;
  EXPECT_TRUE(std::isnan(measure(results).order)) << "not the spacing alone";
}

TEST(VariantMeasures, WhatIsMissingIsNotJudged) {
  const Case study_case = series_at({1, 2});
  RunResults results = {result_with(study_case.runs[0], 1e-3, {0.1}),
                        result_with(study_case.runs[1], 1e-3, {0.2})};
  EXPECT_NEAR(take_measures(study_case, results).at("variants.worst_error"), 0.2, 1e-15);
  results[0] = result_with(study_case.runs[0], 1e-3, {std::nan("")});
  results[0].status = "not converged: why";
  const auto taken = take_measures(study_case, results);
  EXPECT_EQ(taken.at("variants.not_converged"), 1.0);
  for (const char* name : {"variants.worst_error", "s.worst_error", "s.spread"})
    EXPECT_EQ(taken.count(name), 0U) << name;
}

// Two compliances in a row: the error is linear in one and quadratic in the other; what is left
// without either is the rest.
TEST(VariantMeasures, BudgetSeparatesWhatAddsUp) {
  Case study_case;
  RunResults results;
  const auto error = [](double bond, double contact) {
    return 0.004 - 0.010 * bond - 0.006 * contact + 0.001 * contact * contact;
  };
  for (const std::string series : {"bond", "contact"})
    for (const double x : {4.0, 0.25, 1.0, 2.0})
      study_case.runs.push_back({.kind = "variant", .series = series, .x = x});
  for (const CaseRun& run : study_case.runs) {
    // Stiffer ties lock: they must not enter.
    const double locked = run.x < 1.0 ? 0.5 : 0.0;
    const bool bond = run.series == "bond";
    results.push_back(
        result_with(run, 1e-3, {locked + (bond ? error(run.x, 1.0) : error(1.0, run.x))}));
  }
  study_case.budgets.push_back({"b", {"bond", "contact"}});
  const Budget budget = take_budget(study_case.budgets[0], results);
  ASSERT_EQ(budget.parts.size(), 2U);
  EXPECT_NEAR(budget.total[0], error(1.0, 1.0), 1e-15);
  EXPECT_NEAR(budget.parts[0][0], -0.010, 1e-12);
  EXPECT_NEAR(budget.parts[1][0], -0.005, 1e-12);
  EXPECT_NEAR(budget.rest[0], 0.004, 1e-12);
  EXPECT_NEAR(take_measures(study_case, results).at("b.rest"), 0.004, 1e-12);
}
