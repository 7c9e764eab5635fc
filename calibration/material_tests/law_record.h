/// laws.json and the tables of a fit of laws to material tests. SI.
#pragma once

#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/material_tests/law_fit.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline material_tests {

/// How a law meets a test; stresses stand in law_data.csv.
struct LawTestEntry : TestMisfit {
  std::string kind, use;  ///< use: fit or predict
  std::string course = "slow";
  std::optional<double> rate = {};
  double published = meshes::unknown;  ///< sum of squares that somebody else's fit left [Pa²]
};
constexpr auto fields_of(const LawTestEntry*) {
  using meshes::named, meshes::newer;
  using Whole = LawTestEntry;
  return std::tuple_cat(
      named("name kind use points rms rms_relative largest_relative sum_of_squares within in_range "
            "structure",
            &Whole::name, &Whole::kind, &Whole::use, &Whole::points, &Whole::rms,
            &Whole::rms_relative, &Whole::largest_relative, &Whole::sum_of_squares, &Whole::within,
            &Whole::in_range, &Whole::structure),
      newer(named("course rate loop_measured loop_computed published", &Whole::course, &Whole::rate,
                  &Whole::loop_measured, &Whole::loop_computed, &Whole::published)));
}

/// Where a law stops being stable.
struct InstabilityEntry {
  std::string test;
  double stretch = meshes::unknown;
};
constexpr auto fields_of(const InstabilityEntry*) {
  using meshes::named;
  using Whole = InstabilityEntry;
  return named("test stretch", &Whole::test, &Whole::stretch);
}

/// A law of the ranking.
struct LawEntry {
  std::string law;
  std::vector<ParameterEntry> parameters;
  double shear_modulus = meshes::unknown, aicc = meshes::unknown;
  std::vector<std::vector<double>> covariance;
  std::vector<LawTestEntry> tests;
  std::optional<InstabilityEntry> unstable_in_tests, unstable_in_use, unstable_in_press;
  std::vector<MinimumEntry> minima;
  std::vector<std::string> contradictions;
  std::string failure;
};
constexpr auto fields_of(const LawEntry*) {
  using meshes::named;
  using Whole = LawEntry;
  return named(
      "law parameters shear_modulus aicc covariance tests unstable_in_tests unstable_in_use "
      "unstable_in_press minima contradictions failure",
      &Whole::law, &Whole::parameters, &Whole::shear_modulus, &Whole::aicc, &Whole::covariance,
      &Whole::tests, &Whole::unstable_in_tests, &Whole::unstable_in_use, &Whole::unstable_in_press,
      &Whole::minima, &Whole::contradictions, &Whole::failure);
}

/// laws.json.
struct LawsFile {
  std::string problem, weights, recommended;
  double smallest_stretch = meshes::unknown, largest_stretch = meshes::unknown;
  double shortest_time = meshes::unknown, longest_time = meshes::unknown;  ///< of tests in time
  std::vector<LawEntry> laws;                                              ///< the least AICc first
  std::vector<std::string> failed;  ///< LawFit::failed of the recommended one; or why there is none
  std::string statement;
};
constexpr auto fields_of(const LawsFile*) {
  using meshes::named, meshes::newer;
  using Whole = LawsFile;
  return std::tuple_cat(
      named("problem weights recommended smallest_stretch largest_stretch laws statement",
            &Whole::problem, &Whole::weights, &Whole::recommended, &Whole::smallest_stretch,
            &Whole::largest_stretch, &Whole::laws, &Whole::statement),
      newer(named("shortest_time longest_time failed", &Whole::shortest_time, &Whole::longest_time,
                  &Whole::failed)));
}

/// law_data.csv: a measured stress beside those of a law.
struct LawDataRow {
  std::string law, test, use;
  double deformation = meshes::unknown, measured = meshes::unknown, computed = meshes::unknown;
  double time = meshes::unknown;  ///< none of slow tests
};
constexpr auto fields_of(const LawDataRow*) {
  using meshes::field;
  using Row = LawDataRow;
  return std::tuple{field("law", &Row::law),
                    field("test", &Row::test),
                    field("use", &Row::use),
                    field("deformation", &Row::deformation),
                    field("measured [Pa]", &Row::measured),
                    field("computed [Pa]", &Row::computed),
                    field("time [s]", &Row::time, meshes::Presence::newer)};
}

/// What the ranking says, as a file; `ranking` of rank_laws is not empty.
LawsFile laws_file(const std::vector<LawFit>& ranking, const std::vector<MaterialTest>& tests,
                   const std::vector<MaterialTest>& validation, TestWeights weights);

/// Stresses of every law that has a fit, at the tests' deformations.
std::vector<LawDataRow> law_data(const std::vector<LawFit>& ranking,
                                 const std::vector<MaterialTest>& tests,
                                 const std::vector<MaterialTest>& validation);

}  // namespace fingertip::calibration::inline material_tests
