/// A forward model from few runs of an expensive solver: forces are homogeneous in the moduli, so
/// that of E and G only Poisson's ratio needs a table.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/curves/forward_model.h"
#include "meshes/rubber.h"

namespace fingertip::calibration {

/// `count` Chebyshev points of the second kind, increasing, the first and the last at the ends of
/// the interval: (lower + upper)/2 - (upper - lower)/2 cos(pi k/(count - 1)). Throws InvalidInput
/// unless lower < upper and count >= 2.
std::vector<double> chebyshev_nodes(double lower, double upper, int count);

/// F(E, G; x) = G phi(nu; x), nu = E/(2G) - 1. An elastic body's energy is linear in (E, G) at
/// fixed nu, with whatever strain, contact and Coulomb friction that know no other stiffness, so
/// every force and stress is G times a function of nu. phi is the polynomial through the nodes
/// (Trefethen, Approximation Theory and Approximation Practice, ch. 5 and 8: at Chebyshev points
/// the error falls exponentially with their number where phi is analytic; where contact puts kinks
/// into phi, algebraically). Then
///   dF/dE = phi'/2,   dF/dG = phi - (1 + nu) phi'.
class ScaledTable final : public ForwardModel {
 public:
  /// `poissons_ratios`: at least three distinct ones in (-1, 1/2), in any order; those of
  /// `chebyshev_nodes` are best. `scaled`: F/G at them [curve's unit/Pa, of a press m²], rows
  /// abscissae, columns Poisson's ratios. `parameters`: youngs_modulus, shear_modulus or both, in
  /// the order of `evaluate`, or modulus alone; one that is not among them has its value from
  /// `held`. Throws InvalidInput for anything else.
  ScaledTable(const std::vector<double>& poissons_ratios, const Eigen::MatrixXd& scaled,
              std::vector<MaterialParameter> parameters, const meshes::Rubber& held);

  /// Throws InvalidInput for moduli that are not positive and for a Poisson's ratio outside of
  /// [lower, upper].
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

  /// The table's range of Poisson's ratio.
  double lower() const { return lower_; }
  double upper() const { return upper_; }

  /// Estimate of the largest |interpolated/exact - 1| in the table's range, per abscissa: what the
  /// polynomial through every other node (and the last one) misses at the nodes left out. As the
  /// error of a table with half the nodes it is pessimistic where phi is smooth, and about twice
  /// the error where kinks limit it.
  const Eigen::VectorXd& interpolation_error() const { return interpolation_error_; }

 private:
  struct ValueAndSlope {
    Eigen::VectorXd value, slope;  ///< phi and d phi/d nu
  };
  /// Coefficients of Chebyshev polynomials on [lower, upper] (columns: by degree), a row per
  /// abscissa, from the columns of `scaled` at `nodes`.
  Eigen::MatrixXd through(const std::vector<double>& nodes, const Eigen::MatrixXd& scaled) const;
  ValueAndSlope at(const Eigen::MatrixXd& coefficients, double poissons_ratio) const;
  /// Nodes increasing.
  Eigen::VectorXd error_of_half(const std::vector<double>& nodes,
                                const Eigen::MatrixXd& scaled) const;
  /// `poissons_ratio` without its round-off beyond the ends.
  double inside(double poissons_ratio) const;

  std::vector<MaterialParameter> parameters_;
  meshes::Rubber held_;
  double lower_ = 0.0, upper_ = 0.0;
  Eigen::MatrixXd coefficients_;
  Eigen::VectorXd interpolation_error_;
};

}  // namespace fingertip::calibration
