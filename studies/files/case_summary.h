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
constexpr auto fields_of(const CriterionEntry*) {
  using meshes::named, meshes::newer;
  using Whole = CriterionEntry;
  return std::tuple_cat(named("name", &Whole::name), newer(named("measure", &Whole::measure)),
                        named("value limit passed", &Whole::value, &Whole::limit, &Whole::passed));
}

/// The case's rubber [Pa].
struct TargetEntry {
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown, bulk_modulus = meshes::unknown;
};
constexpr auto fields_of(const TargetEntry*) {
  using meshes::named;
  using Whole = TargetEntry;
  return named("youngs_modulus shear_modulus poissons_ratio bulk_modulus", &Whole::youngs_modulus,
               &Whole::shear_modulus, &Whole::poissons_ratio, &Whole::bulk_modulus);
}

/// The continuum that presses are measured against: forces [N] at the case's depths.
struct ReferenceEntry {
  std::string status;
  std::vector<double> force, relative_force_error;
};
constexpr auto fields_of(const ReferenceEntry*) {
  using meshes::named;
  using Whole = ReferenceEntry;
  return named("status force relative_force_error", &Whole::status, &Whole::force,
               &Whole::relative_force_error);
}

/// The continuum's code against analytic solutions.
struct VerificationEntry {
  std::size_t checks = 0, failed_checks = 0;
};
constexpr auto fields_of(const VerificationEntry*) {
  using meshes::named;
  using Whole = VerificationEntry;
  return named("checks failed_checks", &Whole::checks, &Whole::failed_checks);
}

/// The lattice of the core case at rest, by depth.
struct EquilibriumEntry {
  std::vector<double> hookean_force_error;
};
constexpr auto fields_of(const EquilibriumEntry*) {
  using meshes::named;
  using Whole = EquilibriumEntry;
  return named("hookean_force_error", &Whole::hookean_force_error);
}

/// A press without a series: constants of its lattice [Pa], of one in time that left a summary, and
/// errors against what it stands beside.
struct ModelEntry : ModuliEntry {
  bool in_time = true;  ///< in no file
  double real_time_factor = meshes::unknown;
  std::vector<double> force_error;
  double relative_l2_force_error = meshes::unknown;
  std::string status;
};
constexpr auto fields_of(const ModelEntry*) {
  using meshes::named, meshes::newer, meshes::only;
  using Whole = ModelEntry;
  return std::tuple_cat(
      only(&Whole::in_time,
           newer(named("E_100 E_110 E_111 G nu_100 K anisotropy", &Whole::E_100, &Whole::E_110,
                       &Whole::E_111, &Whole::G, &Whole::nu_100, &Whole::K, &Whole::anisotropy))),
      named("real_time_factor force_error relative_l2_force_error status", &Whole::real_time_factor,
            &Whole::force_error, &Whole::relative_l2_force_error, &Whole::status));
}

/// A series of a study.
struct SeriesEntry {
  std::string name;
  double worst_error = meshes::unknown, finest_error = meshes::unknown, spread = meshes::unknown,
         order = meshes::unknown;
};
constexpr auto fields_of(const SeriesEntry*) {
  using meshes::named;
  using Whole = SeriesEntry;
  return named("name worst_error finest_error spread order", &Whole::name, &Whole::worst_error,
               &Whole::finest_error, &Whole::spread, &Whole::order);
}

/// A continuum of a study.
struct ContinuumEntry {
  std::string folder, strain, contact;
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown,
         poissons_ratio = meshes::unknown;
};
constexpr auto fields_of(const ContinuumEntry*) {
  using meshes::named;
  using Whole = ContinuumEntry;
  return named("folder strain contact youngs_modulus shear_modulus poissons_ratio", &Whole::folder,
               &Whole::strain, &Whole::contact, &Whole::youngs_modulus, &Whole::shear_modulus,
               &Whole::poissons_ratio);
}

/// A part of a budget, by depth.
struct PartEntry {
  std::string series;
  std::vector<double> share;
};
constexpr auto fields_of(const PartEntry*) {
  using meshes::named;
  using Whole = PartEntry;
  return named("series share", &Whole::series, &Whole::share);
}

/// Who has what share of a force error, by depth.
struct BudgetEntry {
  std::string name;
  std::vector<double> depths, total;
  std::vector<PartEntry> parts;
  std::vector<double> rest;
};
constexpr auto fields_of(const BudgetEntry*) {
  using meshes::named;
  using Whole = BudgetEntry;
  return named("name depths total parts rest", &Whole::name, &Whole::depths, &Whole::total,
               &Whole::parts, &Whole::rest);
}

