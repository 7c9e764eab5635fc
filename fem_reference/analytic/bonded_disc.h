/// Elastic disc bonded to two rigid plates that approach each other: an upper bound and a Ritz
/// computation of its stiffness, which share nothing with a finite element code.
#pragma once

#include "meshes/rubber/rubber.h"

namespace fingertip::fem_reference::analytic {

/// Disc r <= R, |z| <= H/2, plates at z = ±H/2 with u_r = 0, u_z = ∓delta/2; side r = R free.
/// Stiffness k = F/delta [N/m]; A = pi R². There is no elementary closed form: where the bond meets
/// the free side the stress is infinite like distance^(alpha - 1).
///
/// **Bounds**, rigorous for every -1 < nu < 1/2:
///   E A/H <= k                       (the uniform stress is statically admissible)
///   k <= confined  (lambda + 2G) A/H (the uniform strain is kinematically admissible)
///   k <= stiffness(n) for every n    (minimum of the energy over fewer displacements)
///
/// **Ritz.** The axisymmetric energy is minimised over
///   u_r = Σ a_ij P_{2i+1}(r/R) N_{2j+1}(zeta),  u_z = -delta z/H + Σ b_ij P_{2i}(r/R)
///   N_{2j+2}(zeta)
/// with zeta = 2z/H, Legendre polynomials P and N_k = P_{k+1} - P_{k-1}, which vanish on the
/// plates; i, j = 0 ... n-1. All integrals are exact. The corner limits the convergence: the error
/// falls like n^(-4 alpha) (Babuška & Suri, SIAM Review 36 (1994) 578, for the p-version), where
/// alpha solves Williams' equation for a right angle with one side bonded and one free (J. Appl.
/// Mech. 19 (1952) 526), kappa sin²(alpha pi/2) = (kappa + 1)²/4 - alpha², kappa = 3 - 4 nu.
///
/// **Figures**, gf/cm, R = 1 cm, E = 40 gf/cm²; "reference" are the project's converged figures,
/// obtained by programs outside this repository:
///   H [cm]  nu   alpha  | n = 6    10      20      40     | extrapolated(20) | reference
///   0.5     3/7  0.634  | 435.84  434.63  434.26  434.19  | 434.177          | 434.2
///   0.5     1/4  0.745  | 284.08  283.96  283.93  283.92  | 283.921          | 283.9
///   1.0     3/7  0.634  | 165.65  165.35  165.25  165.23  | 165.231          | 165.2
///   1.0     1/4  0.745  | 135.37  135.34  135.33  135.33  | 135.326          | 135.3
/// extrapolated(40) differs from extrapolated(20) by less than 1e-5 of itself.
class BondedDisc {
 public:
  /// `radius` R, `thickness` H [m] > 0. Throws meshes::InvalidInput for these or the rubber.
  BondedDisc(const meshes::Rubber& rubber, double radius, double thickness);

  /// (lambda + 2G) A/H [N/m], an upper bound
  double confined_stiffness() const;

  /// Ritz stiffness [N/m] with n = `order`, 1 <= order <= 40 (2 n² unknowns, dense: 0.02 s at
  /// 20, 1.4 s at 40); an upper bound that falls with the order. Throws meshes::InvalidInput for
  /// any other order, meshes::NotConverged should the matrix be singular to working precision (not
  /// seen for H/R from 1e-3 to 1e3 and nu up to 0.5 - 1e-9, where rounding stays below 1e-5).
  double stiffness(int order) const;

  /// alpha above, 0.595 (nu = 1/2) to 1 (nu = 0). Throws meshes::InvalidInput for nu < 0, where no
  /// root lies below 1.
  double corner_exponent() const;
  /// Richardson extrapolation of stiffness(order) and stiffness(order/2) with the error law above
  /// [N/m], no bound. `order` even, 4 to 40; nu >= 0. Throws meshes::InvalidInput otherwise.
  double extrapolated_stiffness(int order) const;

 private:
  double area() const;

  meshes::Rubber rubber_;
  double radius_, thickness_;
};

}  // namespace fingertip::fem_reference::analytic
