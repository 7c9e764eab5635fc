/// Tests that tell a rubber's retardation time tau, the one free parameter [s] of every model here.
/// The rubber is Kelvin's and Voigt's, stress = C:(strain + tau d strain/dt): what it loses grows
/// with the rate alone, and its force at rest is the elastic one. Every model throws InvalidInput
/// for tau that is negative or not finite.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "calibration/statistics/forward_model.h"
#include "lattice/press/press_setup.h"
#include "meshes/press/press_response.h"

namespace fingertip::calibration::inline press_fit {

/// Loss factor tan d = 2 pi f tau of every harmonic deformation at the frequencies f [Hz]: stress
/// runs ahead of strain by d. Data whose loss factor does not grow like f are not of this rubber.
class LossFactorModel final : public ForwardModel {
 public:
  /// `frequencies` [Hz], finite and positive. Throws InvalidInput otherwise.
  explicit LossFactorModel(const std::vector<double>& frequencies);
  CurveSlopes evaluate(const Eigen::VectorXd& retardation_time) override;

 private:
  Eigen::VectorXd frequencies_;
};

/// Strain over its final value at times [s] after a stress that is put on at once and held:
/// 1 - exp(-t/tau), for every shape and load as long as inertia does not matter.
class CreepModel final : public ForwardModel {
 public:
  /// `times` [s], finite and positive. Throws InvalidInput otherwise.
  explicit CreepModel(const std::vector<double>& times);
  CurveSlopes evaluate(const Eigen::VectorXd& retardation_time) override;

 private:
  Eigen::VectorXd times_;
};

/// A static press as a function of the indentation [m].
struct ForceAndStiffness {
  double force = 0.0;      ///< F [N]
  double stiffness = 0.0;  ///< dF/d indentation [N/m]
};
using StaticForce = std::function<ForceAndStiffness(double indentation)>;

/// Piecewise cubic through the samples and the origin, with the slopes of parabolas through three
/// neighbours; at the origin the slope is zero, as a round tip's is. The stiffness errs by the
/// square of the distance of samples, so give them densely. Beyond the last sample the function
/// throws InvalidInput. Throws InvalidInput for fewer than three samples, indentations that are not
/// positive and increasing, and forces that are not finite.
StaticForce interpolated_force(const meshes::PressResponse& response);

/// The plane advances from first touch (time 0) at constant speed, then stands.
struct Ramp {
  double speed = 0.0;     ///< [m/s], > 0
  double duration = 0.0;  ///< [s], > 0
};

/// Force [N] of a press that ramps and holds, at times [s] after first touch: F_s(delta) + tau
/// speed dF_s/d delta during the ramp (its end included), F_s after it.
///
/// Why: at small strain let u_s(t) be the elastic solution for the plane at delta(t). With the same
/// u the viscous stress is tau d/dt of an elastic one, so it is in equilibrium, too, and free of
/// traction where u_s is. On the contact u_s fulfils the plane's conditions on displacements, which
/// know no stress; its traction becomes p_s + tau dp_s/dt. That is admissible where it pushes, and
/// zero where nothing touched: so as long as contact only grows and p_s, dp_s/dt >= 0, frictionless
/// or sticking, u_s stays the solution, and the force is F_s + tau dF_s/dt. When the plane stops,
/// the second part vanishes at once, for u_s keeps its value.
///
/// Not so when the plane retreats (dp_s/dt < 0 without bound at the edge: the rubber lags, contact
/// ends early), with sliding friction, at finite strain (the damping of lattice and continuum there
/// is not tau times the tangent), and where inertia matters: default tip to 0.1 cm, tau = 0.3 ms,
/// the moving lattice bears 0.1 % less than this at 1 cm/s, but 3 % less at 5 cm/s.
///
/// A rubber of this kind does not relax: after the jump of tau speed dF_s/d delta at the ramp's end
/// its force is constant. Data that go on falling during the hold need at least a spring in series
/// with the damper (standard linear solid); tau of them means nothing but the ramp's surplus.
class RampModel final : public ForwardModel {
 public:
  /// `times` [s], finite and positive. Throws InvalidInput otherwise, and as `force` does at the
  /// indentations that the ramp reaches.
  RampModel(const std::vector<double>& times, const Ramp& ramp, const StaticForce& force);
  CurveSlopes evaluate(const Eigen::VectorXd& retardation_time) override;

 private:
  Eigen::VectorXd elastic_, viscous_;  ///< [N], [N/s]
};

/// Forces [N] of the moving lattice, with inertia and damping, whose rod is driven at constant
/// speed (DriveMode::quasi_static), as a transient continuum press drives it.
///
/// The drive starts smoothly within the clearance, which yet shakes the tip; the continuum starts
/// at rest in the rod's frame. A clearance of 0.1 s times the speed lets the vibrations die: then
/// force over static force is the continuum's within 1 % (R/8, up to 20 cm/s). With 0.5 mm that is
/// so up to 1 cm/s; at 5 cm/s the vibrations would be 10 % of the force at 1 mm.
///
/// One evaluation runs three presses: dF/dtau is a central difference over a relative step, whose
/// error is of second order. F jumps by about 1e-5 of itself where a point touches at another step
/// of time, so a narrower difference is no better: at the default step (R/6, 5 cm/s) both errors
/// stay below half a per cent of the slope. Below a tau of `smallest_time` the step no longer
/// shrinks, and at tau = 0 the difference is one-sided. Half the time step changes F by 0.3 % at
/// 0.5 mm and 0.04 % at 1 mm (R/8), so all evaluations up to the tau of the setup's rubber take the
/// time step of that one: give there the largest that is expected.
class MovingPressModel final : public ForwardModel {
 public:
  static constexpr double default_step = 0.05;
  static constexpr double smallest_time = 1e-5;  ///< [s]

  /// `indentations` [m], positive and increasing, replace the setup's depth and samples; lateral
  /// motion shrinks with the depth. `relative_step` of tau, above 0, at most 0.5. Throws
  /// InvalidInput otherwise, for the published model, whose dampers have a rule of their own, and
  /// for a setup that breaks a rule.
  MovingPressModel(lattice::PressSetup setup, const std::vector<double>& indentations,
                   double relative_step = default_step);

  /// Throws also NotConverged as run_press does.
  CurveSlopes evaluate(const Eigen::VectorXd& retardation_time) override;

 private:
  lattice::PressSetup setup_;
  double relative_step_;
};

}  // namespace fingertip::calibration::inline press_fit
