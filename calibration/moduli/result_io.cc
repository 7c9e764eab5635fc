#include "calibration/moduli/result_io.h"

#include <string>

#include "calibration/files/words.h"
#include "calibration/material/file_parts.h"
#include "calibration/moduli/fit_statement.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::calibration::inline moduli {

Material material_from(const ModuliFit& fit) {
  Material material;
  material.model = fit.model;
  material.spacing = fit.spacing;
  material.constants = fit.constants;
  material.rubber = fit.target;
  material.rubber.relaxation = {};  // a fit to moduli knows no time: a press has its own
  material.kinematics = lattice::Kinematics::small;
  // What rounding adds to E/(2G) - 1 says nothing: 0.45, not 0.44999999999999996.
  material.validity.smallest_poissons_ratio = material.validity.largest_poissons_ratio =
      std::stod(rounded(fit.target.poissons_ratio(), 15));
  material.provenance = "moduli: fit of the homogenised lattice to E and G of the rubber";
  material.statement =
      fit_statement(fit) +
      " For small strain and lattices weighted per cell; for another spacing k1, k2, k3 scale with "
      "it and kappa stays.";
  return material;
}

void write_calibration_json(const ModuliFit& fit, const std::filesystem::path& file) {
  ModuliFile content;
  content.model = lattice::name(fit.model);
  content.spacing = fit.spacing;
  content.constants = constants_entry(fit.model, fit.constants, fit.target);
  content.damping = {fit.target.retardation_time};
  content.target = rubber_entry(fit.target);
  content.achieved = fit.achieved;
  const Eigen::Vector4d& open = fit.unidentifiable;
  content.unidentifiable = {{open(0), open(1), open(2), open(3), describe_direction(open)}};
  content.residuals = fit.residuals;
  content.statement = fit_statement(fit);
  meshes::write_json_file(content, file);
}

}  // namespace fingertip::calibration::inline moduli
