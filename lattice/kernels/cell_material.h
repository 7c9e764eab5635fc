/// What cells are made of and how the kernel finds them: plain data, shared with the kernel.
#pragma once

#include <cstdint>
#include <limits>

#include "meshes/rubber/strain_energy.h"

namespace fingertip::lattice::inline kernels {

/// What a cell stores per volume of its rubber, as a function of the mean F = 1 + H of dx/dX over
/// that rubber and of its bilinear modes q (README of this folder):
///
///   cubic    ½ eps:C:eps + ½ mu_h q:Omega:q              small strain, eps = (H + Hᵀ)/2
///   volume   kappa/2 (J - 1)²                            beside central springs, J = det F
///   network  law A + ½ mu_h q:Omega:q, law A = G/2 (|F|² - 3) - G ln J + lambda/2 (ln J)²
///   hyperelastic
///            W(F, excess) of any other law of large strain (meshes/rubber/hyperelastic_law.h);
///            excess = mu_h/G q:Omega:q, so that fibres are springs whose constant grows with the
///            cell's stretch, for laws of I1 as 2 W'(I1)/G
///
/// Damping (Kelvin-Voigt): `cubic` sees u + tau v instead of u. Laws of large strain add, with L
/// the mean velocity gradient dv/dx and D its symmetric part, the Kirchhoff stress tau (lambda tr D
/// + 2 G D) and on the bilinear modes mu_h tau Omega (dq/dt - L q); `volume` adds to dW/dF the
/// stress tau kappa dJ/dt cof F. All are objective, so no rigid motion of a deformed cell is
/// damped, and equal to tau times the stiffness at rest.
enum class CellLawKind { cubic, volume, network, hyperelastic };

struct CellMaterial {
  CellLawKind kind = CellLawKind::cubic;
  double c11 = 0.0, c12 = 0.0, c44 = 0.0;  ///< cubic, along the grid's axes [Pa]
  double kappa = 0.0;                      ///< volume [Pa]
  double shear = 0.0, lambda = 0.0;        ///< network and beyond: G > 0, lambda at rest [Pa]
  meshes::StrainEnergy energy;             ///< hyperelastic
  double volumetric = 0.0;                 ///< of these m, of their m/2 h(J)² [Pa]
  double hourglass_modulus = 0.0;          ///< mu_h, the fibres' share of C44 or G [Pa]
  double retardation_time = 0.0;           ///< tau [s], not negative

  struct Cubic {
    double c11, c12, c44;
  };
  /// What W amounts to at small strain [Pa].
  Cubic at_rest() const {
    if (large_strain()) return {lambda + 2.0 * shear, lambda, shear};
    return kind == CellLawKind::volume ? Cubic{kappa, kappa, 0.0} : Cubic{c11, c12, c44};
  }
  /// `cubic` without its resistance to a change of volume.
  CellMaterial shear_alone() const {
    CellMaterial result = *this;
    const double bulk = (c11 + 2.0 * c12) / 3.0;
    result.c11 -= bulk;
    result.c12 -= bulk;
    return result;
  }
  /// Whether the law is one of rubber at large strain, which needs J > 0.
  bool large_strain() const { return kind != CellLawKind::cubic && kind != CellLawKind::volume; }
  /// Whether the fibres along the edges stiffen with the cell.
  bool holds_fibres() const { return kind == CellLawKind::hyperelastic; }
  /// Whether nothing is stored, whatever the deformation.
  bool none() const {
    const auto [a, b, c] = at_rest();
    return a == 0.0 && b == 0.0 && c == 0.0 && hourglass_modulus == 0.0;
  }
};

/// `lanes` cells that follow one another along the grid's x; some of them may be absent.
struct CellBlock {
  static constexpr std::uint32_t whole = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t first = 0;  ///< grid index of the lowest corner of the first cell
  /// `whole` where all cells are present and wholly in the rubber, else the position in
  /// CellLattice::cut of the block's values.
  std::uint32_t cut = whole;
};

}  // namespace fingertip::lattice::inline kernels
