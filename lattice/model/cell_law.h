/// What a lattice cell stores in its mean displacement gradient at equilibrium, with its tangent.
#pragma once

#include <Eigen/Core>

#include "lattice/kernels/cell_material.h"
#include "meshes/rubber/hyperelastic_law.h"

namespace fingertip::lattice::inline model {

/// Energy and derivatives with respect to H = dx/dX - 1; index 3 i + J of H_iJ.
struct CellResponse {
  double energy = 0.0;                  ///< [J/m³]
  Eigen::Matrix<double, 9, 1> stress;   ///< dW/dH [Pa]
  Eigen::Matrix<double, 9, 9> tangent;  ///< d²W/dH² [Pa]
  /// With respect to `excess`: dW, d²W, d²W/(dexcess dH) [Pa]; 0 for laws that have fibres apart.
  double slope = 0.0, curvature = 0.0;
  Eigen::Matrix3d mixed = Eigen::Matrix3d::Zero();
};

/// The law of `hyperelastic`, point by point.
meshes::HyperelasticLaw hyperelastic_law(const CellMaterial& material);

/// The law of a material (kernels/cell_law.h) less what fibres along the edges carry of it, which
/// equilibria count edge by edge: W(H) - mu_h/2 |H|² (cubic), W(H) - mu_h/2 (|F|² - 3).
/// Laws that hold their fibres (CellMaterial) see `excess` instead, the share of the fibres times
/// what the edges' gradients differ by. Laws
/// of large strain need J > 0.
struct CellLaw {
  CellMaterial material;
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns: those of `cubic`

  /// Throws std::domain_error where J <= 0 and the law needs J > 0.
  CellResponse evaluate(const Eigen::Matrix3d& H, double excess = 0.0) const;
  /// Energy alone [J/m³]; infinite instead of an exception.
  double energy(const Eigen::Matrix3d& H, double excess = 0.0) const;
  /// Whether stress is proportional to H: the tangent is constant and rest is free of stress.
  bool linear() const { return material.kind == CellLawKind::cubic || none(); }
  /// Whether cells store nothing at all.
  bool none() const { return material.none(); }
};

}  // namespace fingertip::lattice::inline model
