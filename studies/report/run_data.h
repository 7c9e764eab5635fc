/// What a run folder holds, read back from disk; SI.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press_response.h"
#include "studies/files/folder_reader.h"

namespace fingertip::studies::reporting {

/// NaN when there is none; NaN among others does not count.
double largest_magnitude(const std::vector<double>& values);

using meshes::CsvTable;

/// The rubber's constants the models are measured against [Pa]; NaN where no file tells them.
struct Target {
  double youngs_modulus = meshes::unknown;
  double shear_modulus = meshes::unknown;
  double poissons_ratio = meshes::unknown;
  double bulk_modulus = meshes::unknown;
};

/// Elastic constants of a lattice as `validate` puts them into summary.json [Pa].
struct Moduli {
  double E_100 = meshes::unknown, E_110 = meshes::unknown, E_111 = meshes::unknown;
  double G = meshes::unknown, nu_100 = meshes::unknown, K = meshes::unknown;
};

/// One lattice model of a validate run.
struct ModelData {
  std::string name;    ///< "published", "central", "hookean", ...
  std::string status;  ///< of its press, e.g. "ok"
  Moduli moduli;
  std::vector<double> force_error;    ///< relative, at RunData::depths; NaN where not reached
  double l2_error = meshes::unknown;  ///< relative L2 error of the force curve
  double real_time_factor = meshes::unknown;  ///< simulated over wall time
  JsonEntry summary;                          ///< NAME/summary.json; an empty object when absent
  JsonEntry calibration;                      ///< calibration_NAME/calibration.json, likewise
  meshes::PressResponse response;             ///< empty when absent
  CsvTable trace, boundary, boundary_springs, snapshots, snapshot_points;

  /// Relative force error at the last depth reached; NaN when there is none.
  double last_force_error() const;
};

struct Criterion {
  std::string name;
  double value = meshes::unknown;
  double limit = meshes::unknown;
  bool passed = false;
};

/// A run folder; what it does not hold is empty. Most entries are those of `validate`.
struct RunData {
  std::filesystem::path folder;
  std::string verb;  ///< what made it, as its manifest tells
  std::string case_name, title, description, status;
  std::vector<double> depths;  ///< where force errors are given [m]
  Target target;
  std::vector<Criterion> criteria;
  JsonEntry manifest;               ///< an empty object when absent
  JsonEntry summary;                ///< summary.json, likewise
  JsonEntry own_calibration;        ///< calibration.json, likewise
  std::string parameters;           ///< parameters.toml as text
  JsonEntry reference_summary;      ///< reference/summary.json, likewise; its own of `reference`
  JsonEntry reference_job;          ///< reference/job.json, likewise
  JsonEntry verification;           ///< verification/verification.json, likewise
  meshes::PressResponse response;   ///< of a press itself
  CsvTable contact, modes;          ///< of a static press; of `modes` or the continuum's
  meshes::PressResponse reference;  ///< empty when the continuum was not run
  CsvTable convergence, section, pressure;  ///< of the continuum
  CsvTable cubes, published_study, equilibrium_study;
  CsvTable variants;              ///< of a study
  JsonEntry study;                ///< "variants" of its summary.json; an empty object otherwise
  JsonEntry calibration;          ///< "calibration" of its summary.json, likewise
  JsonList presses;               ///< "presses" of a case on virtual control; else empty
  JsonList grasps;                ///< "grasps" of a case on grasps; else empty
  std::vector<ModelData> models;  ///< published, central, hookean, then any others

  const ModelData* model(const std::string& name) const;
};

/// Reads any run folder. What is damaged stays empty and is noted in `reader`. Throws InvalidInput
/// when the folder holds neither a summary.json nor a calibration.json.
RunData read_run(const std::filesystem::path& folder, FolderReader& reader);

/// Whether `folder` is the run of `reference`, which keeps its job.json at the top.
bool is_continuum(const std::filesystem::path& folder);
/// Whether `run` is a `calibrate` that fitted moduli.
bool is_moduli_fit(const RunData& run);

/// Normal force [N] at `depth` [m]; NaN when the press did not get there. A controller may stop a
/// rounding error short of the last depth.
double force_at(const meshes::PressResponse& response, double depth);

}  // namespace fingertip::studies::reporting
