/// Derivatives of a path of equilibria with respect to material parameters.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "lattice/press/press_parameters.h"
#include "lattice/statics/elastic_system.h"
#include "lattice/statics/equilibrium.h"
#include "lattice/statics/static_contact.h"

namespace fingertip::lattice::inline press {

/// Of a press's forces on the rod, whole tip: rows are samples, columns directions (parameters). N
/// per unit of way.
struct PressSlopes {
  Eigen::MatrixXd normal_force, lateral_force_x, lateral_force_y;
};

/// Force that may be left unbalanced on a path that is differentiated, as `force_tolerance`: also
/// where a search decides what sticks, for its state makes the anchors.
inline constexpr double slope_tolerance = 1e-12;

/// What goes with a state of the press; a column per direction p.
struct StateSlopes {
  Eigen::MatrixXd displacement;  ///< du/dp, a row per unknown [m per unit]
  /// Of the anchors relative to the plane, three rows per outer point [m per unit]; those of points
  /// that are not anchored mean nothing.
  Eigen::MatrixXd anchors;
};

/// Carries derivatives along a path of equilibria, by forward differentiation of
/// f(u, p, anchors) = 0: K du/dp = df/dp + Σ df/danchor danchor/dp, with K the tangent in contact
/// (README). Which points touch, slide or are released in which step is held, so derivatives are
/// those of the piece of F(p) between two such events.
class SlopeSystem {
 public:
  /// Keeps a reference to `body`. Throws InvalidInput as body_slope does.
  SlopeSystem(const PressSetup& setup, const LatticeBody& body, const PressDirections& directions);

  /// Slopes of the state of rest: zero.
  StateSlopes at_rest() const;
  /// Sets slopes.displacement, whose entries serve as a first guess, to those of the equilibrium
  /// `displacement`, where `touches`, not yet anchored, have gone since `start`. Throws
  /// NotConverged where the tangent is not positive definite.
  void respond(EquilibriumSolver& solver, const StaticContact& contact,
               const Eigen::VectorXd& displacement, const std::vector<FirstTouch>& touches,
               const StateSlopes& start, StateSlopes& slopes) const;
  /// Sets in `end` the slopes of the anchors of points that touch first on the way from `start` to
  /// there.
  void anchor(const std::vector<FirstTouch>& touches, const StateSlopes& start,
              StateSlopes& end) const;
  /// Of the force on the rod, whole tip; a column per direction [N per unit].
  Eigen::Matrix3Xd force(const Eigen::VectorXd& displacement, const StateSlopes& slopes) const;

 private:
  /// A body of derivatives and what it exerts.
  struct Part {
    explicit Part(LatticeBody slope) : body(std::move(slope)), system(body) {}
    const LatticeBody body;
    const ElasticSystem system;
  };

  Eigen::MatrixXd forces(const StaticContact& contact, const Eigen::VectorXd& displacement,
                         const StateSlopes& slopes) const;
  /// Adds what their ties push by the slopes of where they come from and of how much they hold.
  void add_touching(const std::vector<FirstTouch>& touches, const StateSlopes& start,
                    const StateSlopes& end, Eigen::MatrixXd& forces) const;

  const LatticeBody* body_;
  std::vector<std::unique_ptr<const Part>> parts_;  ///< per direction
};

}  // namespace fingertip::lattice::inline press
