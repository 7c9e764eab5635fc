#include "calibration/fit_statement.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace fingertip::calibration {
namespace {

std::string rounded(double value, int digits = 4) {
  std::ostringstream out;
  out << std::setprecision(digits) << value;
  return out.str();
}

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

std::string central_part(const ModuliFit& fit) {
  const meshes::Rubber& rubber = fit.target;
  const ElasticModuli& got = fit.achieved;
  std::string text =
      "E_100 = " + pascals(got.youngs_modulus_100) + " and G = " + pascals(got.shear_modulus) +
      " are reached; non-negative constants exist for every rubber with -1 < nu < 1/2, but they "
      "leave nothing free. Springs along the lines between particles force C12 = C44 whatever "
      "their constants (the Cauchy relation), so an isotropic lattice of them has nu = 1/4. ";
  const double nu = rubber.poissons_ratio();
  if (std::abs(nu - 0.25) < 1e-6)
    return text + "This rubber has nu = 1/4, the one case in which that costs nothing.";
  return text + "This rubber has nu = " + rounded(nu) +
         ": the price is nu_100 = " + rounded(got.poissons_ratio_100) +
         ", K = " + pascals(got.bulk_modulus) + " instead of " + pascals(rubber.bulk_modulus()) +
         ", and an E that depends on direction, E_110 = " + pascals(got.youngs_modulus_110) +
         " and E_111 = " + pascals(got.youngs_modulus_111) + " (anisotropy " +
         rounded(got.anisotropy) + ").";
}

std::string open_directions(const ModuliFit& fit) {
  std::string text;
  for (const Eigen::Vector4d& direction : fit.unidentifiable)
    text += " The tests cannot tell apart constants that differ along (" +
            describe_direction(direction) +
            "): the moduli see the springs only through k1 + 2 k2 + 4/3 k3 and k2 + 4/3 k3.";
  return text;
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

std::string fit_statement(const ModuliFit& fit, int cell_mechanisms) {
  const double body_diagonal = fit.constants.k3 / fit.constants.k2;
  std::string text =
      (fit.model == lattice::ModelKind::hookean ? hookean_part(fit) : central_part(fit)) +
      open_directions(fit) +
      " Of these the constants whose weaker one of k1 and k2 is largest were chosen, farthest from "
      "the lattices with motions that cost nothing: k3 = " +
      (body_diagonal < 1e-9 ? std::string("0, no body diagonals")
                            : rounded(fit.constants.k3) + " N/m") +
      ".";
  text += cell_mechanisms == 0
              ? " A single cell has no such motion."
              : " A single cell has " + std::to_string(cell_mechanisms) + " of them.";
  return text + " " + std::to_string(fit.starts_agreeing) + " of " + std::to_string(fit.starts) +
         " random starts ended here.";
}

}  // namespace fingertip::calibration
