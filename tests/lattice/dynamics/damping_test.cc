// What the dampers of cell models mean: Kelvin-Voigt, tan d = omega tau for every wave.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "lattice/forces/forces.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;

namespace {

constexpr double tau = 3e-4;

/// A plane wave u = polarisation cos(q·x + phase).
struct Wave {
  Vector3 along, polarisation;
  double length = 0.0;  ///< in spacings
  bool pressure = false;

  double phase(const LatticeModel& model, std::size_t i) const {
    const double q = 2.0 * std::numbers::pi / (length * model.spacing());
    return q * along.dot(model.rest_position(i)) + 0.4;
  }
};

/// Longitudinal and both transverse waves along [100], [110] and [111].
std::vector<Wave> waves() {
  std::vector<Wave> result;
  for (const double length : {6.0, 13.7, 40.0}) {
    for (const auto& [along, across] : {std::pair{Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0)},
                                        {Vector3(1.0, 1.0, 0.0), Vector3(0.0, 0.0, 1.0)},
                                        {Vector3(1.0, 1.0, 1.0), Vector3(1.0, -1.0, 0.0)}}) {
      const Vector3 n = along.normalized(), s = across.normalized();
      result.push_back({n, n, length, true});
      result.push_back({n, s, length, false});
      result.push_back({n, n.cross(s), length, false});
    }
  }
  return result;
}

std::vector<std::size_t> interior(const LatticeModel& model) {
  std::vector<std::size_t> result;
  for (const std::size_t i : model.particles) {
    bool inside = true;
    for (int s = 0; s < lattice::directions; ++s) {
      const std::size_t step = std::size_t(lattice::neighbour_offset(model.grid.size, s));
      inside = inside && model.is_particle[i + step] && model.is_particle[i - step];
    }
    if (inside) result.push_back(i);
  }
  return result;
}

struct Resistance {
  double stiffness = 0.0;  ///< -f·u over m u² of the wave as displacement [1/s²]
  double damping = 0.0;    ///< -f·v over m v² of the wave as velocity [1/s]
};

/// Of the lattice at rest, summed over the interior.
Resistance resistance(const LatticeModel& model, const Wave& wave) {
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  const double h = 1e-5 * model.spacing();
  Resistance sum;
  double mass = 0.0;
  for (const double sign : {1.0, -1.0}) {  // what is even in the amplitude drops out
    State displaced(model), moving(model);
    for (const std::size_t i : model.particles) {
      const Vector3 u = sign * std::cos(wave.phase(model, i)) * wave.polarisation;
      displaced.displacement.set(i, h * u);
      moving.velocity.set(i, u);
    }
    VectorField elastic(model.points()), viscous(model.points());
    forces.accumulate(displaced, elastic);
    forces.accumulate(moving, viscous);
    for (const std::size_t i : interior(model)) {
      const Vector3 u = displaced.displacement.at(i) / h;
      sum.stiffness -= elastic.at(i).dot(u) / h;
      sum.damping -= viscous.at(i).dot(u);
      mass += model.mass[i] * u.squaredNorm();
    }
  }
  return {sum.stiffness / mass, sum.damping / mass};
}

}  // namespace

TEST(Damping, EveryPlaneWaveLosesOmegaTau) {
  const meshes::Rubber rubber;
  for (const auto& [kind, kinematics] : {std::pair{ModelKind::hookean, Kinematics::small},
                                         {ModelKind::network, Kinematics::finite},
                                         {ModelKind::central, Kinematics::small}}) {
    const LatticeModel model = cell_block(settings_for(kind, kinematics, 10), {7, 6, 8});
    for (const Wave& wave : waves()) {
      SCOPED_TRACE(label(kind, kinematics) + ", length " + std::to_string(wave.length));
      const Resistance r = resistance(model, wave);
      const double omega = std::sqrt(r.stiffness);
      EXPECT_NEAR(omega * r.damping / r.stiffness, omega * tau, 1e-9 * omega * tau);
      if (kind == ModelKind::central) continue;
      // Long waves run at the rubber's speeds; the lattice is slower or faster by (q a)² at most.
      const double q = 2.0 * std::numbers::pi / (wave.length * model.spacing());
      const double speed =
          wave.pressure ? rubber.longitudinal_wave_speed() : rubber.shear_wave_speed();
      const double qa = q * model.spacing();
      EXPECT_NEAR(omega / (q * speed), 1.0, 0.2 * qa * qa);
    }
  }
}

TEST(Damping, StationaryWavesDecayByHalfOmegaTau) {
  // The lowest shear wave of a free bar of the network: amplitude falls like exp(-tau omega² t/2).
  // Kelvin-Voigt damping leaves the mode's shape alone.
  const LatticeModel model =
      cell_block(settings_for(ModelKind::network, Kinematics::finite, 10), {12, 2, 2});
  const Eigen::MatrixXd K = tangent(model, State(model));
  const Eigen::VectorXd root = mass_vector(model).cwiseSqrt();
  const Eigen::MatrixXd scaled = root.cwiseInverse().asDiagonal() * (0.5 * (K + K.transpose())) *
                                 root.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scaled);
  const Eigen::Index number = 6;  // after the rigid motions
  const double lambda = modes.eigenvalues()[number], omega = std::sqrt(lambda);
  ASSERT_GT(lambda, 1e3 * std::abs(modes.eigenvalues()[number - 1]));
  const Eigen::VectorXd shape = modes.eigenvectors().col(number).cwiseQuotient(root);
  State state(model);
  const double amplitude = 1e-4 * model.spacing() / shape.cwiseAbs().maxCoeff();
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    state.displacement.set(model.particles[p], amplitude * shape.segment<3>(3 * Eigen::Index(p)));
  }
  const auto share = [&](const VectorField& field) {  // of the mode, in units of `amplitude`
    double sum = 0.0;
    for (std::size_t p = 0; p < model.particles.size(); ++p) {
      const std::size_t i = model.particles[p];
      sum += model.mass[i] * field.at(i).dot(shape.segment<3>(3 * Eigen::Index(p)));
    }
    return sum / amplitude;
  };
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  VectorField force(model.points());
  const double decay = 0.5 * tau * lambda, ring = std::sqrt(lambda - decay * decay);
  const double dt = 2e-6, duration = 3.0 * 2.0 * std::numbers::pi / ring;
  const int steps = int(duration / dt);
  for (int n = 0; n < steps; ++n) {
    forces.accumulate(state, force);
    for (const std::size_t i : model.particles) {
      state.velocity.add(i, dt * model.inverse_mass[i] * force.at(i));
      state.displacement.add(i, dt * state.velocity.at(i));
    }
  }
  const double t = steps * dt;
  const double expected =
      std::exp(-decay * t) * (std::cos(ring * t) + decay / ring * std::sin(ring * t));
  EXPECT_GT(omega * tau, 0.01);
  EXPECT_LT(std::exp(-decay * t), 0.9);
  EXPECT_NEAR(share(state.displacement), expected, 5e-3);
}
