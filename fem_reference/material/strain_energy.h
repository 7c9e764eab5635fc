/// Hyperelastic laws of rubber at large strain, one point at a time.
#pragma once

#include <Eigen/Core>

#include "fem_reference/job.h"
#include "meshes/rubber.h"

namespace fingertip::fem_reference {

/// Energy and its derivatives with respect to the deformation gradient F at one point.
struct PointResponse {
  double energy;                        ///< W per reference volume [J/m³]
  Eigen::Matrix3d stress;               ///< P_iJ = dW/dF_iJ, first Piola-Kirchhoff [Pa]
  Eigen::Matrix<double, 9, 9> tangent;  ///< dP_iJ/dF_kL in row 3i + J, column 3k + L [Pa]
};

/// h(J) and its derivatives; the volumetric part of the energy is m/2 h².
struct VolumetricMeasure {
  double value;   ///< h
  double first;   ///< h'
  double second;  ///< h''
};

/// A compressible neo-Hookean law with the E and G (hence lambda, K) of `meshes::Rubber` at small
/// strain, free of stress at F = 1. With J = det F and I1 = tr FᵀF,
///
///   law_a  W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)²   the project's standard; Simo & Pister
///          1984; Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis
///   law_b  W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (J - 1)²  Pence & Gou, Math. Mech. Solids 20, 2015
///   law_c  W = G/2 (J^(-2/3) I1 - 3) + K/2 (ln J)²        volume apart from shape after Flory
///          1961; Simo & Hughes, Computational Inelasticity
///
/// (Korobeynikov, Larichkin & Neff, arXiv 2506.22244, compare the two families.)
/// All carry Treloar's network term G/2 I1 (The Physics of Rubber Elasticity); they differ in what
/// a change of volume costs. W for F = J^(1/3) Q, Q a rotation, and lambda > 0:
///
///            J -> 0                                    J -> infinity
///   law_a    lambda/2 (ln J)²                          3G/2 J^(2/3)
///   law_b    -G ln J alone; the volumetric term        lambda/2 J²
///            stops at lambda/2: nearly no barrier
///   law_c    K/2 (ln J)²                               K/2 (ln J)²; tension falls beyond J = e
///
/// A solver finds collapsed elements with law_b more easily than with the others.
///
/// The energy comes in two parts, so that an element can project the volumetric one:
/// W = pointwise(F).energy + volumetric_modulus()/2 volumetric(J).value². Beware that `pointwise`
/// of laws A and B still contains -G ln J and is free of stress at F = 1 by itself.
/// No function allocates; F is any matrix with det F > 0, and every function throws
/// std::domain_error for det F <= 0 or NaN: the element is inverted, the step was too large.
class HyperelasticLaw {
 public:
  /// Throws InvalidInput for a rubber that breaks its own rules, and for nu < 0 (lambda < 0) with
  /// law A or B, whose energies then fall without bound (A as J -> 0, B as J -> infinity). Law C,
  /// which needs K > 0 only, takes every rubber.
  HyperelasticLaw(StrainEnergy law, const meshes::Rubber& rubber);

  /// Everything except the volumetric term.
  PointResponse pointwise(const Eigen::Matrix3d& F) const;

  /// m [Pa]: lambda for laws A and B, K for law C.
  double volumetric_modulus() const { return volumetric_modulus_; }

  /// h(J) = ln J for laws A and C, J - 1 for law B; J > 0.
  VolumetricMeasure volumetric(double J) const;

  /// Both parts together, the volumetric one at J = det F.
  PointResponse complete(const Eigen::Matrix3d& F) const;

  /// sigma = P Fᵀ / J [Pa], symmetric, of both parts.
  Eigen::Matrix3d cauchy_stress(const Eigen::Matrix3d& F) const;

 private:
  /// An isotropic W(F, J) of the first degree in I1, by its coefficients: with H = F^(-T),
  ///   P = along F - inverse H,
  ///   dP_iJ/dF_kL = along d_ik d_JL + inverse H_kJ H_iL + normal H_iJ H_kL
  ///                 + mixed (F_iJ H_kL + H_iJ F_kL),
  /// because dH_iJ/dF_kL = -H_kJ H_iL and dJ/dF = J H.
  struct Terms {
    double energy, along, inverse, normal, mixed;
  };
  Terms pointwise_terms(double I1, double J) const;
  void add_volumetric(Terms& terms, double J) const;

  StrainEnergy law_;
  double shear_modulus_, volumetric_modulus_;
};

}  // namespace fingertip::fem_reference
