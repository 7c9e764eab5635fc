/// Hyperelastic laws of rubber at large strain, one point at a time.
#pragma once

#include <Eigen/Core>

#include "meshes/rubber/rubber.h"

namespace fingertip::meshes::inline rubber {

/// Energy and its derivatives with respect to the deformation gradient F at one point.
struct PointResponse {
  double energy;                        ///< W per reference volume [J/m³]
  Eigen::Matrix3d stress;               ///< P_iJ = dW/dF_iJ, first Piola-Kirchhoff [Pa]
  Eigen::Matrix<double, 9, 9> tangent;  ///< dP_iJ/dF_kL in row 3i + J, column 3k + L [Pa]
};

/// The same where the gradient fluctuates within a body whose mean gradient is F: `excess` is the
/// mean of |dx/dX - F|², or a share of it, and W that of I1 + excess. I2 grows with I1/3 times it,
/// an ogden law by excess/2 times the sum of mu_i times the mean of l^(alpha_i - 2): shears that
/// fluctuate cost G at rest, and what the law makes of it elsewhere.
struct FluctuatingResponse : PointResponse {
  double slope = 0.0;                               ///< dW/dexcess [Pa]
  double curvature = 0.0;                           ///< d²W/dexcess² [Pa]
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();  ///< d²W/(dexcess dF) [Pa]
};

/// h(J) and its derivatives; the volumetric part of the energy is m/2 h².
struct VolumetricMeasure {
  double value;   ///< h
  double first;   ///< h'
  double second;  ///< h''
};

/// The law that `Rubber::energy` names (strain_energy.h), with the E and G of the rubber at small
/// strain and free of stress at F = 1.
///
/// The energy comes in two parts, so that an element can project the volumetric one:
/// W = pointwise(F).energy + volumetric_modulus()/2 volumetric(J).value². Beware that `pointwise`
/// of a law of full invariants still contains -g ln J and is free of stress at F = 1 by itself.
///
/// What a change of volume costs, for F = J^(1/3) Q, Q a rotation, neo_hookean, and lambda > 0:
///
///                            J -> 0                               J -> infinity
///   logarithmic              lambda/2 (ln J)²                     3G/2 J^(2/3)
///   full_quadratic           -G ln J alone: nearly no barrier     lambda/2 J²
///   isochoric_logarithmic    K/2 (ln J)²                          K/2 (ln J)²; tension falls
///                                                                 beyond J = e
///   quadratic                K/2, no barrier: cells may collapse  K/2 J²
///
/// (Korobeynikov, Larichkin & Neff, arXiv 2506.22244, compare the families.)
///
/// No function allocates; F is any matrix with det F > 0, and every function throws
/// std::domain_error for det F <= 0 or NaN (the element is inverted) and beyond the limit of a gent
/// law: the step was too large.
class HyperelasticLaw {
 public:
  /// Throws InvalidInput for a rubber that breaks its own rules, for the law `linear`, and where a
  /// law of full invariants leaves m < 0: its energy falls without bound.
  explicit HyperelasticLaw(const Rubber& rubber);

  /// G and m as they are, unchecked: the law is linear in both.
  HyperelasticLaw(const StrainEnergy& energy, double shear_modulus, double volumetric_modulus)
      : energy_(energy), shear_modulus_(shear_modulus), volumetric_modulus_(volumetric_modulus) {}

  /// Everything except the volumetric term.
  PointResponse pointwise(const Eigen::Matrix3d& F) const;

  double volumetric_modulus() const { return volumetric_modulus_; }  ///< m [Pa]

  /// h(J), J > 0.
  VolumetricMeasure volumetric(double J) const;

  /// Both parts together, the volumetric one at J = det F.
  PointResponse complete(const Eigen::Matrix3d& F) const;

  /// Of both parts, `excess` >= 0.
  FluctuatingResponse fluctuating(const Eigen::Matrix3d& F, double excess) const;

  /// Of both parts [J/m³]; infinite instead of an exception.
  double energy(const Eigen::Matrix3d& F, double excess = 0.0) const;

 private:
  StrainEnergy energy_;
  double shear_modulus_, volumetric_modulus_;
};

/// m of a rubber with that law [Pa]; lambda = 0 but for round-off counts as 0.
double volumetric_modulus(const Rubber& rubber);

/// What forbids large strain to a rubber, whose own rules hold.
std::vector<Violation> large_strain_violations(const Rubber& rubber);

}  // namespace fingertip::meshes::inline rubber
