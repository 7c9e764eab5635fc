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
    if (json.at("units") != nlohmann::json(column_units)) refuse("units must be m, N, N/m and N");
    json.at("knots").get_to(table.knots);
    json.at("force").get_to(table.force);
    json.at("stiffness").get_to(table.stiffness);
    json.at("band").get_to(table.band);
    json.at("statement").get_to(table.statement);
    json.at("condition").get_to(table.condition);
  } catch (const nlohmann::json::exception& error) {
    refuse(std::string("no curve: ") + error.what());
  }
  std::vector<meshes::Violation> broken = table.violations();
  for (meshes::Violation& violation : broken) violation.key = file.string() + ": " + violation.key;
  if (!broken.empty()) throw InvalidInput(broken);
  return Surrogate(std::move(table));
}

}  // namespace fingertip::calibration::inline surrogate
