#include "studies/jobs/json_file.h"

#include <cmath>

#include "meshes/tables/fields_json.h"

namespace fingertip::studies::inline jobs {

void write_json(const nlohmann::ordered_json& content, const std::filesystem::path& file) {
  meshes::write_json_file(content, file);
}

double number_of(const nlohmann::ordered_json& value) {
  return value.is_number() ? value.get<double>() : std::nan("");
}

}  // namespace fingertip::studies::inline jobs
