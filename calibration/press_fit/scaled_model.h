/// A forward model from an expensive solver: forces are homogeneous in the moduli, so that the
/// solver is asked at few Poisson's ratios, and once more where a search ends.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "calibration/material/material_parameter.h"
#include "calibration/statistics/forward_model.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::calibration::inline press_fit {

/// F(E, G; x) = G phi(nu; x), nu = E/(2G) - 1. An elastic body's energy is linear in (E, G) at
/// fixed nu, with whatever strain, contact and Coulomb friction that know no other stiffness, so
/// every force and stress is G times a function of nu. Then
///   dF/dE = phi'/2,   dF/dG = phi - (1 + nu) phi'.
/// ln phi is a polynomial in u = ln((1 + eps)/(1 - 2 nu + eps)), eps = 0.01845, which makes u = 4
/// of highest_ratio: nodes crowd toward nu = 1/2 as the bulk modulus grows, and no further than a
/// confined finger feels it, for phi is smooth in 1 - 2 nu there. At first the polynomial goes
/// through u = 0, 1, 2, 3 (nu = 0, 0.322, 0.440, 0.484), within a few per cent of phi, which tells
/// where to search. `refine` adds nodes, multiples of 1/2 (of a confined finger closer ones), until
/// phi is known to `tolerance` there. Of `modulus` alone, which holds nu, phi is asked at that nu
/// and nowhere else.
class ScaledModel final : public ForwardModel {
 public:
  /// F/G at each of these Poisson's ratios [curve's unit/Pa, of a press m²].
  using Solver = std::function<std::vector<Eigen::VectorXd>(const std::vector<double>&)>;
  /// `near_one_ratio`: nobody searches, four nodes about the ratio that is asked first suffice.
  enum class Use { search, near_one_ratio };
  /// Between ratios: of logarithms where all values are positive, or of the values themselves.
  enum class Interpolation { logarithmic, plain };

  /// `parameters`: youngs_modulus, shear_modulus or both; or lame_shear, lambda or both; or
  /// modulus; in the order of `evaluate`. What is not among them has its value from `held`. The
  /// solver is not asked below `lowest_ratio`. Throws InvalidInput for other parameters.
  ScaledModel(Solver solver, std::vector<MaterialParameter> parameters, const meshes::Rubber& held,
              double lowest_ratio = -0.9, Use use = Use::search,
              Interpolation interpolation = Interpolation::logarithmic);

  /// Throws InvalidInput for moduli that are not positive and for a Poisson's ratio below the
  /// lowest or above `highest_ratio`, and what the solver throws; of the first nodes those where it
  /// does not converge are left out as long as two remain.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

  /// Asks for one more node where phi is not known to `tolerance`, unless the solver does not
  /// converge there.
  bool refine(const Eigen::VectorXd& parameters) override;

  static constexpr double highest_ratio = 0.4999;
  /// Of the forces within 1/8 of u from where a search ends, so that their slopes by u are known to
  /// 8e-4: root mean square of errors over that of the forces. They are estimated as if the next
  /// divided difference of ln phi were half the last; where 1/phi is linear in 1 - 2 nu, whose pole
  /// is at a distance of pi from the real u, it is less.
  static constexpr double tolerance = 1e-4;

 private:
  struct Answer {
    Eigen::VectorXd value, slope;  ///< phi and d phi/d nu
    double error = 0.0;            ///< of phi, relative
  };
  /// Throws InvalidInput as `evaluate`.
  double ratio_of(const meshes::Rubber& rubber) const;
  bool holds_ratio() const;
  Answer at(double poissons_ratio);
  void ask_first(double poissons_ratio);
  /// Of multiples of `apart`, within two of them from `place`.
  std::optional<int> nearest_unknown(double place, int apart) const;
  void ask(const std::vector<int>& nodes);

  Solver solver_;
  std::vector<MaterialParameter> parameters_;
  meshes::Rubber held_;
  double lowest_ratio_;
  Use use_;
  Interpolation interpolation_;
  std::map<int, Eigen::VectorXd> nodes_;  ///< phi at u = node/8
  Eigen::VectorXd held_forces_;  ///< phi at the ratio of `held_`, where it is held; else empty
};

}  // namespace fingertip::calibration::inline press_fit
