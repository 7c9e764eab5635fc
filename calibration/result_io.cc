#include "calibration/result_io.h"

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "calibration/fit_statement.h"
#include "calibration/json_parts.h"
#include "calibration/words.h"
#include "meshes/files.h"

namespace fingertip::calibration {
namespace {

using nlohmann::ordered_json;

ordered_json direction_json(const Eigen::Vector4d& direction) {
  return {{"k1", direction(0)},
          {"k2", direction(1)},
          {"k3", direction(2)},
          {"kappa", direction(3)},
          {"meaning", describe_direction(direction)}};
}

}  // namespace

Material material_from(const ModuliFit& fit) {
  Material material;
  material.model = fit.model;
  material.spacing = fit.spacing;
  material.constants = fit.constants;
  material.rubber = fit.target;
  material.kinematics = lattice::Kinematics::small;
  // What rounding adds to E/(2G) - 1 says nothing: 0.45, not 0.44999999999999996.
  material.validity.smallest_poissons_ratio = material.validity.largest_poissons_ratio =
      std::stod(rounded(fit.target.poissons_ratio(), 15));
  material.provenance =
      "moduli: least-squares fit of the homogenised lattice to E and G of the "
      "rubber, " +
      std::to_string(fit.starts) + " random starts";
  material.statement =
      fit.statement +
      " For small strain and lattices weighted per cell; for another spacing k1, k2, k3 scale with "
      "it and kappa stays.";
  return material;
}

void write_calibration_json(const ModuliFit& fit, const std::filesystem::path& file) {
  ordered_json json;
  json["model"] = lattice::name(fit.model);
  json["spacing"] = fit.spacing;
  json["constants"] = constants_json(fit.model, fit.constants, fit.target);
  json["damping"] = {{"retardation_time", fit.target.retardation_time}};
  json["target"] = rubber_json(fit.target);
  json["achieved"] = moduli_json(fit.achieved);
  json["covariance"] = nullptr;
  json["unidentifiable"] = ordered_json::array();
  for (const Eigen::Vector4d& direction : fit.unidentifiable)
    json["unidentifiable"].push_back(direction_json(direction));
  json["residuals"] = ordered_json::object();
  for (std::size_t i = 0; i < fit.residual_names.size(); ++i)
    json["residuals"][fit.residual_names[i]] = fit.residuals(Eigen::Index(i));
  json["statement"] = fit.statement;
  meshes::write_atomically(file, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

}  // namespace fingertip::calibration
