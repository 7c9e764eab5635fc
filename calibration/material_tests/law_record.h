/// laws.json and the tables of a fit of laws to material tests. SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/material_tests/law_fit.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline material_tests {

/// How a law meets a test; stresses stand in law_data.csv.
struct LawTestEntry : TestMisfit {
  std::string kind, use;  ///< use: fit or predict
  std::string course = "slow";
  std::optional<double> rate = {};
  double published = meshes::unknown;  ///< sum of squares that somebody else's fit left [Pa²]
};
consteval auto fields_of(const LawTestEntry*) {
  return FINGERTIP_MEMBERS(LawTestEntry, name, kind, use, points, rms, rms_relative,
                           largest_relative, sum_of_squares, within, in_range, structure, course,
                           rate, loop_measured, loop_computed, published)
      .newer("course rate loop_measured loop_computed published");
}

/// Where a law stops being stable.
struct InstabilityEntry {
  std::string test;
  double stretch = meshes::unknown;
};
FINGERTIP_FIELDS(InstabilityEntry, test, stretch);

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
FINGERTIP_FIELDS(LawEntry, law, parameters, shear_modulus, aicc, covariance, tests,
                 unstable_in_tests, unstable_in_use, unstable_in_press, minima, contradictions,
                 failure);

/// laws.json.
struct LawsFile {
  std::string problem, weights, recommended;
  double smallest_stretch = meshes::unknown, largest_stretch = meshes::unknown;
  double shortest_time = meshes::unknown, longest_time = meshes::unknown;  ///< of tests in time
  std::vector<LawEntry> laws;                                              ///< the least AICc first
  std::vector<std::string> failed;  ///< LawFit::failed of the recommended one; or why there is none
  std::string statement;
};
consteval auto fields_of(const LawsFile*) {
  return FINGERTIP_ALL_MEMBERS(LawsFile, problem, weights, recommended, smallest_stretch,
                               largest_stretch, laws, statement, shortest_time, longest_time,
                               failed)
      .newer("shortest_time longest_time failed");
}

/// law_data.csv: a measured stress beside those of a law.
struct LawDataRow {
  std::string law, test, use;
  double deformation = meshes::unknown, measured = meshes::unknown, computed = meshes::unknown;
  double time = meshes::unknown;  ///< none of slow tests
};
consteval auto fields_of(const LawDataRow*) {
  return FINGERTIP_ALL_MEMBERS(LawDataRow, law, test, use, deformation, measured, computed, time)
      .in("Pa", "measured computed")
      .in("s", "time")
      .newer("time");
}

/// What the ranking says, as a file; `ranking` of rank_laws is not empty.
LawsFile laws_file(const std::vector<LawFit>& ranking, const std::vector<MaterialTest>& tests,
                   const std::vector<MaterialTest>& validation, TestWeights weights);

/// Stresses of every law that has a fit, at the tests' deformations.
std::vector<LawDataRow> law_data(const std::vector<LawFit>& ranking,
                                 const std::vector<MaterialTest>& tests,
                                 const std::vector<MaterialTest>& validation);

}  // namespace fingertip::calibration::inline material_tests
