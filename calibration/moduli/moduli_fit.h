/// Identification of spring constants from the rubber's moduli.
#pragma once

#include <Eigen/Core>

#include "calibration/material/moduli.h"
#include "lattice/model/constants.h"
#include "meshes/rubber/rubber.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline moduli {

/// The direction of (k1, k2, k3, kappa), of unit length, along which no modulus of any lattice
/// changes; in words, its largest component 1.
inline Eigen::Vector4d open_direction() {
  return Eigen::Vector4d(4.0, -4.0, 3.0, 0.0).normalized();
}
inline constexpr const char* open_direction_words = "k1 + 1, k2 - 1, k3 + 0.75";

struct ModuliFitOptions {
  lattice::ModelKind model = lattice::ModelKind::hookean;  ///< central or hookean
  double spacing = 0.0;                                    ///< a [m], > 0
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
  /// By their names, without weights. hookean: C11, C12, C44 minus target, over the rubber's G
  /// (C12's target is zero at nu = 0, so it cannot be its own scale). central: E_100 and G, each
  /// over its target, minus 1; with weights also E_110 and E_111 over E_100, K over its target,
  /// minus 1.
  meshes::Entries<double> residuals;
  int iterations = 0;  ///< of the search for a compromise

  /// Whether weights ask for more than central springs can reach.
  bool is_compromise() const { return isotropy_weight > 0.0 || bulk_weight > 0.0; }
};

/// k1, k2, k3 >= 0 (and kappa for hookean, of either sign: it is negative for nu < 1/4) from E and
/// G of the rubber, in closed form. Of the constants that fit equally well it returns those whose
/// weaker one of k1 and k2 is largest, the farthest from mechanisms (README); for hookean, and for
/// central with E >= 5/2 G, that means k3 = 0.
/// With weights the springs of central meet none of the targets but a compromise, the least sum of
/// squared residuals times weights, which Ceres seeks from where E_100 and G are exact.
/// Throws InvalidInput for published (it has a rule, not a fit), a non-positive spacing, a weight
/// that is negative or not finite, or an invalid rubber; NotConverged when the search for a
/// compromise ends before a minimum.
ModuliFit fit_moduli(const meshes::Rubber& rubber, const ModuliFitOptions& options);

}  // namespace fingertip::calibration::inline moduli
