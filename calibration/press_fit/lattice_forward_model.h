/// The static lattice as a model of measured presses.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <utility>
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
/// stays as in the setup. Every answer is a press (ScaledModel asks few where moduli alone are
/// sought).
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

  lattice::PressSetup setup_;
  std::vector<MaterialParameter> parameters_;
  std::vector<lattice::PressParameter> press_parameters_;
  std::function<bool()> go_on_;
};

/// F/G of the static lattice by Poisson's ratio, its one parameter, at the setup's own G: what
/// ScaledModel asks, which needs no slopes; the Jacobian has no column.
class LatticeByRatio final : public ForwardModel {
 public:
  /// `go_on` as above.
  explicit LatticeByRatio(lattice::PressSetup setup, std::function<bool()> go_on = {})
      : setup_(std::move(setup)), go_on_(std::move(go_on)) {}

  /// Throws as LatticeForwardModel does.
  CurveSlopes evaluate(const Eigen::VectorXd& poissons_ratio) override;

 private:
  lattice::PressSetup setup_;
  std::function<bool()> go_on_;
};

}  // namespace fingertip::calibration::inline press_fit
