/// Our own march of an undamped body, which others are compared with.
#pragma once

#include "lattice/dynamics/finger.h"
#include "studies/exchange/undamped_body.h"

namespace fingertip::studies {

/// The Finger that presses are made of, with symplectic Euler, on a rod that stands still. Its
/// velocities v belong to half a step before its positions x:
///   v_{n+1} = v_n + dt a(x_n),  x_{n+1} = x_n + dt v_{n+1}.
/// Velocity Verlet (LAMMPS) keeps w_n at the time of x_n: w_n + dt/2 a(x_n) is the velocity of the
/// drift from n to n+1, hence w_n = v_n + dt/2 a(x_n), and with this start both give the same x.
class UndampedMarch {
 public:
  /// Starts at body.start. `body` must outlive it; `threads` = 0 takes all cores.
  explicit UndampedMarch(const UndampedBody& body, int threads = 1);

  void advance();  ///< one step of body.step
  long steps() const { return steps_; }
  double time() const { return double(steps_) * body_->step; }  ///< [s]
  const lattice::State& state() const { return finger_.state(); }

  /// The state with w in place of v.
  lattice::State synchronised();

 private:
  void push_by_wall();

  const UndampedBody* body_;
  lattice::Finger finger_;
  lattice::VectorField force_;
  long steps_ = 0;
};

struct Energies {
  double kinetic = 0.0;  ///< [J]
  double elastic = 0.0;  ///< of springs, ligaments and wall [J]
};
/// Of a synchronised state at `time` [s].
Energies energies(const UndampedBody& body, const lattice::State& state, double time);

/// Force of the ligaments on the rod and of the masses on the wall [N].
struct OuterForces {
  meshes::Vector3 rod = meshes::Vector3::Zero(), wall = meshes::Vector3::Zero();
};
OuterForces outer_forces(const UndampedBody& body, const lattice::State& state, double time);

}  // namespace fingertip::studies
