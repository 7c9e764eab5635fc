/// A lattice without dampers that stands or flies alone: what other programs can march, too.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "studies/config/loader.h"

namespace fingertip::studies::inline exchange::inline lammps {

/// A plane that pushes every mass behind it with -k gap along its normal; no friction.
struct SoftWall {
  lattice::Plane plane;    ///< at time 0; `velocity` holds on
  double stiffness = 0.0;  ///< k per mass [N/m]

  /// On a mass at `place` at `time` [s]: [N], zero in front of the wall.
  meshes::Vector3 force(const meshes::Vector3& place, double time) const;
  double energy(const meshes::Vector3& place, double time) const;  ///< ½ k gap² behind it [J]

 private:
  double gap(const meshes::Vector3& place, double time) const;
};

/// What is marched: m a = springs + ligaments to the rod at rest + wall + m g.
struct UndampedBody {
  lattice::LatticeModel model;  ///< no dampers, no bond or penalty contact of surfaces
  lattice::RodBody rod;         ///< at rest for ever; of use only to ligaments
  std::optional<SoftWall> wall;
  meshes::Vector3 gravity = meshes::Vector3::Zero();  ///< [m/s²]
  /// Positions at time 0 and velocities half a step earlier, as symplectic Euler has them.
  lattice::State start;
  double step = 0.0;  ///< [s]
};

/// The lattice that [exchange] of `loaded` asks for, with everything else from the other sections.
/// The step is run.time_step or 0.8 of the largest stable one. Throws ConfigError where a wall
/// cannot be as the press asks.
UndampedBody undamped_body(const LoadedConfig& loaded);

/// Random displacements and velocities, components uniform in ±agitation a and ±agitation a
/// sqrt(k1/m); the same on every machine and for any number of threads.
lattice::State agitated(const lattice::LatticeModel& model, double agitation);

/// The state at `time` [s] with velocities w of its time in place of v, half a step earlier:
/// w = v + dt/2 a(x). Velocity Verlet from there goes through the same places as symplectic Euler:
///   v_{n+1} = v_n + dt a(x_n),            x_{n+1} = x_n + dt v_{n+1};
///   w_{n+1/2} = w_n + dt/2 a(x_n) = v_{n+1},  x_{n+1} = x_n + dt w_{n+1/2}.
lattice::State synchronised(const UndampedBody& body, lattice::State state, double time);

/// Adds ligaments, wall and weight at `time` [s] to the forces of the springs, `internal` [N].
void add_outer_forces(const UndampedBody& body, const lattice::State& state, double time,
                      lattice::VectorField& internal);

}  // namespace fingertip::studies::inline exchange::inline lammps