/// A case on variants.
struct StudyEntry {
  std::string x_label;
  std::size_t count = 0, not_converged = 0;
  std::vector<SeriesEntry> series;
  std::vector<ContinuumEntry> continua;
  std::vector<BudgetEntry> budgets;
};
constexpr auto fields_of(const StudyEntry*) {
  using meshes::named;
  using Whole = StudyEntry;
  return named("x_label count not_converged series continua budgets", &Whole::x_label,
               &Whole::count, &Whole::not_converged, &Whole::series, &Whole::continua,
               &Whole::budgets);
}

/// A fit of a case.
struct FitEntry {
  std::string name, folder, model, problem;
};
constexpr auto fields_of(const FitEntry*) {
  using meshes::named;
  using Whole = FitEntry;
  return named("name folder model problem", &Whole::name, &Whole::folder, &Whole::model,
               &Whole::problem);
}

/// What every fit is asked for.
struct PredictionEntry {
  std::string name;
};
constexpr auto fields_of(const PredictionEntry*) {
  using meshes::named;
  using Whole = PredictionEntry;
  return named("name", &Whole::name);
}

/// The rubber that fits are to find.
struct TruthEntry {
  meshes::Entries<double> parameters;
};
constexpr auto fields_of(const TruthEntry*) {
  using meshes::named;
  using Whole = TruthEntry;
  return named("parameters", &Whole::parameters);
}

/// A case on fits; worst errors: fits × predictions.
struct TransferEntry {
  std::vector<FitEntry> fits;
  std::vector<PredictionEntry> predictions;
  std::vector<std::vector<double>> worst_error;
  TruthEntry truth;
};
constexpr auto fields_of(const TransferEntry*) {
  using meshes::named;
  using Whole = TransferEntry;
  return named("fits predictions worst_error truth", &Whole::fits, &Whole::predictions,
               &Whole::worst_error, &Whole::truth);
}

/// A press of a case on virtual control; its other measures stand beside these.
struct PressEntry {
  std::string series, name, folder, continuum, beside;
  bool pictured = false;
  std::string status;
  double change = meshes::unknown, force_error = meshes::unknown;
};
constexpr auto fields_of(const PressEntry*) {
  using meshes::if_known, meshes::named;
  using Whole = PressEntry;
  return std::tuple_cat(
      named("series name folder continuum beside pictured status", &Whole::series, &Whole::name,
            &Whole::folder, &Whole::continuum, &Whole::beside, &Whole::pictured, &Whole::status),
      if_known(named("change force_error", &Whole::change, &Whole::force_error)));
}

/// A grasp of a case; its measures stand beside these.
struct GraspEntry {
  std::string series, name, folder, status;
};
constexpr auto fields_of(const GraspEntry*) {
  using meshes::named;
  using Whole = GraspEntry;
  return named("series name folder status", &Whole::series, &Whole::name, &Whole::folder,
               &Whole::status);
}

/// A fit of laws to material tests, as one law and one test, or all (empty), are measured; see
/// studies/manual/files.md for the measures.
struct MaterialRunEntry {
  std::string series, name, folder, law, test, status;
  double fit_error = meshes::unknown, predicted_error = meshes::unknown, outside = meshes::unknown,
         squares_error = meshes::unknown, end_ratio = meshes::unknown;
};
constexpr auto fields_of(const MaterialRunEntry*) {
  using meshes::if_known, meshes::named;
  using Whole = MaterialRunEntry;
  return std::tuple_cat(named("series name folder law test status", &Whole::series, &Whole::name,
                              &Whole::folder, &Whole::law, &Whole::test, &Whole::status),
                        if_known(named("fit_error predicted_error outside squares_error end_ratio",
                                       &Whole::fit_error, &Whole::predicted_error, &Whole::outside,
                                       &Whole::squares_error, &Whole::end_ratio)));
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
constexpr auto fields_of(const CaseSummary*) {
  using meshes::if_known, meshes::named, meshes::only;
  using Whole = CaseSummary;
  return std::tuple_cat(
      named("case title description status", &Whole::case_name, &Whole::title, &Whole::description,
            &Whole::status),
      if_known(named("target", &Whole::target)),
      only(&Whole::has_target, named("depths reference", &Whole::depths, &Whole::reference)),
      if_known(
          named("verification equilibrium models variants calibration presses grasps materials",
                &Whole::verification, &Whole::equilibrium, &Whole::models, &Whole::variants,
                &Whole::calibration, &Whole::presses, &Whole::grasps, &Whole::materials)),
      named("criteria", &Whole::criteria));
}

}  // namespace fingertip::studies::inline files
