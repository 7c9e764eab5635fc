/// Adaptive explicit Runge-Kutta steps by Boost.odeint.
#pragma once

#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// The pair of Dormand and Prince, order 5 with an estimate of order 4 (J. Comput. Appl. Math. 6,
/// 1980), by Boost.odeint (Ahnert & Mulansky, AIP Conf. Proc. 1389, 2011), for
///   u' = v,  m v' = f(u, v),  and of the rod  c' = p/M,  q' = ½ (0, w) q,  p' = F,  L' = T,
/// w = I(q)⁻¹ L, unless it is prescribed; q is kept at unit length where it is used. The ties act
/// with their plain stiffness, without the inertia and the look ahead that Euler steps need
/// (CutSurfaces::attempt), so that the solution has no step in it.
///
/// A step is accepted when its estimated error, in root mean square over all unknowns relative to
/// `tolerance` times their scales, is at most 1. Scales: of displacements a hundredth of the
/// spacing (a strain of 1 %), of velocities that times the rubber's highest frequency, of the rod
/// what moves its endpoint alike; the rod counts as much as all particles. The plane's and the
/// bond's impulses are integrated along with them, so momentum balances to round-off.
///
/// Contact remembers where steps ended, nothing of stages and rejected steps. A first touch, a
/// release or the onset of slip bends the forces, which costs the step it happens in its order: the
/// error estimate sees that and takes smaller steps there.
class RungeKutta : public Stepper {
 public:
  /// tolerance in (0, 1); `largest` step [s]. The finger must have surfaces that can be tried;
  /// finger and controller must outlive it.
  RungeKutta(Finger& finger, const StepController& steps, double tolerance,
             std::optional<double> largest);
  ~RungeKutta() override;

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;
  void end() override;
  std::string explanation() const override;

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
  Finger* finger_;
  double tolerance_;
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
