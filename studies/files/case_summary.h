/// summary.json of a case, SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"
#include "studies/files/press_summary.h"

namespace fingertip::studies::inline files {

/// A criterion of a case.
struct CriterionEntry {
  std::string name, measure;
  double value = meshes::unknown, limit = meshes::unknown;
  bool passed = false;
};
consteval auto fields_of(const CriterionEntry*) {
  return FINGERTIP_ALL_MEMBERS(CriterionEntry, name, measure, value, limit, passed)
      .newer("measure");
}

/// The case's rubber [Pa].
struct TargetEntry {
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown, bulk_modulus = meshes::unknown;
};
FINGERTIP_FIELDS(TargetEntry, youngs_modulus, shear_modulus, poissons_ratio, bulk_modulus);

/// The continuum that presses are measured against: forces [N] at the case's depths.
struct ReferenceEntry {
  std::string status;
  std::vector<double> force, relative_force_error;
};
FINGERTIP_FIELDS(ReferenceEntry, status, force, relative_force_error);

/// The continuum's code against analytic solutions.
struct VerificationEntry {
  std::size_t checks = 0, failed_checks = 0;
};
FINGERTIP_FIELDS(VerificationEntry, checks, failed_checks);

/// The lattice of the core case at rest, by depth.
struct EquilibriumEntry {
  std::vector<double> hookean_force_error;
};
FINGERTIP_FIELDS(EquilibriumEntry, hookean_force_error);

/// A press without a series: constants of its lattice [Pa], of one in time that left a summary, and
/// errors against what it stands beside.
struct ModelEntry : ModuliEntry {
  bool in_time = true;  ///< in no file
  double real_time_factor = meshes::unknown;
  std::vector<double> force_error;
  double relative_l2_force_error = meshes::unknown;
  std::string status;

  bool is_in_time() const { return in_time; }
};
consteval auto fields_of(const ModelEntry*) {
  return FINGERTIP_MEMBERS(ModelEntry, E_100, E_110, E_111, G, nu_100, K, anisotropy,
                           real_time_factor, force_error, relative_l2_force_error, status)
      .only(&ModelEntry::is_in_time, "E_100 E_110 E_111 G nu_100 K anisotropy")
      .newer("E_100 E_110 E_111 G nu_100 K anisotropy");
}

/// A series of a study.
struct SeriesEntry {
  std::string name;
  double worst_error = meshes::unknown, finest_error = meshes::unknown, spread = meshes::unknown,
         order = meshes::unknown;
};
FINGERTIP_FIELDS(SeriesEntry, name, worst_error, finest_error, spread, order);

/// A continuum of a study.
struct ContinuumEntry {
  std::string folder, strain, contact;
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown;
};
FINGERTIP_FIELDS(ContinuumEntry, folder, strain, contact, youngs_modulus, shear_modulus,
                 poissons_ratio);

/// A part of a budget, by depth.
struct PartEntry {
  std::string series;
  std::vector<double> share;
};
FINGERTIP_FIELDS(PartEntry, series, share);

/// Who has what share of a force error, by depth.
struct BudgetEntry {
  std::string name;
  std::vector<double> depths, total;
  std::vector<PartEntry> parts;
  std::vector<double> rest;
};
FINGERTIP_FIELDS(BudgetEntry, name, depths, total, parts, rest);

/// A press of a study whose contact is drawn, and its continuum.
struct DrawnEntry {
  std::string name, folder, continuum;
};
FINGERTIP_FIELDS(DrawnEntry, name, folder, continuum);

/// A case on variants.
struct StudyEntry {
  std::string x_label;
  std::size_t count = 0, not_converged = 0;
  std::vector<SeriesEntry> series;
  std::vector<ContinuumEntry> continua;
  std::vector<BudgetEntry> budgets;
  std::vector<DrawnEntry> drawn;
};
consteval auto fields_of(const StudyEntry*) {
  return FINGERTIP_ALL_MEMBERS(StudyEntry, x_label, count, not_converged, series, continua, budgets,
                               drawn)
      .if_known("drawn");
}

/// A fit of a case.
struct FitEntry {
  std::string name, folder, model, problem;
};
FINGERTIP_FIELDS(FitEntry, name, folder, model, problem);

/// What every fit is asked for.
struct PredictionEntry {
  std::string name;
};
FINGERTIP_FIELDS(PredictionEntry, name);

/// The rubber that fits are to find.
struct TruthEntry {
  meshes::Entries<double> parameters;
};
FINGERTIP_FIELDS(TruthEntry, parameters);

/// A case on fits; worst errors: fits × predictions.
struct TransferEntry {
  std::vector<FitEntry> fits;
  std::vector<PredictionEntry> predictions;
  std::vector<std::vector<double>> worst_error;
  TruthEntry truth;
};
FINGERTIP_FIELDS(TransferEntry, fits, predictions, worst_error, truth);

/// A press of a case on virtual control; its other measures stand beside these.
struct PressEntry {
  std::string series, name, folder, continuum, beside;
  bool pictured = false;
  std::string status;
  double change = meshes::unknown, force_error = meshes::unknown;
};
consteval auto fields_of(const PressEntry*) {
  return FINGERTIP_ALL_MEMBERS(PressEntry, series, name, folder, continuum, beside, pictured,
                               status, change, force_error)
      .if_known("change force_error");
}

/// A grasp of a case; its measures stand beside these.
struct GraspEntry {
  std::string series, name, folder, status;
};
FINGERTIP_FIELDS(GraspEntry, series, name, folder, status);

/// A fit of laws to material tests, as one law and one test, or all (empty), are measured; see
/// studies/manual/files.md for the measures.
struct MaterialRunEntry {
  std::string series, name, folder, law, test, status;
  double fit_error = meshes::unknown, predicted_error = meshes::unknown, outside = meshes::unknown,
         squares_error = meshes::unknown, end_ratio = meshes::unknown;
};
consteval auto fields_of(const MaterialRunEntry*) {
  return FINGERTIP_ALL_MEMBERS(MaterialRunEntry, series, name, folder, law, test, status, fit_error,
                               predicted_error, outside, squares_error, end_ratio)
      .if_known("fit_error predicted_error outside squares_error end_ratio");
}

/// summary.json of `validate`, by the kinds of the case's runs.
struct CaseSummary {
  std::string case_name, title, description, status;
  std::optional<TargetEntry> target;
  std::vector<double> depths;
  std::optional<ReferenceEntry> reference;
  std::optional<VerificationEntry> verification;
  std::optional<EquilibriumEntry> equilibrium;
  meshes::Entries<ModelEntry> models;
  std::optional<StudyEntry> variants;
  std::optional<TransferEntry> calibration;
  std::vector<PressEntry> presses;
  std::vector<GraspEntry> grasps;
  std::vector<MaterialRunEntry> materials;
  std::vector<CriterionEntry> criteria;

  bool has_target() const { return target.has_value(); }
  bool has_results() const {
    return target || verification || equilibrium || !models.empty() || variants || calibration ||
           !presses.empty() || !grasps.empty() || !materials.empty();
  }
};
consteval auto fields_of(const CaseSummary*) {
  return FINGERTIP_ALL_MEMBERS(CaseSummary, case_name, title, description, status, target, depths,
                               reference, verification, equilibrium, models, variants, calibration,
                               presses, grasps, materials, criteria)
      .called("case_name", "case")
      .only(&CaseSummary::has_target, "depths reference")
      .if_known(
          "target verification equilibrium models variants calibration presses grasps materials");
}

}  // namespace fingertip::studies::inline files
