/// Whether residuals look like noise.
#pragma once

#include <Eigen/Core>
#include <string>

namespace fingertip::calibration::inline statistics {

struct ResidualStructure {
  int runs = 0;  ///< stretches of one sign; residuals of exactly zero do not count
  /// Of so few runs or fewer, were the signs in random order: the exact distribution of Wald and
  /// Wolfowitz (1940) given how many are positive and negative. Where all have one sign, which says
  /// nothing of order: 2^(1-n), as for signs that are drawn independently. 1 for less than two.
  double probability = 1.0;
  std::string statement;
};

/// Of one curve, in the order of its abscissae. A fit of p parameters makes about p changes of sign
/// by itself, so on few points per parameter the test sees less than it could.
ResidualStructure residual_structure(const Eigen::VectorXd& residuals);

}  // namespace fingertip::calibration::inline statistics
