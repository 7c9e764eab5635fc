#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "calibration/files/fit_file.h"
#include "calibration/files/fit_tables.h"
#include "calibration/surrogate/surrogate.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::calibration::inline surrogate {
namespace {

using meshes::InvalidInput;

const std::map<std::string, std::string> column_units = {
    {"knots", "m"}, {"force", "N"}, {"stiffness", "N/m"}, {"band", "N"}};

}  // namespace

void write_surrogate_csv(const Surrogate& surrogate, const std::filesystem::path& file) {
  constexpr int steps = 64;
  std::vector<SurrogateRow> table;
  for (int row = 0; row <= steps; ++row) {
    const double x = surrogate.depth() * row / steps;
    const double force = surrogate.force(x), band = surrogate.band(x);
    table.push_back({x, force, surrogate.stiffness(x), std::max(0.0, force - band), force + band});
  }
  meshes::write_rows(table, file);
}

void write_surrogate_json(const Surrogate& surrogate, const std::filesystem::path& file) {
  const SurrogateTable& table = surrogate.table();
  const SurrogateFile content{table.knots,     table.force,     table.stiffness, table.band,
                              table.statement, table.condition, column_units};
  meshes::write_json_file(content, file);
}

Surrogate read_surrogate_json(const std::filesystem::path& file) {
  const auto refuse = [&](const std::string& rule) {
    throw InvalidInput({file.string(), "", rule, "make the curve anew"});
  };
  SurrogateTable table;
  try {
    std::ifstream in(file);
    if (!std::filesystem::is_regular_file(file) || !in) refuse("the file cannot be read");
    const nlohmann::json json = nlohmann::json::parse(in);
    SurrogateFile content;
    meshes::read_json(json, content);
    if (content.units != column_units) refuse("units must be m, N, N/m and N");
    table = {content.knots, content.force,     content.stiffness,
             content.band,  content.condition, content.statement};
  } catch (const nlohmann::json::exception& error) {
    refuse(std::string("no curve: ") + error.what());
  }
  std::vector<meshes::Violation> broken = table.violations();
  for (meshes::Violation& violation : broken) violation.key = file.string() + ": " + violation.key;
  if (!broken.empty()) throw InvalidInput(broken);
  return Surrogate(std::move(table));
}

}  // namespace fingertip::calibration::inline surrogate
