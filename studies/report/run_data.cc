#include "studies/report/run_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "meshes/errors.h"

namespace fingertip::studies::reporting {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& value, const std::string& rule,
                         const std::string& remedy) {
  throw meshes::InvalidInput(meshes::Violation{file.string(), value, rule, remedy});
}

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return {};
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

meshes::PressResponse read_response(const fs::path& file) {
  return fs::exists(file) ? meshes::PressResponse::read_csv(file) : meshes::PressResponse();
}

/// Splits one CSV line; quoted cells may hold commas, "" stands for a quote.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

double parse(const std::string& cell) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? value : meshes::unknown;
}

/// The first finite one of several spellings.
double first_of(const json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const double value = number_at(object, key);
    if (std::isfinite(value)) return value;
  }
  return meshes::unknown;
}

Target read_target(const json& object) {
  Target target;
  target.youngs_modulus = first_of(object, {"youngs_modulus", "E"});
  target.shear_modulus = first_of(object, {"shear_modulus", "G"});
  if (!(target.youngs_modulus > 0.0 && target.shear_modulus > 0.0)) return target;
  // What follows from E and G need not be in the file.
  const double E = target.youngs_modulus, G = target.shear_modulus;
  target.poissons_ratio = E / (2.0 * G) - 1.0;
  target.bulk_modulus = E * G / (3.0 * (3.0 * G - E));
  return target;
}

ModelData read_model(const fs::path& folder, const std::string& name, const json& entry) {
  ModelData model;
  model.name = name;
  model.status = text_at(entry, "status");
  model.moduli = {number_at(entry, "E_100"), number_at(entry, "E_110"),  number_at(entry, "E_111"),
                  number_at(entry, "G"),     number_at(entry, "nu_100"), number_at(entry, "K")};
  model.force_error = numbers_at(entry, "force_error");
  model.l2_error = number_at(entry, "relative_l2_force_error");
  model.real_time_factor = number_at(entry, "real_time_factor");
  model.summary = read_json(folder / name / "summary.json");
  model.calibration = read_json(folder / ("calibration_" + name) / "calibration.json");
  model.response = read_response(folder / name / "response.csv");
  model.trace = read_csv(folder / name / "trace.csv");
  model.boundary = read_csv(folder / name / "boundary.csv");
  model.boundary_springs = read_csv(folder / name / "boundary_springs.csv");
  model.snapshots = read_csv(folder / name / "snapshots.csv");
  model.snapshot_points = read_csv(folder / name / "snapshot_points.csv");
  return model;
}

