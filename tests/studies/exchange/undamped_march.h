/// Our own march of an undamped body, which others are compared with.
#pragma once

#include "lattice/dynamics/finger.h"
#include "studies/exchange/lammps/undamped_body.h"

namespace fingertip::studies {

/// The Finger that presses are made of, with symplectic Euler, on a rod that stands still.
class UndampedMarch {
 public:
  /// Starts at body.start. `body` must outlive it.
  explicit UndampedMarch(const UndampedBody& body);

  void advance();  ///< one step of body.step
  long steps() const { return steps_; }
  double time() const { return double(steps_) * body_->step; }  ///< [s]
  const lattice::State& state() const { return finger_.state(); }

  lattice::State now() const { return synchronised(*body_, state(), time()); }

 private:
  void push_by_wall();

  const UndampedBody* body_;
  lattice::Finger finger_;
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
