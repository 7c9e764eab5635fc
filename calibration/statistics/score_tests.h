/// What a fit that misses its data may have missed, and what a further measurement would tell it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"
#include "calibration/statistics/fit_result.h"

namespace fingertip::calibration::inline statistics {

/// Something that the model of a fit leaves out, by one number that is 0 there.
struct OmittedEffect {
  std::string name;        ///< "compliance"
  std::string of;          ///< the file or machine; empty: the one, or all of them
  std::string cause;       ///< what usually makes it, for people
  std::string unit = "1";  ///< of the number
  /// d(values)/d(number) at the estimates, for all values of all curves in order [y per unit].
  Eigen::VectorXd change;
  /// What the number can be at all: of another theory, which is 1, no more than that by far.
  double least = -std::numeric_limits<double>::infinity(),
         most = std::numeric_limits<double>::infinity();
  std::string share_of = {};  ///< what a number of unit "1" is a share of, "the force at once"
};

/// Rao's score test of every effect, the largest decrease first: with whitened residuals r and
/// changes v, both without what the fit's parameters can do (J and the priors' rows),
///   amount a = v.r/v.v within the effect's bounds,   decrease = 2 a v.r - a² v.v,
/// chi-square of one degree of freedom where sigma is given; else F of 1 and dof - 1 from
/// decrease/((dof - decrease)/(dof - 1)). Effects whose change the parameters imitate (less than
/// 1e-6 of v is left) are left out. Large amounts are beyond first order: the order still tells,
/// the amounts do not. Throws InvalidInput for changes of another length.
std::vector<ScoreTest> score_tests(const CurveFit& fit, const CurveFitOptions& options,
                                   const std::vector<OmittedEffect>& effects);

/// The same of a fit that was done again with the number free, `after`, whose last parameter it is:
/// what chi-square, or without sigma the squares over the variance of `before`, has lost indeed.
/// Where a model is far from its data, as with a touch at the wrong place, first order misleads.
/// `what` needs no change. Throws InvalidInput for fits of which only one knows sigma.
ScoreTest score_test(const CurveFit& before, const CurveFit& after, const OmittedEffect& what);

/// Derivative of a loading's forces by the weight of one branch that fades with `constant` [s],
/// where the forces without it are `forces` at `times` (increasing) [s], in proportion to the
/// rubber's moduli: ∫ (exp(-(t-s)/c) - 1) dF(s) (Lee & Radok 1960; F straight between its values,
/// and what there is at the first one as if just applied). Throws InvalidInput for lists of other
/// lengths.
Eigen::VectorXd relaxation_change(const Eigen::VectorXd& forces, const std::vector<double>& times,
                                  double constant);

/// The weight of that branch that would make the loop or the fall in a hold which the curve's
/// course tells, whichever needs more; 0 where it tells neither. The way back is taken as quick as
/// the loading.
double fading_of(const LoadingHistory& course, const Eigen::VectorXd& forces,
                 const std::vector<double>& x, const std::vector<double>& times, double constant);

/// Standard errors of the parameters after further values, over those of `covariance`: 1 where
/// they tell nothing. `rows` are the values' derivatives by the parameters over the values'
/// deviations; `own` those by parameters that the further measurement brings along, such as its
/// touch offset. To first order, from
///   C' = (C⁻¹ + Rᵀ (1 - N N⁺) R)⁻¹.
Eigen::VectorXd narrowing(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& rows,
                          const Eigen::MatrixXd& own);

}  // namespace fingertip::calibration::inline statistics
