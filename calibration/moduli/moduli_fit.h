/// Identification of spring constants from the rubber's moduli with Ceres.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calibration/material/moduli.h"
#include "lattice/model/constants.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline moduli {

struct ModuliFitOptions {
  lattice::ModelKind model = lattice::ModelKind::hookean;  ///< central or hookean
  double spacing = 0.0;                                    ///< a [m], > 0
  int starts = 10;    ///< random starts, >= 1; the best one is reported
  unsigned seed = 1;  ///< of the random starts
  /// central only, >= 0: what multiplies the residuals E_110/E_100 - 1 and E_111/E_100 - 1, both
  /// zero where Zener's A = 1, beside those of E_100 and G, whose weight is 1 (README).
  double isotropy_weight = 0.0;
  /// central only, >= 0: what multiplies the residual K over the rubber's, minus 1.
  double bulk_weight = 0.0;
};

/// What the fit reached, and what it cannot say.
struct ModuliFit {
  lattice::ModelKind model = lattice::ModelKind::hookean;
  double spacing = 0.0;  ///< [m]
  meshes::Rubber target;
  lattice::SpringConstants constants;
  ElasticModuli achieved;
  double isotropy_weight = 0.0, bulk_weight = 0.0;  ///< as given; 0 for hookean
  /// In the order of `residual_names`, without weights. hookean: C11, C12, C44 minus target, over
  /// the rubber's G (C12's target is zero at nu = 0, so it cannot be its own scale). central: E_100
  /// and G, each over its target, minus 1; with weights also E_110 and E_111 over E_100, K over its
  /// target, minus 1.
  Eigen::VectorXd residuals;
  std::vector<std::string> residual_names;
  /// Directions of (k1, k2, k3, kappa), unit length in units of (E a, E a, E a, E), along which the
  /// tests cannot tell constants apart: right singular vectors of the unregularised Jacobian with
  /// singular value below 1e-8 of the largest.
  std::vector<Eigen::Vector4d> unidentifiable;
  /// Every residual below 1e-9; of a compromise: no direction makes its loss smaller.
  bool converged = false;
  int iterations = 0;       ///< of the best start
  int starts = 0;           ///< random starts tried ...
  int starts_agreeing = 0;  ///< ... and how many of them ended at these constants, to 1e-6
  int cell_mechanisms = 0;  ///< motions of one cell that cost no energy

  /// Whether weights ask for more than central springs can reach.
  bool is_compromise() const { return isotropy_weight > 0.0 || bulk_weight > 0.0; }
};

/// Fits k1, k2, k3 >= 0 (and kappa for hookean, of either sign: it is negative for nu < 1/4) to E
/// and G of the rubber. Of the constants that fit equally well it returns those whose weaker one
/// of k1 and k2 is largest, the farthest from mechanisms (README); for hookean, and for central
/// with E >= 5/2 G, that means k3 = 0.
/// With weights the springs of central meet none of the targets but a compromise, the least sum of
/// squared residuals times weights; without, E_100 and G are exact.
/// Throws InvalidInput for published (it has a rule, not a fit), a non-positive spacing, no starts,
/// a weight that is negative or not finite, or an invalid rubber; NotConverged when no start
/// reaches the targets to 1e-9 or, with weights, a minimum.
ModuliFit fit_moduli(const meshes::Rubber& rubber, const ModuliFitOptions& options);

}  // namespace fingertip::calibration::inline moduli
