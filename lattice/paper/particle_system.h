/// The paper on one page: D. Reznik and C. Laugier, Dynamic simulation and virtual control of a
/// deformable fingertip, ICRA 1996, sections II.A to II.E, procedures and symbols as printed.
///
/// To be read. `lattice.model = published` with `run.integrator = explicit-euler` is this on
/// arrays, eight particles at once; a test holds it to this page, step by step.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::lattice::paper {

using meshes::Vector3;

struct Particle {
  double m = 0.0;               ///< mass [kg]
  Vector3 x = Vector3::Zero();  ///< position [m]
  Vector3 v = Vector3::Zero();  ///< velocity [m/s]
  Vector3 f = Vector3::Zero();  ///< sum of the spring forces [N]
};

/// Between the particles i and j.
struct Spring {
  std::size_t i = 0, j = 0;
  double k = 0.0;   ///< elastic constant [N/m]
  double mu = 0.0;  ///< damping factor [N s/m]
  double l0 = 0.0;  ///< rest length [m]
};

struct ParticleSystem {
  std::vector<Particle> P;
  std::vector<Spring> S;
};

/// Equation (1): u_i, the force of spring `s` on particle i [N]; j feels u_j = -u_i.
Vector3 SpringForce(const ParticleSystem& system, const Spring& s);

// Figure 4.

void AccumulateForces(ParticleSystem& system);

/// With the integration step dt [s]: equations (2) to (4).
void EulerStep(ParticleSystem& system, double dt);

void AnimationLoop(ParticleSystem& system, double dt, int steps,
                   const std::function<void(const ParticleSystem&)>& DisplayParticleSystem);

/// Sections II.C to II.E: the tip of a dome (R, r, L) at rest, sampled at the spacing A [m], each
/// particle joined to its 26 closest neighbours. E [Pa], rho [kg/m³].
///
/// Read as misprints: the grid's first two coordinates, A i - R/2 with i >= 0, which hold little
/// more than half of the tip (here A i, i of both signs); k = E/l0, which has not the unit of a
/// constant of springs (here E A²/l0, a spring for each face A² of the lattice's cells).
ParticleSystem SampleTip(const meshes::Geometry& tip, double E, double rho, double A);

}  // namespace fingertip::lattice::paper
