/// What a run folder holds, read back from disk; SI.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press_response.h"

namespace fingertip::studies::reporting {

/// NaN when there is none; NaN among others does not count.
double largest_magnitude(const std::vector<double>& values);

/// A CSV file whose first line holds names with units. Cells are kept as text.
struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;

  bool empty() const { return rows.empty(); }
  bool has(const std::string& name) const;
  /// The column as numbers, NaN where a cell is empty; all NaN when the column does not exist.
  std::vector<double> numbers(const std::string& name) const;
  /// The column as text, empty where it does not exist.
  std::vector<std::string> texts(const std::string& name) const;
};

/// Reads a CSV; an absent file is an empty table. Throws InvalidInput naming file and line for a
/// row whose number of cells differs from the header's.
CsvTable read_csv(const std::filesystem::path& file);

/// The JSON object in a file, empty when the file is absent. Throws InvalidInput for anything else.
nlohmann::json read_json(const std::filesystem::path& file);

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
  nlohmann::json summary;                     ///< NAME/summary.json; an empty object when absent
  nlohmann::json calibration;                 ///< calibration_NAME/calibration.json, likewise
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

/// A validate run.
struct RunData {
  std::filesystem::path folder;
  std::string verb;  ///< what made it: "validate" or "calibrate"
  std::string case_name, title, description, status;
  std::vector<double> depths;  ///< where force errors are given [m]
  Target target;
  std::vector<Criterion> criteria;
  nlohmann::json manifest;                  ///< an empty object when absent
  std::string parameters;                   ///< parameters.toml as text
  nlohmann::json reference_summary;         ///< reference/summary.json, likewise
  nlohmann::json reference_job;             ///< reference/job.json, likewise
  nlohmann::json verification;              ///< verification/verification.json, likewise
  meshes::PressResponse reference;          ///< empty when the continuum was not run
  CsvTable convergence, section, pressure;  ///< of the continuum
  CsvTable cubes, published_study, equilibrium_study;
  CsvTable variants;              ///< of a study
  nlohmann::json study;           ///< "variants" of its summary.json; an empty object otherwise
  nlohmann::json calibration;     ///< "calibration" of its summary.json, likewise
  nlohmann::json presses;         ///< "presses" of a case on virtual control; else an empty array
  nlohmann::json grasps;          ///< "grasps" of a case on grasps; else an empty array
  std::vector<ModelData> models;  ///< published, central, hookean, then any others

  const ModelData* model(const std::string& name) const;
};

/// Reads the run folder of a `validate`, or of a `calibrate` (no summary.json, but a
/// calibration.json that names its "problem"). Throws InvalidInput for other folders and when any
/// file is damaged.
RunData read_run(const std::filesystem::path& folder);

/// Normal force [N] at `depth` [m]; NaN when the press did not get there. A controller may stop a
/// rounding error short of the last depth.
double force_at(const meshes::PressResponse& response, double depth);

/// `json[key]` as a number; NaN when absent or null.
double number_at(const nlohmann::json& json, const std::string& key);
/// `json[key]` as numbers, NaN for entries that are none; empty when it is not an array.
std::vector<double> numbers_at(const nlohmann::json& json, const std::string& key);
/// `json[key]` as text: strings as they are, other values as JSON, "" when absent.
std::string text_at(const nlohmann::json& json, const std::string& key);
/// `json[key]` if it is an object, else an empty object.
nlohmann::json object_at(const nlohmann::json& json, const std::string& key);
/// `json[key]` if it is an array, else an empty array.
nlohmann::json array_at(const nlohmann::json& json, const std::string& key);

}  // namespace fingertip::studies::reporting
