/// The static lattice as a model of measured presses.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "calibration/statistics/forward_model.h"
#include "lattice/press/press_parameters.h"
#include "lattice/press/press_setup.h"

namespace fingertip::calibration::inline press_fit {

/// Value in a setup, in the parameter's unit; lame_shear and lambda are the rubber's. NaN for
/// coefficients of laws at large strain.
double value_of(MaterialParameter parameter, const lattice::PressSetup& setup);

/// The static lattice: normal forces at protocol.samples by run_static_press_with_slopes.
/// E and G become constants of hookean by k1 = k2 = aG, k3 = 0, kappa = lambda - G, whatever the
/// setup's constants were, and go to the network as they are. What is not among the parameters
/// stays as in the setup. Where moduli alone are sought, forces are proportional to them at held
/// Poisson's ratio, so that a press is done once per ratio, at the setup's own G.
class LatticeForwardModel final : public ForwardModel {
 public:
  /// Throws InvalidInput for an empty list, a parameter that the setup's model does not have, one
  /// named twice, parameters that describe the rubber in two ways at once, or a lateral motion
  /// after the press. `go_on` is asked
  /// after every step of a press.
  LatticeForwardModel(lattice::PressSetup setup, std::vector<MaterialParameter> parameters,
                      std::function<bool()> go_on = {});

  /// Throws also as run_static_press_with_slopes does, Interrupted when `go_on` says no.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;
  /// The press with these parameters.
  lattice::PressSetup setup_with(const Eigen::VectorXd& parameters) const;

 private:
  bool by_moduli() const;
  /// d(press parameters)/d(parameters), rows as in press_parameters_.
  Eigen::MatrixXd chain(const lattice::PressSetup& setup) const;
  CurveSlopes press(const lattice::PressSetup& setup) const;
  /// At this Poisson's ratio and the setup's own G.
  const CurveSlopes& at_ratio(double poissons_ratio);

  lattice::PressSetup setup_;
  std::vector<MaterialParameter> parameters_;
  std::vector<lattice::PressParameter> press_parameters_;
  std::function<bool()> go_on_;
  std::map<double, CurveSlopes> by_ratio_;  ///< answers by Poisson's ratio, where moduli are all
};

}  // namespace fingertip::calibration::inline press_fit
