/// The energy per volume that a lattice cell stores in its mean displacement gradient.
#pragma once

#include <Eigen/Core>

#include "lattice/model/constants.h"
#include "meshes/rubber.h"

namespace fingertip::lattice {

/// Energy and derivatives with respect to H = dx/dX - 1; index 3 i + J of H_iJ.
struct CellResponse {
  double energy = 0.0;                  ///< [J/m³]
  Eigen::Matrix<double, 9, 1> stress;   ///< dW/dH [Pa]
  Eigen::Matrix<double, 9, 9> tangent;  ///< d²W/dH² [Pa]
};

/// What is left of the material's energy when the springs have taken their share:
///
///   none     0
///   cubic    ½ eps:C:eps - s C44/2 |H|²   small strain; s the share of the shear energy that
///            isotropic edge fibres of stiffness s C44 a carry
///   volume   kappa/2 (tr H)², finite: kappa/2 (J - 1)²   beside central springs
///   network  (1 - s) G/2 (I1 - 3) - G ln J + lambda/2 (ln J)²   with the fibres' s G/2 (I1 - 3):
///            law A of the continuum (compressible neo-Hooke; Treloar's network of fibres under a
///            cell pressure)
///
/// eps = (H + Hᵀ)/2, J = det(1 + H), I1 = |1 + H|². No law but `network` needs J > 0.
class CellLaw {
 public:
  CellLaw() = default;  // none

  /// C by homogenisation of springs and volume constant (README of model/): C12 = C44 + kappa,
  /// C11 = (k1 + 2 k2 + 4/3 k3)/a + kappa, C44 = (k2 + 4/3 k3)/a, along the columns of `axes`, a
  /// rotation. `spacing` a > 0 [m], 0 <= `share` s <= 1.
  static CellLaw cubic(const SpringConstants& constants, double spacing, double share,
                       const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());
  /// `kappa` [Pa].
  static CellLaw volume(double kappa, bool finite);
  /// nu >= 0, or the energy has no bound below as J -> 0; not checked. 0 <= `share` s <= 1.
  static CellLaw network(const meshes::Rubber& rubber, double share);
  /// The same with `shear` G and `lambda` [Pa] of any sign, as derivatives of the law have them.
  static CellLaw network(double shear, double lambda, double share);

  /// Throws std::domain_error where J <= 0 and the law needs J > 0.
  CellResponse evaluate(const Eigen::Matrix3d& H) const;
  /// Energy alone [J/m³]; infinite instead of an exception.
  double energy(const Eigen::Matrix3d& H) const;
  /// Whether stress is proportional to H: the tangent is constant and rest is free of stress.
  bool linear() const { return kind_ == Kind::none || kind_ == Kind::linear; }
  /// Whether cells store nothing at all.
  bool none() const { return kind_ == Kind::none; }

 private:
  enum class Kind { none, linear, finite_volume, network };
  CellResponse evaluate_volume(const Eigen::Matrix3d& F) const;
  CellResponse evaluate_network(const Eigen::Matrix3d& F) const;

  Kind kind_ = Kind::none;
  Eigen::Matrix<double, 9, 9> tangent_ = Eigen::Matrix<double, 9, 9>::Zero();  ///< linear [Pa]
  double kappa_ = 0.0;                                                         ///< volume [Pa]
  double shear_ = 0.0;       ///< G of the network [Pa]
  double lambda_ = 0.0;      ///< of the network [Pa]
  double cell_shear_ = 0.0;  ///< (1 - s) G: what the network's fibres leave to the cell [Pa]
};

}  // namespace fingertip::lattice
