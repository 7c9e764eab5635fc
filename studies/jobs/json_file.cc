#include "studies/jobs/json_file.h"

#include <cmath>

#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"

namespace fingertip::studies::inline jobs {

void write_json(const nlohmann::ordered_json& content, const std::filesystem::path& file) {
  meshes::write_json_file(content, file);
}

nlohmann::ordered_json read_json(const std::filesystem::path& file) {
  return parse_json(file);
}

double number_of(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

}  // namespace fingertip::studies::inline jobs
