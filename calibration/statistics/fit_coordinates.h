/// The unbounded or boxed coordinates in which a fit is sought.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>

#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline statistics {

/// Moduli E and G, bond, contact and times, which are positive by nature.
bool varies_by_logarithm(const FreeParameter& free);
/// `scale`, or |start|.
double size_of(const FreeParameter& free);
/// `lower`, or zero where the parameter cannot be negative.
double lower_bound(const FreeParameter& free);

/// 3G/E - 1 of a rubber that no press tells from nu = 1/2: K/G is 10^4 there.
inline constexpr double incompressible = 1e-4;

/// ln(p/size) of what is positive by nature, else p/size. Where E and G both are free and E has no
/// bounds, E's coordinate is 3G/E - 1, which knows nu alone and is bounded by the options and
/// `incompressible`: data that ask for E >= 3G, as those of
/// nearly incompressible rubbers do every other time, then meet a bound like any other instead of
/// points that every model refuses.
class FitCoordinates {
 public:
  /// Keeps a reference.
  explicit FitCoordinates(const CurveFitOptions& options);

  Eigen::VectorXd from(const Eigen::VectorXd& parameters) const;
  Eigen::VectorXd parameters(const Eigen::VectorXd& coordinates) const;
  /// d(parameters)/d(coordinates).
  Eigen::MatrixXd slopes(const Eigen::VectorXd& parameters) const;
  Eigen::VectorXd lower() const;
  Eigen::VectorXd upper() const;
  /// Places of E, whose coordinate is 3G/E - 1, and G; none where E has bounds or one is not free.
  const std::optional<std::pair<Eigen::Index, Eigen::Index>>& rubber() const { return rubber_; }

 private:
  double coordinate(std::size_t i, double p) const;

  const CurveFitOptions* options_;
  std::optional<std::pair<Eigen::Index, Eigen::Index>> rubber_;  ///< E and G
};

/// Places of E and G among the free parameters; none unless both are there.
std::optional<std::pair<Eigen::Index, Eigen::Index>> places_of_moduli(
    const CurveFitOptions& options);

}  // namespace fingertip::calibration::inline statistics
