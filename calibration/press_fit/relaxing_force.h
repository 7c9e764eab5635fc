/// The force of a press whose rubber relaxes, from that of the same press after long times.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "meshes/rubber/relaxation.h"

namespace fingertip::calibration::inline press_fit {

/// A number of a fit's model: a fixed value [the parameter's unit], or where it stands among the
/// parameters of the fit.
struct FitQuantity {
  double value = 0.0;
  std::optional<Eigen::Index> place = std::nullopt;

  double in(const Eigen::VectorXd& parameters) const { return place ? parameters(*place) : value; }
};

/// Share g and time tau [s] of a branch (meshes/rubber/relaxation.h).
struct FitBranch {
  FitQuantity share, time;
};

/// At these parameters. Throws NotConverged for shares that sum to 1 or more.
meshes::Relaxation relaxation_in(const std::vector<FitBranch>& branches,
                                 const Eigen::VectorXd& parameters);

/// With the values at `parameters`, nothing sought.
std::vector<FitBranch> held_at(const std::vector<FitBranch>& branches,
                               const Eigen::VectorXd& parameters);

/// Lee & Radok's integral F(t) = ∫ G(t - u)/G_inf ds(u), s the force after long times, step by step
/// from rest, with derivatives by a fit's parameters. It holds while no part of the contact is lost
/// and all moduli fade alike: every increment du of the elastic press is one of displacements,
/// which are prescribed where the rubber touches, and of tractions, which vanish elsewhere; so is
/// the integral of G/G_inf over them. That asks for neither a half-space nor the absence of
/// friction; a stuck point stays where it is in both.
class RelaxingForce {
 public:
  /// Of `branches` (kept as a reference), which may be none: then F = s.
  RelaxingForce(const std::vector<FitBranch>& branches, const Eigen::VectorXd& parameters);

  bool empty() const { return own_.empty(); }
  /// Back to rest: nothing touches.
  void reset();

  /// Over the next step, `duration` >= 0 [s], F = end s_end + middle s_middle + rest.
  struct Step {
    double duration = 0.0, end = 1.0, middle = 0.0, rest = 0.0;
  };
  Step step(double duration) const;

  /// A force after long times and its derivatives by all parameters.
  struct Value {
    double force = 0.0;
    Eigen::RowVectorXd slopes;
  };
  /// dF at the end of a step; `duration_slopes`: d(duration).
  Eigen::RowVectorXd slopes(const Step& step, const Value& middle, const Value& end,
                            const Eigen::RowVectorXd& duration_slopes) const;
  /// Goes to the end of a step.
  void go_on(const Step& step, const Value& middle, const Value& end,
             const Eigen::RowVectorXd& duration_slopes);

 private:
  struct Branch {
    double excess = 0.0, time = 1.0;  ///< b, tau
    Eigen::RowVectorXd excess_slopes;
    std::optional<Eigen::Index> time_place;
    Value held;  ///< h
  };
  Value after(const Branch& branch, const Step& step, const Value& middle, const Value& end,
              const Eigen::RowVectorXd& duration_slopes) const;

  Eigen::Index parameters_;
  std::vector<Branch> own_;
  Value now_;  ///< s
};

}  // namespace fingertip::calibration::inline press_fit
