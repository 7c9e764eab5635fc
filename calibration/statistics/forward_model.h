/// From parameters to the values of a curve and their derivatives.
#pragma once

#include <Eigen/Core>

namespace fingertip::calibration::inline statistics {

/// What a model answers at the abscissae of a curve.
struct CurveSlopes {
  Eigen::VectorXd value;     ///< in the curve's unit; of a press forces [N]
  Eigen::MatrixXd jacobian;  ///< rows are abscissae, columns parameters [value per unit]
};

/// A curve as a function of parameters, whose order the model knows. Its abscissae are fixed.
class ForwardModel {
 public:
  virtual ~ForwardModel() = default;
  /// Throws InvalidInput for parameters outside of the model's range, NotConverged where it finds
  /// no answer, Interrupted where it is told to stop. Different models may be evaluated side by
  /// side, one model is not.
  virtual CurveSlopes evaluate(const Eigen::VectorXd& parameters) = 0;
  /// A search has ended there. A model that interpolates learns what it lacks; true: its answers
  /// are others now. Not for ever: who asks goes on as long as it is. Throws as `evaluate`.
  virtual bool refine(const Eigen::VectorXd& /*parameters*/) { return false; }
};

}  // namespace fingertip::calibration::inline statistics
