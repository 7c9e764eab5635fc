#include "lattice/paper/particle_system.h"

#include <array>
#include <cmath>
#include <map>

namespace fingertip::lattice::paper {

Vector3 SpringForce(const ParticleSystem& system, const Spring& s) {
  const Particle &p_i = system.P[s.i], &p_j = system.P[s.j];
  const Vector3 d = p_j.x - p_i.x, direction = d.normalized();
  const double rate = (p_j.v - p_i.v).dot(direction);  // of the spring's length
  return (s.k * (d.norm() - s.l0) + s.mu * rate) * direction;
}

void AccumulateForces(ParticleSystem& system) {
  for (Particle& p : system.P) p.f.setZero();
  for (const Spring& s : system.S) {
    const Vector3 u_i = SpringForce(system, s), u_j = -u_i;
    system.P[s.i].f += u_i;
    system.P[s.j].f += u_j;
  }
}

void EulerStep(ParticleSystem& system, double dt) {
  for (auto& [m, x, v, f] : system.P) {
    x += v * dt;
    v += f / m * dt;
  }
}

void AnimationLoop(ParticleSystem& system, double dt, int steps,
                   const std::function<void(const ParticleSystem&)>& DisplayParticleSystem) {
  for (int step = 0; step < steps; ++step) {
    AccumulateForces(system);
    EulerStep(system, dt);
    DisplayParticleSystem(system);
  }
}

namespace {

/// The set P of section II.C; what lies on a surface belongs to the tip.
bool holds(const meshes::Geometry& tip, const Vector3& w) {
  const double R = tip.tip_radius, r = tip.rod_radius, L = tip.sleeve_length;
  const double tiny = 1e-9 * R;
  const double distance = w.z() >= 0.0 ? w.norm() : std::hypot(w.x(), w.y());
  return r + tiny < distance && distance <= R + tiny && w.z() >= -L - tiny;
}

}  // namespace

ParticleSystem SampleTip(const meshes::Geometry& tip, double E, double rho, double A) {
  ParticleSystem system;
  std::map<std::array<int, 3>, std::size_t> number;
  const int wide = int(tip.tip_radius / A) + 1,
            high = int((tip.tip_radius + tip.sleeve_length) / A) + 1;
  for (int k = 0; k <= high; ++k)
    for (int j = -wide; j <= wide; ++j)
      for (int i = -wide; i <= wide; ++i) {
        const Vector3 w(A * i, A * j, A * k - tip.sleeve_length);
        if (!holds(tip, w)) continue;
        number[{i, j, k}] = system.P.size();
        system.P.push_back({.x = w});
      }

  const double V = tip.tip_volume(), m = rho * V / double(system.P.size());
  for (Particle& p : system.P) p.m = m;

  for (const auto& [place, i] : number)
    for (int neighbour = 0; neighbour < 27; ++neighbour) {
      const auto other =
          number.find({place[0] + neighbour % 3 - 1, place[1] + neighbour / 3 % 3 - 1,
                       place[2] + neighbour / 9 - 1});
      if (other == number.end() || other->second <= i) continue;  // each spring once
      const std::size_t j = other->second;
      const double l0 = (system.P[j].x - system.P[i].x).norm(), k = E * A * A / l0;
      const double equivalent_mass = m / 2;
      system.S.push_back({i, j, k, 2.0 * std::sqrt(equivalent_mass * k), l0});
    }
  return system;
}

}  // namespace fingertip::lattice::paper