/// The order of the story: as printed, as fitted, as it should be; then whatever else was run.
std::vector<std::string> ordered_models(const json& models) {
  std::vector<std::string> names{"published", "central", "hookean"};
  std::erase_if(names, [&](const std::string& name) { return !models.contains(name); });
  for (const auto& [name, entry] : models.items()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<Criterion> read_criteria(const json& summary) {
  std::vector<Criterion> criteria;
  if (!summary.contains("criteria") || !summary.at("criteria").is_array()) return criteria;
  for (const json& entry : summary.at("criteria")) {
    const bool passed = entry.contains("passed") && entry.at("passed") == true;
    criteria.push_back(
        {text_at(entry, "name"), number_at(entry, "value"), number_at(entry, "limit"), passed});
  }
  return criteria;
}

}  // namespace

bool CsvTable::has(const std::string& name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> CsvTable::texts(const std::string& name) const {
  const auto column = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
  std::vector<std::string> values;
  values.reserve(rows.size());
  for (const auto& row : rows) values.push_back(column < names.size() ? row[column] : "");
  return values;
}

std::vector<double> CsvTable::numbers(const std::string& name) const {
  std::vector<double> values;
  for (const std::string& cell : texts(name)) values.push_back(parse(cell));
  return values;
}

json read_json(const fs::path& file) {
  if (!fs::exists(file)) return json::object();
  json content = json::parse(read_text(file), nullptr, false);
  if (!content.is_object()) {
    refuse(file, "", "must hold a JSON object", "the file is damaged: run the case again");
  }
  return content;
}

double largest_magnitude(const std::vector<double>& values) {
  double result = meshes::unknown;
  for (const double one : values) result = std::fmax(result, std::abs(one));
  return result;
}

CsvTable read_csv(const fs::path& file) {
  CsvTable table;
  std::ifstream stream(file);
  std::string line;
  std::size_t line_number = 0;
  while (std::getline(stream, line)) {
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells = split(line);
    if (table.names.empty()) {
      table.names = std::move(cells);
    } else if (cells.size() == table.names.size()) {
      table.rows.push_back(std::move(cells));
    } else {
      refuse(fmt::format("{}:{}", file.string(), line_number),
             fmt::format("{} cells", cells.size()),
             fmt::format("every row must have the header's {} cells", table.names.size()),
             "the file is truncated or damaged: run the case again");
    }
  }
  return table;
}

double force_at(const meshes::PressResponse& response, double depth) {
  if (response.empty() || depth > response.depth() * (1.0 + 1e-6)) return meshes::unknown;
  return response.normal_force_at(std::min(depth, response.depth()));
}

double ModelData::last_force_error() const {
  double last = meshes::unknown;
  for (double error : force_error) {
    if (std::isfinite(error)) last = error;
  }
  return last;
}

double number_at(const json& object, const std::string& key) {
  if (!object.is_object() || !object.contains(key)) return meshes::unknown;
  const json& value = object.at(key);
  return value.is_number() ? value.get<double>() : meshes::unknown;
}

std::string text_at(const json& object, const std::string& key) {
  if (!object.is_object() || !object.contains(key)) return "";
  const json& value = object.at(key);
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

json object_at(const json& object, const std::string& key) {
  if (!object.is_object() || !object.contains(key) || !object.at(key).is_object()) {
    return json::object();
  }
  return object.at(key);
}

json array_at(const json& object, const std::string& key) {
  if (!object.is_object() || !object.contains(key) || !object.at(key).is_array()) {
    return json::array();
  }
  return object.at(key);
}

std::vector<double> numbers_at(const json& object, const std::string& key) {
  std::vector<double> values;
  for (const json& entry : array_at(object, key))
    values.push_back(entry.is_number() ? entry.get<double>() : meshes::unknown);
  return values;
}

const ModelData* RunData::model(const std::string& name) const {
  for (const ModelData& candidate : models) {
    if (candidate.name == name) return &candidate;
  }
  return nullptr;
}

RunData read_run(const fs::path& folder) {
  const bool calibrated = read_json(folder / "calibration.json").contains("problem");
  if (!calibrated && !fs::exists(folder / "summary.json")) {
    refuse(folder, "", "must be the run folder of `validate`, with a summary.json",
           "run `fingertip validate` first, or name its folder");
  }
  const json summary = read_json(folder / "summary.json");
  const json models = object_at(summary, "models");
  RunData run;
  run.folder = folder;
  run.verb = calibrated ? "calibrate" : "validate";
  run.case_name = text_at(summary, "case");
  run.title = text_at(summary, "title");
  run.description = text_at(summary, "description");
  run.status = text_at(summary, "status");
  run.depths = numbers_at(summary, "depths");
  run.criteria = read_criteria(summary);
  run.manifest = read_json(folder / "manifest.json");
  run.parameters = read_text(folder / "parameters.toml");
  run.reference_summary = read_json(folder / "reference" / "summary.json");
  run.reference = read_response(folder / "reference" / "response.csv");
  run.reference_job = read_json(folder / "reference" / "job.json");
  run.verification = read_json(folder / "verification" / "verification.json");
  run.convergence = read_csv(folder / "reference" / "convergence.csv");
  run.section = read_csv(folder / "reference" / "section.csv");
  run.pressure = read_csv(folder / "reference" / "pressure.csv");
  run.cubes = read_csv(folder / "cubes.csv");
  run.published_study = read_csv(folder / "published_study.csv");
  run.equilibrium_study = read_csv(folder / "equilibrium_study.csv");
  run.variants = read_csv(folder / "variants.csv");
  run.study = object_at(summary, "variants");
  run.calibration = object_at(summary, "calibration");
  run.presses = array_at(summary, "presses");
  run.grasps = array_at(summary, "grasps");
  for (const std::string& name : ordered_models(models)) {
    run.models.push_back(read_model(folder, name, models.at(name)));
    run.models.back().force_error.resize(run.depths.size(), meshes::unknown);
  }
  run.target = read_target(object_at(summary, "target"));
  if (std::isnan(run.target.bulk_modulus))
    run.target = read_target(object_at(summary, "reference"));
  for (const ModelData& model : run.models) {
    if (std::isfinite(run.target.bulk_modulus)) break;
    run.target = read_target(object_at(model.calibration, "target"));
  }
  return run;
}

}  // namespace fingertip::studies::reporting
