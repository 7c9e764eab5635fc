#include "lattice/paper/particle_system.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "lattice/dynamics/finger.h"
#include "lattice/dynamics/time_step.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::paper::Particle;
using lattice::paper::ParticleSystem;
using lattice::paper::Spring;
using meshes::Vector3;

namespace {

constexpr int per_radius = 5;

LatticeModel published_tip() {
  return fixtures::tip(ModelKind::published, Kinematics::finite, per_radius);
}

ParticleSystem paper_tip() {
  const meshes::Geometry tip;
  const meshes::Rubber rubber;
  return lattice::paper::SampleTip(tip, rubber.youngs_modulus, rubber.density,
                                   tip.tip_radius / per_radius);
}

/// Places in units of the spacing, which identify particles.
std::array<long, 3> place_of(const Vector3& x) {
  const double A = meshes::Geometry().tip_radius / per_radius;
  // Halves: the sleeve is no multiple of the spacing from the origin.
  return {std::lround(2 * x.x() / A), std::lround(2 * x.y() / A), std::lround(2 * x.z() / A)};
}

}  // namespace

TEST(PaperPage, SpringsPullTheirEndsTogetherAndDampTheirRate) {
  ParticleSystem pair;
  pair.P = {{.m = 1.0}, {.m = 2.0, .x = {0.0, 3.0, 4.0}, .v = {0.0, 0.0, 1.0}}};
  pair.S = {{0, 1, 10.0, 0.5, 2.0}};
  lattice::paper::AccumulateForces(pair);
  // ||d|| = 5, rate 4/5: u_i = (10 (5 - 2) + 0.5 4/5) (0, 3, 4)/5.
  EXPECT_LT((pair.P[0].f - 30.4 * Vector3(0.0, 0.6, 0.8)).norm(), 1e-14);
  EXPECT_EQ(pair.P[1].f, -pair.P[0].f);
  lattice::paper::EulerStep(pair, 0.1);
  EXPECT_EQ(pair.P[0].x, Vector3::Zero());  // with the old velocity
  EXPECT_LT((pair.P[0].v - 0.1 * pair.P[0].f).norm(), 1e-15);
  EXPECT_LT((pair.P[1].x - Vector3(0.0, 3.0, 4.1)).norm(), 1e-15);
}

TEST(PaperPage, ShowsTheSystemAfterEveryStep) {
  ParticleSystem one;
  one.P = {{.m = 1.0, .v = {2.0, 0.0, 0.0}}};
  std::vector<double> shown;
  lattice::paper::AnimationLoop(
      one, 0.5, 3, [&](const ParticleSystem& system) { shown.push_back(system.P[0].x.x()); });
  EXPECT_EQ(shown, (std::vector<double>{1.0, 2.0, 3.0}));
}

TEST(PaperPage, SamplesTheTipOfThePublishedModel) {
  const ParticleSystem paper = paper_tip();
  const LatticeModel model = published_tip();
  const ParticleSystem published = reference::particle_system(model, lattice::State(model));
  ASSERT_EQ(paper.P.size(), published.P.size());
  ASSERT_EQ(paper.S.size(), published.S.size());
  std::map<std::array<long, 3>, const Particle*> particles;
  for (const Particle& p : published.P) particles[place_of(p.x)] = &p;
  for (const Particle& p : paper.P) {
    const Particle& same = *particles.at(place_of(p.x));
    EXPECT_LT((p.x - same.x).norm(), 1e-15);
    EXPECT_NEAR(p.m / same.m, 1.0, 1e-12);
  }
  std::map<std::array<long, 3>, const Spring*> springs;  // by twice their middle, and see below
  const auto middle = [](const ParticleSystem& system, const Spring& s) {
    return place_of(system.P[s.i].x + system.P[s.j].x);
  };
  // The four body diagonals of a cube, and the two of a face, have one middle and one stiffness.
  for (const Spring& s : published.S) springs[middle(published, s)] = &s;
  for (const Spring& s : paper.S) {
    const Spring& same = *springs.at(middle(paper, s));
    EXPECT_NEAR(s.k / same.k, 1.0, 1e-12);
    EXPECT_NEAR(s.mu / same.mu, 1.0, 1e-12);
    EXPECT_NEAR(s.l0 / same.l0, 1.0, 1e-12);
  }
}

/// Without the rod's ligaments and the plane, which are not on the page.
TEST(PaperPage, ThePublishedModelStepsAsPrinted) {
  LatticeModel model = published_tip();
  model.ligaments.clear();
  const lattice::RodBody rod = lattice::rod_body({}, {});
  const double dt = 0.2 * lattice::largest_stable_step(lattice::tightest_bounds(model, &rod),
                                                       lattice::Integrator::explicit_euler);
  lattice::Finger finger(model, rod, {Vector3(0, 0, 1.0), -Vector3::UnitZ()},
                         meshes::ContactMode::stick, lattice::Integrator::explicit_euler, dt, 1);
  finger.state() = fixtures::random_state(model, 0.02, 0.05, 9);
  ParticleSystem paper = reference::particle_system(model, finger.state());
  int steps = 0;
  lattice::paper::AnimationLoop(paper, dt, 200, [&](const ParticleSystem& system) {
    ++steps;
    finger.advance(lattice::Wrench{});
    const ParticleSystem published = reference::particle_system(model, finger.state());
    double farthest = 0.0, fastest = 0.0, x_error = 0.0, v_error = 0.0;
    for (std::size_t p = 0; p < system.P.size(); ++p) {
      farthest = std::max(farthest, system.P[p].x.norm());
      fastest = std::max(fastest, system.P[p].v.norm());
      x_error = std::max(x_error, (published.P[p].x - system.P[p].x).norm());
      v_error = std::max(v_error, (published.P[p].v - system.P[p].v).norm());
    }
    EXPECT_LT(x_error, 1e-12 * farthest) << "step " << steps;
    EXPECT_LT(v_error, 1e-12 * fastest) << "step " << steps;
  });
  EXPECT_EQ(steps, 200);
}
