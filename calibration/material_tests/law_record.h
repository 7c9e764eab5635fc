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
  std::vector<double> specimens = {};  ///< of a mean of several every one's stress over it
};
consteval auto fields_of(const LawTestEntry*) {
  return FINGERTIP_MEMBERS(LawTestEntry, name, kind, use, points, rms, rms_relative,
                           largest_relative, sum_of_squares, within, in_range, structure, course,
                           rate, loop_measured, loop_computed, published, stress_zero, strain_zero,
                           specimens, factor, misfit)
      .newer(
          "course rate loop_measured loop_computed published stress_zero strain_zero specimens "
          "factor misfit");
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
  std::string passed_over;  ///< why it is not taken though its AICc is lower
};
consteval auto fields_of(const LawEntry*) {
  return FINGERTIP_ALL_MEMBERS(LawEntry, law, parameters, shear_modulus, aicc, covariance, tests,
                               unstable_in_tests, unstable_in_use, unstable_in_press, minima,
                               contradictions, failure, passed_over)
      .newer("passed_over");
}

/// laws.json.
struct LawsFile {
  std::string problem, weights, recommended;
  double smallest_stretch = meshes::unknown, largest_stretch = meshes::unknown;
  double shortest_time = meshes::unknown, longest_time = meshes::unknown;  ///< of tests in time
  /// At rest, of the recommended law; its 95 % interval over all laws that the tests support alike.
  double shear_modulus = meshes::unknown, shear_modulus_lower = meshes::unknown,
         shear_modulus_upper = meshes::unknown;
  std::vector<std::string> supported;  ///< their names
  std::vector<LawEntry> laws;          ///< the least AICc first
  std::vector<std::string> failed;  ///< LawFit::failed of the recommended one; or why there is none
  std::string statement;
};
consteval auto fields_of(const LawsFile*) {
  return FINGERTIP_ALL_MEMBERS(LawsFile, problem, weights, recommended, smallest_stretch,
                               largest_stretch, laws, statement, shortest_time, longest_time,
                               failed, shear_modulus, shear_modulus_lower, shear_modulus_upper,
                               supported)
      .newer(
          "shortest_time longest_time failed shear_modulus shear_modulus_lower "
          "shear_modulus_upper supported");
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
