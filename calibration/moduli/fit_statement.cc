#include "calibration/moduli/fit_statement.h"

#include <cmath>
#include <string_view>

#include "calibration/files/words.h"

namespace fingertip::calibration::inline moduli {
namespace {

std::string pascals(double value) {
  return rounded(value, 5) + " Pa";
}

std::string hookean_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  return "E = " + pascals(rubber.youngs_modulus) + ", G = " + pascals(rubber.shear_modulus) +
         " and nu = " + rounded(rubber.poissons_ratio(), 6) +
         " are reached along every direction (anisotropy " + rounded(fit.achieved.anisotropy, 10) +
         "). Springs alone could not: along the lines between particles they force C12 = C44 "
         "whatever their constants (the Cauchy relation), which makes nu = 1/4 the only isotropic "
         "choice. The volume constant kappa = lambda - G = " +
         pascals(fit.constants.kappa) +
         " of the cells adds to C11 and C12 alone and so frees nu. Positive spring constants do "
         "this for every rubber with -1 < nu < 1/2.";
}

std::string over_target(double value, double target) {
  const double percent = 100.0 * (value / target - 1.0);
  return (percent < 0.0 ? "" : "+") + rounded(percent, 3) + " %";
}

std::string instead_of(double value, double target) {
  return pascals(value) + " instead of " + pascals(target) + " (" + over_target(value, target) +
         ")";
}

constexpr std::string_view cauchy_relation =
    "Springs along the lines between particles force C12 = C44 whatever their constants (the "
    "Cauchy relation), so an isotropic lattice of them has nu = 1/4. ";

std::string directions_part(const ElasticModuli& got) {
  return "an E that depends on direction, E_110 = " + pascals(got.youngs_modulus_110) +
         " and E_111 = " + pascals(got.youngs_modulus_111) + " (anisotropy " +
         rounded(got.anisotropy) + ")";
}

std::string central_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  const ElasticModuli& got = fit.achieved;
  const std::string text =
      "E_100 = " + pascals(got.youngs_modulus_100) + " and G = " + pascals(got.shear_modulus) +
      " are reached; non-negative constants exist for every rubber with -1 < nu < 1/2, but they "
      "leave nothing free. " +
      std::string(cauchy_relation);
  const double nu = rubber.poissons_ratio();
  if (std::abs(nu - 0.25) < 1e-6)
    return text + "This rubber has nu = 1/4, the one case in which that costs nothing.";
  return text + "This rubber has nu = " + rounded(nu) +
         ", which is out of reach: the price is nu_100 = " + rounded(got.poissons_ratio_100) +
         ", K = " + instead_of(got.bulk_modulus, rubber.bulk_modulus()) + ", and " +
         directions_part(got) + ".";
}

std::string compromise_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  const ElasticModuli& got = fit.achieved;
  const ElasticModuli exact =
      fit_moduli(rubber, {.model = fit.model, .spacing = fit.spacing}).achieved;
  const double nu = rubber.poissons_ratio();
  const std::string text(cauchy_relation);
  if (std::abs(nu - 0.25) < 1e-6)
    return text + "This rubber has nu = 1/4, so E, G, K and isotropy are all reached.";
  return text + "This rubber has nu = " + rounded(nu) +
         ", so E, G, K and isotropy are out of reach together, and the weights (isotropy " +
         rounded(fit.isotropy_weight) + ", bulk modulus " + rounded(fit.bulk_weight) +
         ") make a compromise: E_100 = " +
         instead_of(got.youngs_modulus_100, rubber.youngs_modulus) +
         ", G = " + instead_of(got.shear_modulus, rubber.shear_modulus) +
         ", K = " + instead_of(got.bulk_modulus, rubber.bulk_modulus()) +
         ", nu_100 = " + rounded(got.poissons_ratio_100) + ", and " + directions_part(got) +
         ". Traded for that were E_100 and G: without weights both are met exactly, with K = " +
         instead_of(exact.bulk_modulus, rubber.bulk_modulus()) + " and anisotropy " +
         rounded(exact.anisotropy) + ".";
}

std::string model_part(const ModuliFit& fit) {
  if (fit.model == lattice::ModelKind::hookean) return hookean_part(fit);
  return fit.is_compromise() ? compromise_part(fit) : central_part(fit);
}

}  // namespace

std::string describe_direction(const Eigen::Vector4d& direction) {
  static constexpr const char* names[] = {"k1", "k2", "k3", "kappa"};
  const Eigen::Vector4d scaled = direction / direction.cwiseAbs().maxCoeff();
  std::string text;
  for (int i = 0; i < 4; ++i) {
    if (std::abs(scaled(i)) < 1e-8) continue;
    if (!text.empty()) text += ", ";
    text +=
        std::string(names[i]) + (scaled(i) > 0.0 ? " + " : " - ") + rounded(std::abs(scaled(i)), 6);
  }
  return text;
}

std::string fit_statement(const ModuliFit& fit) {
  const bool body_diagonals = fit.constants.k3 > 1e-9 * fit.constants.k2;
  return model_part(fit) + " The tests cannot tell apart constants that differ along (" +
         describe_direction(fit.unidentifiable) +
         "): the moduli see the springs only through k1 + 2 k2 + 4/3 k3 and k2 + 4/3 k3."
         " Of these the constants whose weaker one of k1 and k2 is largest were chosen, farthest "
         "from "
         "the lattices with motions that cost nothing: k3 = " +
         (body_diagonals ? rounded(fit.constants.k3) + " N/m"
                         : std::string("0, no body diagonals")) +
         ". A single cell has no such motion.";
}

}  // namespace fingertip::calibration::inline moduli
