#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>

#include "calibration/surrogate/surrogate.h"
#include "meshes/files.h"

namespace fingertip::calibration {
namespace {

using meshes::InvalidInput;
using meshes::to_text;
using nlohmann::ordered_json;

const nlohmann::json column_units = {
    {"knots", "m"}, {"force", "N"}, {"stiffness", "N/m"}, {"band", "N"}};

}  // namespace

void write_surrogate_csv(const Surrogate& surrogate, const std::filesystem::path& file, int rows) {
  if (rows < 2)
    throw InvalidInput({"rows", std::to_string(rows), "a table has at least 2 rows", "take 65"});
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "indentation [m],force [N],stiffness [N/m],force_lower [N],force_upper [N]\n";
    for (int row = 0; row < rows; ++row) {
      const double x = surrogate.depth() * row / (rows - 1);
      const double force = surrogate.force(x), band = surrogate.band(x);
      out << to_text(x) << ',' << to_text(force) << ',' << to_text(surrogate.stiffness(x)) << ','
          << to_text(std::max(0.0, force - band)) << ',' << to_text(force + band) << '\n';
    }
  });
}

void write_surrogate_json(const Surrogate& surrogate, const std::filesystem::path& file) {
  const SurrogateTable& table = surrogate.table();
  const ordered_json json = {{"knots", table.knots},         {"force", table.force},
                             {"stiffness", table.stiffness}, {"band", table.band},
                             {"statement", table.statement}, {"condition", table.condition},
                             {"units", column_units}};
  meshes::write_atomically(file, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
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
    if (json.at("units") != column_units) refuse("units must be m, N, N/m and N");
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

}  // namespace fingertip::calibration
