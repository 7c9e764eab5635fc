#include "calibration/moduli/result_io.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>

#include "calibration/files/words.h"
#include "calibration/material/file_parts.h"
#include "meshes/tables/fields_json.h"

namespace fingertip::calibration::inline moduli {
namespace {

std::string instead_of(double value, double target) {
  return fmt::format("{:.5g} Pa instead of {:.5g} Pa ({}{:.3g} %)", value, target,
                     value < target ? "" : "+", 100.0 * (value / target - 1.0));
}

constexpr std::string_view cauchy_relation =
    "Springs along the lines between particles force C12 = C44 whatever their constants (the "
    "Cauchy relation), so an isotropic lattice of them has nu = 1/4. This rubber has nu = ";

std::string directions_part(const ElasticModuli& got) {
  return fmt::format(
      "an E that depends on direction, E_110 = {:.5g} Pa and E_111 = {:.5g} Pa (anisotropy {:.4g})",
      got.youngs_modulus_110, got.youngs_modulus_111, got.anisotropy);
}

std::string hookean_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  return fmt::format(
      "E = {:.5g} Pa, G = {:.5g} Pa and nu = {:.6g} are reached along every direction (anisotropy "
      "{:.10g}). Springs alone could not: along the lines between particles they force C12 = C44 "
      "whatever their constants (the Cauchy relation), which makes nu = 1/4 the only isotropic "
      "choice. The volume constant kappa = lambda - G = {:.5g} Pa of the cells adds to C11 and C12 "
      "alone and so frees nu. Positive spring constants do this for every rubber with -1 < nu < "
      "1/2.",
      rubber.youngs_modulus, rubber.shear_modulus, rubber.poissons_ratio(), fit.achieved.anisotropy,
      fit.constants.kappa);
}

std::string central_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  const ElasticModuli& got = fit.achieved;
  const double nu = rubber.poissons_ratio();
  return fmt::format(
             "E_100 = {:.5g} Pa and G = {:.5g} Pa are reached; non-negative constants exist for "
             "every rubber with -1 < nu < 1/2, but they leave nothing free. {}",
             got.youngs_modulus_100, got.shear_modulus, cauchy_relation) +
         (std::abs(nu - 0.25) < 1e-6
              ? "1/4, the one case in which that costs nothing."
              : fmt::format(
                    "{:.4g}, which is out of reach: the price is nu_100 = {:.4g}, K = {}, and {}.",
                    nu, got.poissons_ratio_100, instead_of(got.bulk_modulus, rubber.bulk_modulus()),
                    directions_part(got)));
}

std::string compromise_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  const ElasticModuli& got = fit.achieved;
  const ElasticModuli exact =
      fit_moduli(rubber, {.model = fit.model, .spacing = fit.spacing}).achieved;
  const double nu = rubber.poissons_ratio();
  if (std::abs(nu - 0.25) < 1e-6)
    return std::string(cauchy_relation) + "1/4, so E, G, K and isotropy are all reached.";
  return fmt::format(
      "{}{:.4g}, so E, G, K and isotropy are out of reach together, and the weights (isotropy "
      "{:.4g}, bulk modulus {:.4g}) make a compromise: E_100 = {}, G = {}, K = {}, nu_100 = "
      "{:.4g}, and {}. Traded for that were E_100 and G: without weights both are met exactly, "
      "with K = {} and anisotropy {:.4g}.",
      cauchy_relation, nu, fit.isotropy_weight, fit.bulk_weight,
      instead_of(got.youngs_modulus_100, rubber.youngs_modulus),
      instead_of(got.shear_modulus, rubber.shear_modulus),
      instead_of(got.bulk_modulus, rubber.bulk_modulus()), got.poissons_ratio_100,
      directions_part(got), instead_of(exact.bulk_modulus, rubber.bulk_modulus()),
      exact.anisotropy);
}

}  // namespace

std::string fit_statement(const ModuliFit& fit) {
  const std::string model = fit.model == lattice::ModelKind::hookean ? hookean_part(fit)
                            : fit.is_compromise()                    ? compromise_part(fit)
                                                                     : central_part(fit);
  const double k3 = fit.constants.k3;
  return fmt::format(
      "{} The tests cannot tell apart constants that differ along ({}): the moduli see the springs "
      "only through k1 + 2 k2 + 4/3 k3 and k2 + 4/3 k3. Of these the constants whose weaker one of "
      "k1 and k2 is largest were chosen, farthest from the lattices with motions that cost "
      "nothing: k3 = {}. A single cell has no such motion.",
      model, open_direction_words,
      k3 > 0.0 ? fmt::format("{:.4g} N/m", k3) : "0, no body diagonals");
}

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
  const Eigen::Vector4d open = open_direction();
  content.unidentifiable = {{open(0), open(1), open(2), open(3), open_direction_words}};
  content.residuals = fit.residuals;
  content.statement = fit_statement(fit);
  meshes::write_json_file(content, file);
}

}  // namespace fingertip::calibration::inline moduli
