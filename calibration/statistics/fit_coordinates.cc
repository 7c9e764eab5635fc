#include "calibration/statistics/fit_coordinates.h"

#include <algorithm>
#include <cmath>

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

bool has_bounds(const FreeParameter& free) {
  return free.lower > 0.0 || std::isfinite(free.upper);
}

/// 3G/E - 1 at a Poisson's ratio.
double compressibility(double poissons_ratio) {
  return 1.5 / (1.0 + poissons_ratio) - 1.0;
}

}  // namespace

bool varies_by_logarithm(const FreeParameter& free) {
  return kind(free.parameter).sign == Sign::positive;
}

double size_of(const FreeParameter& free) {
  return free.scale > 0.0 ? free.scale : std::abs(free.start);
}

double lower_bound(const FreeParameter& free) {
  return kind(free.parameter).sign == Sign::any ? free.lower : std::max(0.0, free.lower);
}

std::optional<std::pair<Index, Index>> places_of_moduli(const CurveFitOptions& options) {
  const auto place = [&](MaterialParameter parameter) {
    return std::ranges::find(options.free, parameter, &FreeParameter::parameter) -
           options.free.begin();
  };
  const Index e = place(MaterialParameter::youngs_modulus);
  const Index g = place(MaterialParameter::shear_modulus);
  if (std::max(e, g) == Index(options.free.size())) return std::nullopt;
  return std::pair{e, g};
}

FitCoordinates::FitCoordinates(const CurveFitOptions& options)
    : options_(&options), rubber_(places_of_moduli(options)) {
  if (rubber_ && has_bounds(options.free[std::size_t(rubber_->first)])) rubber_.reset();
}

double FitCoordinates::coordinate(std::size_t i, double p) const {
  const FreeParameter& free = options_->free[i];
  return varies_by_logarithm(free) ? std::log(p / size_of(free)) : p / size_of(free);
}

VectorXd FitCoordinates::from(const VectorXd& parameters) const {
  VectorXd x(parameters.size());
  for (Index i = 0; i < x.size(); ++i) x(i) = coordinate(std::size_t(i), parameters(i));
  if (rubber_) {
    const auto [e, g] = *rubber_;
    x(e) = std::clamp(3.0 * parameters(g) / parameters(e) - 1.0, lower()(e), upper()(e));
  }
  return x;
}

VectorXd FitCoordinates::parameters(const VectorXd& x) const {
  VectorXd p(x.size());
  for (Index i = 0; i < x.size(); ++i) {
    const FreeParameter& free = options_->free[std::size_t(i)];
    p(i) = size_of(free) * (varies_by_logarithm(free) ? std::exp(x(i)) : x(i));
  }
  if (rubber_) {
    const auto [e, g] = *rubber_;
    p(e) = 3.0 * p(g) / (1.0 + x(e));
  }
  return p;
}

Eigen::MatrixXd FitCoordinates::slopes(const VectorXd& p) const {
  Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(p.size(), p.size());
  for (Index i = 0; i < p.size(); ++i) {
    const FreeParameter& free = options_->free[std::size_t(i)];
    slopes(i, i) = varies_by_logarithm(free) ? p(i) : size_of(free);
  }
  if (rubber_) {
    const auto [e, g] = *rubber_;
    slopes(e, e) = -p(e) * p(e) / (3.0 * p(g));
    slopes(e, g) = p(e);
  }
  return slopes;
}

VectorXd FitCoordinates::lower() const {
  VectorXd lower(Index(options_->free.size()));
  for (std::size_t i = 0; i < options_->free.size(); ++i)
    lower(Index(i)) = coordinate(i, lower_bound(options_->free[i]));
  if (rubber_)
    lower(rubber_->first) =
        std::max(incompressible, compressibility(options_->highest_poissons_ratio));
  return lower;
}

VectorXd FitCoordinates::upper() const {
  VectorXd upper(Index(options_->free.size()));
  for (std::size_t i = 0; i < options_->free.size(); ++i)
    upper(Index(i)) = coordinate(i, options_->free[i].upper);
  if (rubber_) upper(rubber_->first) = compressibility(options_->lowest_poissons_ratio);
  return upper;
}

}  // namespace fingertip::calibration::inline statistics
