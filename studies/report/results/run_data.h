/// What a run folder holds, read back from disk; SI.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "fem_reference/job/run_summary.h"
#include "fem_reference/job/run_tables.h"
#include "fem_reference/verification/verification_file.h"
#include "lattice/press/trace.h"
#include "meshes/press/contact_field.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "meshes/press/taxels.h"
#include "studies/files/case_summary.h"
#include "studies/files/folder_reader.h"
#include "studies/files/manifest.h"
#include "studies/files/mode_table.h"
#include "studies/files/press_summary.h"
#include "studies/files/run_tables.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline results {

/// NaN when there is none; NaN among others does not count.
double largest_magnitude(const std::vector<double>& values);

using meshes::column;

/// The same of a member of rows.
template <class Rows, class Member>
double largest_of(const Rows& rows, Member member) {
  double largest = meshes::unknown;
  for (const auto& row : rows) largest = std::fmax(largest, std::abs(std::invoke(member, row)));
  return largest;
}

/// The first row of which `measure` is largest; null where it is known of none.
template <class Row, class Measure>
const Row* largest_in(const std::vector<Row>& rows, const Measure& measure) {
  const Row* found = nullptr;
  for (const Row& row : rows) {
    const double value = std::invoke(measure, row);
    if (std::isfinite(value) && (!found || value > std::invoke(measure, *found))) found = &row;
  }
  return found;
}

/// What kept a run from its end, of its status; "" when nothing did.
std::string trouble(const std::string& status);

/// The different texts of a member in the order of their first appearance.
template <typename Row>
std::vector<std::string> distinct(const std::vector<Row>& rows, std::string Row::*member) {
  std::vector<std::string> texts;
  for (const Row& row : rows)
    if (std::ranges::find(texts, row.*member) == texts.end()) texts.push_back(row.*member);
  return texts;
}

/// Neighbouring rows that are `alike`, group by group.
template <typename Row, typename Alike>
std::vector<std::span<const Row>> grouped(const std::vector<Row>& rows, const Alike& alike) {
  std::vector<std::span<const Row>> groups;
  for (auto first = rows.begin(); first != rows.end();) {
    const auto last =
        std::find_if_not(first, rows.end(), [&](const Row& row) { return alike(*first, row); });
    groups.emplace_back(first, last);
    first = last;
  }
  return groups;
}

/// Normal force over indentation, in the units shown.
Series force_curve(const std::string& label, const std::string& key, const Style& style,
                   std::span<const meshes::PressSample> samples);

/// What a press in time leaves in its folder; empty where it does not.
struct PressFiles {
  PressSummary summary;
  std::vector<lattice::TraceRow> trace;
  std::vector<BoundaryRow> boundary;
  std::vector<BoundarySpringRow> boundary_springs;
  std::vector<SnapshotRow> snapshots;
  std::vector<SnapshotPointRow> snapshot_points;
};
PressFiles read_press_files(const std::filesystem::path& folder, FolderReader& reader);

/// One lattice model of a validate run.
struct ModelData : PressFiles {
  std::string name;                   ///< "published", "central", "hookean", ...
  std::string status;                 ///< of its press, e.g. "ok"
  ModuliEntry moduli;                 ///< as `validate` puts them into summary.json [Pa]
  std::vector<double> force_error;    ///< relative, at RunData::depths; NaN where not reached
  double l2_error = meshes::unknown;  ///< relative L2 error of the force curve
  double real_time_factor = meshes::unknown;  ///< simulated over wall time
  calibration::ModuliFile calibration;        ///< calibration_NAME/calibration.json, or empty
  meshes::PressResponse response;             ///< empty when absent
  std::vector<meshes::ContactPoint> contact;
  std::vector<meshes::MarkerRow> markers;

  /// Relative force error at the last depth reached; NaN when there is none.
  double last_force_error() const;
};

/// A press of a study whose contact is drawn, beside its continuum.
struct DrawnPress {
  std::string name;
  meshes::PressResponse response, reference;
  std::vector<meshes::ContactPoint> contact, reference_contact;
  std::vector<meshes::TaxelRow> taxels, reference_taxels;
  std::vector<meshes::MarkerRow> markers, reference_markers;
};

/// A run folder; what it does not hold is empty. Most entries are those of `validate`.
struct RunData {
  std::filesystem::path folder;
  std::string verb;  ///< what made it, as its manifest tells
  std::string status;
  std::vector<double> depths;  ///< where force errors are given [m]
  TargetEntry target;   ///< the rubber the models are measured against; NaN where no file tells
  CaseSummary summary;  ///< of `validate`
  StudyEntry study;     ///< its study, or empty
  Manifest manifest;
  calibration::ModuliFile moduli_fit;   ///< of `calibrate` to moduli
  bool fitted_curves = false;           ///< of `calibrate` to curves, see calibration_data.h
  std::string parameters;               ///< parameters.toml as text
  fem_reference::RunSummary continuum;  ///< reference/summary.json; its own of `reference`
  JsonEntry reference_job;              ///< reference/job.json, what the continuum was asked
  fem_reference::VerificationFile verification;
  meshes::PressResponse response;             ///< of a press itself
  std::vector<meshes::ContactPoint> contact;  ///< of a press itself
  std::vector<meshes::TaxelRow> taxels;       ///< of a press or a continuum itself
  std::vector<meshes::MarkerRow> markers;     ///< of a press itself
  std::vector<VibrationMode> modes;
  meshes::PressResponse reference;  ///< empty when the continuum was not run
  std::vector<fem_reference::ConvergenceRow> convergence;
  std::vector<fem_reference::SectionRow> section;
  std::vector<meshes::ContactPoint> reference_contact;  ///< of the continuum
  std::vector<meshes::MarkerRow> reference_markers;     ///< of it; of a press of the one beside it
  meshes::PressResponse beside;  ///< of a press the continuum's from which its errors are
  std::vector<CubeRow> cubes;
  std::vector<PublishedStudyRow> published_study;
  std::vector<EquilibriumStudyRow> equilibrium_study;
  std::vector<VariantRow> variants;
  std::vector<LaterRow> later;
  std::vector<DrawnPress> drawn;
  std::vector<ModelData> models;  ///< published, central, hookean, then any others

  const ModelData* model(const std::string& name) const;
};

/// Reads any run folder. What is damaged stays empty and is noted in `reader`. Throws InvalidInput
/// when the folder holds neither a summary.json nor a calibration.json.
RunData read_run(const std::filesystem::path& folder, FolderReader& reader);

/// Whether `folder` is the run of `reference`, which keeps its job.json at the top.
bool is_continuum(const std::filesystem::path& folder);

/// Normal force [N] at `depth` [m]; NaN when the press did not get there. A controller may stop a
/// rounding error short of the last depth.
double force_at(const meshes::PressResponse& response, double depth);

}  // namespace fingertip::studies::report::inline results
