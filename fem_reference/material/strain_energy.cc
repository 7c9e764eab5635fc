#include "fem_reference/material/strain_energy.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::fem_reference {
namespace {

void require_positive(double J) {
  if (!(J > 0.0))  // NaN as well
    throw std::domain_error("the material is turned inside out: det F = " + meshes::to_text(J));
}

/// J and H = F^(-T). The columns of J H are the cross products of those of F.
struct Inverse {
  explicit Inverse(const Eigen::Matrix3d& F) {
    transposed << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    J = F.col(0).dot(transposed.col(0));
    require_positive(J);
    transposed /= J;
  }
  double J;
  Eigen::Matrix3d transposed;
};

/// The formulas at HyperelasticLaw::Terms, written out.
template <class Terms>
PointResponse assemble(const Terms& t, const Eigen::Matrix3d& F, const Eigen::Matrix3d& H) {
  PointResponse response;
  response.energy = t.energy;
  response.stress = t.along * F - t.inverse * H;
  for (int i = 0; i < 3; ++i)
    for (int J = 0; J < 3; ++J) {
      const double of_H = t.normal * H(i, J) + t.mixed * F(i, J), of_F = t.mixed * H(i, J);
      for (int k = 0; k < 3; ++k)
        for (int L = 0; L < 3; ++L)
          response.tangent(3 * i + J, 3 * k + L) =
              t.inverse * H(k, J) * H(i, L) + of_H * H(k, L) + of_F * F(k, L);
    }
  response.tangent.diagonal().array() += t.along;
  return response;
}

/// lambda, for nu = 0 exactly 0: in other units than the user's, round-off may leave it just below.
double lame_lambda(const meshes::Rubber& rubber) {
  const double lambda = rubber.lame_lambda();
  return std::abs(lambda) < 1e-12 * rubber.shear_modulus ? 0.0 : lambda;
}

void refuse_negative_lambda(StrainEnergy law, const meshes::Rubber& rubber) {
  if (law == StrainEnergy::law_c || lame_lambda(rubber) >= 0.0) return;
  const std::string limit = law == StrainEnergy::law_a ? "0" : "infinity";
  throw meshes::InvalidInput(meshes::Violation{
      "rubber.youngs_modulus", meshes::to_text(rubber.youngs_modulus) + " Pa",
      "finite strain needs nu >= 0, that is E >= 2G: with a negative Lame constant lambda the "
      "energy falls without bound as J -> " +
          limit,
      "raise youngs_modulus to 2 shear_modulus or more, or use small strain"});
}

}  // namespace

HyperelasticLaw::HyperelasticLaw(StrainEnergy law, const meshes::Rubber& rubber)
    : law_(law),
      shear_modulus_(rubber.shear_modulus),
      volumetric_modulus_(law == StrainEnergy::law_c ? rubber.bulk_modulus()
                                                     : lame_lambda(rubber)) {
  auto broken = rubber.violations();
  if (!broken.empty()) throw meshes::InvalidInput(std::move(broken));
  refuse_negative_lambda(law, rubber);
}

HyperelasticLaw::Terms HyperelasticLaw::pointwise_terms(double I1, double J) const {
  const double G = shear_modulus_;
  if (law_ != StrainEnergy::law_c) return {G / 2 * (I1 - 3 - 2 * std::log(J)), G, G, 0.0, 0.0};
  const double root = std::cbrt(J), scaled = G / (root * root);
  return {(scaled * I1 - 3 * G) / 2, scaled, scaled * I1 / 3, 2.0 / 9.0 * scaled * I1,
          -2.0 / 3.0 * scaled};
}

VolumetricMeasure HyperelasticLaw::volumetric(double J) const {
  require_positive(J);
  if (law_ == StrainEnergy::law_b) return {J - 1.0, 1.0, 0.0};
  return {std::log(J), 1.0 / J, -1.0 / (J * J)};
}

void HyperelasticLaw::add_volumetric(Terms& terms, double J) const {
  const VolumetricMeasure h = volumetric(J);
  const double m = volumetric_modulus_;
  const double kirchhoff = m * h.value * h.first * J;  // J times the mean stress
  terms.energy += m / 2 * h.value * h.value;
  terms.inverse -= kirchhoff;
  terms.normal += m * (h.first * h.first + h.value * h.second) * J * J + kirchhoff;
}

PointResponse HyperelasticLaw::pointwise(const Eigen::Matrix3d& F) const {
  const Inverse inverse(F);
  return assemble(pointwise_terms(F.squaredNorm(), inverse.J), F, inverse.transposed);
}

PointResponse HyperelasticLaw::complete(const Eigen::Matrix3d& F) const {
  const Inverse inverse(F);
  Terms terms = pointwise_terms(F.squaredNorm(), inverse.J);
  add_volumetric(terms, inverse.J);
  return assemble(terms, F, inverse.transposed);
}

Eigen::Matrix3d HyperelasticLaw::cauchy_stress(const Eigen::Matrix3d& F) const {
  const Inverse inverse(F);
  Terms terms = pointwise_terms(F.squaredNorm(), inverse.J);
  add_volumetric(terms, inverse.J);
  // P Fᵀ with H Fᵀ = 1, so that the result is symmetric to the last bit.
  return (terms.along * F * F.transpose() - terms.inverse * Eigen::Matrix3d::Identity()) /
         inverse.J;
}

}  // namespace fingertip::fem_reference
