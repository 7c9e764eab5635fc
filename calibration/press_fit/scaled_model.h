/// A forward model from an expensive solver: forces are homogeneous in the moduli, so that the
/// solver is asked at few Poisson's ratios, those the search comes near.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "calibration/statistics/forward_model.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline press_fit {

/// F(E, G; x) = G phi(nu; x), nu = E/(2G) - 1. An elastic body's energy is linear in (E, G) at
/// fixed nu, with whatever strain, contact and Coulomb friction that know no other stiffness, so
/// every force and stress is G times a function of nu. Then
///   dF/dE = phi'/2,   dF/dG = phi - (1 + nu) phi'.
/// phi is asked at nodes xi = h k of xi = -ln(1 - 2 nu), h = 1/4: they crowd toward nu = 1/2 as the
/// bulk modulus grows. Between them it is the cubic through the four nearest, whose error is
/// (9/16)/24 h^4 of d^4 phi/d xi^4: below 1e-4 of phi = e^xi, the confined layer. The four are
/// asked together. Of `modulus` alone, which holds nu, phi is asked at that nu and nowhere else.
class ScaledModel final : public ForwardModel {
 public:
  /// F/G at each of these Poisson's ratios [curve's unit/Pa, of a press m²].
  using Solver = std::function<std::vector<Eigen::VectorXd>(const std::vector<double>&)>;

  /// `parameters`: youngs_modulus, shear_modulus or both; or lame_shear, lambda or both; or
  /// modulus; in the order of `evaluate`. What is not among them has its value from `held`. The
  /// solver is not asked below `lowest_ratio`. Throws InvalidInput for other parameters.
  ScaledModel(Solver solver, std::vector<MaterialParameter> parameters, const meshes::Rubber& held,
              double lowest_ratio = -0.9);

  /// Throws InvalidInput for moduli that are not positive and for a Poisson's ratio below the
  /// lowest or above `highest_ratio`, and what the solver throws.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

  static constexpr double highest_ratio = 0.4999;

 private:
  struct ValueAndSlope {
    Eigen::VectorXd value, slope;  ///< phi and d phi/d nu
  };
  ValueAndSlope at(double poissons_ratio);
  /// Asks the solver for those of the four nodes from `first` on that are not known.
  void ask(int first);

  Solver solver_;
  std::vector<MaterialParameter> parameters_;
  meshes::Rubber held_;
  double lowest_ratio_;
  int lowest_node_;
  std::map<int, Eigen::VectorXd> nodes_;
  Eigen::VectorXd held_forces_;  ///< phi at the ratio of `held_`, where it is held; else empty
};

}  // namespace fingertip::calibration::inline press_fit
