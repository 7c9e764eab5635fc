// A block of rubber that relaxes, deformed homogeneously: against convolutions in closed form and
// against the ordinary differential equations of its branches, integrated finely.
#include "fem_reference/elements/memory.h"

#include <deal.II/grid/grid_generator.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "fem_reference/elements/body.h"
#include "fem_reference/output/press_fields.h"
#include "meshes/rubber/hyperelastic_law.h"

using namespace fingertip;
using namespace fingertip::fem_reference;

namespace {

constexpr double length = 0.01;

const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();

ReferenceJob relaxing(Strain strain, bool bulk = true) {
  ReferenceJob job;
  job.strain = strain;
  job.rubber.relaxation = {{{0.3, 0.02}, {0.25, 0.4}}, bulk};
  job.rubber.energy.volumetric = meshes::VolumetricLaw::quadratic;
  return job;
}

/// A cube, and what acts on it at a homogeneous gradient F.
struct Block {
  explicit Block(ReferenceJob of, int degree = 1)
      : job(std::move(of)), body(MPI_COMM_WORLD, degree) {
    dealii::GridGenerator::subdivided_hyper_rectangle(
        body.triangulation, {2, 1, 1}, dealii::Point<3>(), dealii::Point<3>(length, length, length),
        true);
    body.number({});
  }

  Vector at(const Eigen::Matrix3d& F) const {
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(body.mapping, body.fine.dofs, points);
    std::vector<dealii::types::global_dof_index> indices(body.fine.element.n_dofs_per_cell());
    Vector u = body.fine.vector();
    for (const auto& cell : body.fine.dofs.active_cell_iterators()) {
      cell->get_dof_indices(indices);
      for (unsigned i = 0; i < indices.size(); ++i) {
        const auto& x = points.at(indices[i]);
        const Eigen::Vector3d moved = (F - one) * Eigen::Vector3d(x[0], x[1], x[2]);
        u[indices[i]] = moved[body.fine.element.system_to_component_index(i).first];
      }
    }
    return u;
  }

  /// Nominal tractions on the faces whose normals are the axes, in columns: P [Pa].
  Eigen::Matrix3d tractions(const Vector& force) const {
    Eigen::Matrix3d P;
    for (unsigned face = 0; face < 3; ++face)
      P.col(face) = resultant(body, force, 2 * face + 1) / (length * length);
    return P;
  }

  ReferenceJob job;
  Body<3> body;
};

/// The small-strain memory of a block that follows a path.
struct LinearBlock : Block {
  explicit LinearBlock(const ReferenceJob& of) : Block(of), memory(body, job), u(at(one)) {}

  void step(const Eigen::Matrix3d& F, double duration) {
    memory.set_step(duration);
    const Vector next = at(F);
    memory.advance(u, next);
    u = next;
  }
  Eigen::Matrix3d stress() const {
    Vector force = unconstrained_force(body, *make_kernel<3>(job, 1.0, 0.0), u);
    force += unconstrained_force(body, memory.kernel(), memory.past());
    return tractions(force);
  }

  LinearMemory<3> memory;
  Vector u;
};

struct FiniteBlock : Block {
  explicit FiniteBlock(const ReferenceJob& of, int degree = 1)
      : Block(of, degree), memory(body, job) {}

  void step(const Eigen::Matrix3d& F, double duration) {
    memory.start_step(duration);
    u = at(F);
    in_step = unconstrained_force(
        body, *make_kernel<3>(job, 1.0, memory.stiffening(), memory.carried()), u);
    memory.advance(u);
  }
  Eigen::Matrix3d stress() const {
    const PointStresses past = memory.past();
    return tractions(unconstrained_force(body, *make_kernel<3>(job, 1.0, 0.0, &past), u));
  }

  PointMemory<3> memory;
  Vector u, in_step;
};

Eigen::Matrix3d sheared(double gamma) {
  Eigen::Matrix3d F = one;
  F(0, 1) = gamma;
  return F;
}

Eigen::Matrix3d stretched(double strain) {
  Eigen::Matrix3d F = one;
  F(0, 0) += strain;
  return F;
}

/// h of a branch at `time` when s rises from 0 to 1 within `rise` at a constant rate and stays.
double branch_after(double time, double rise, double tau) {
  if (time <= rise) return tau / rise * (1 - std::exp(-time / tau));
  return tau / rise * (std::exp(-(time - rise) / tau) - std::exp(-time / tau));
}

TEST(LinearMemory, RampAndHoldIsTheConvolution) {
  const double rise = 0.05, amount = 0.03;
  for (const bool bulk : {true, false}) {
    const ReferenceJob job = relaxing(Strain::linear, bulk);
    const double G = job.rubber.shear_modulus, lambda = job.rubber.lame_lambda();
    LinearBlock shear(job), confined(job);
    double time = 0.0;
    // Unequal steps, the ramp's end among them.
    for (const double next : {0.003, 0.01, 0.03, 0.05, 0.0501, 0.07, 0.4, 2.0}) {
      const double s = amount * std::min(1.0, next / rise);
      shear.step(sheared(s), next - time);
      confined.step(stretched(s), next - time);
      time = next;
      double branches = 0.0;
      for (std::size_t i = 0; i < 2; ++i)
        branches += job.rubber.relaxation.relative_modulus(i) * amount *
                    branch_after(time, rise, job.rubber.relaxation.branches[i].time);
      EXPECT_NEAR(shear.stress()(0, 1) / (G * (s + branches)), 1.0, 1e-9) << time;
      const double relaxing_modulus = bulk ? lambda + 2 * G : 4.0 / 3.0 * G;
      const double wanted = (lambda + 2 * G) * s + relaxing_modulus * branches;
      EXPECT_NEAR(confined.stress()(0, 0) / wanted, 1.0, 1e-9) << time;
    }
  }
}

TEST(LinearMemory, StorageAndLossOverFourDecades) {
  const ReferenceJob job = relaxing(Strain::linear);
  const meshes::Relaxation& relaxation = job.rubber.relaxation;
  const double G = job.rubber.shear_modulus, pi = std::numbers::pi, amount = 1e-3;
  constexpr int steps = 160;
  for (double frequency = 0.1; frequency < 2e3; frequency *= 10.0) {
    LinearBlock block(job);
    const Vector shape = block.at(sheared(amount));
    const double duration = 2 * pi / frequency / steps;
    block.memory.set_step(duration);
    // Until what the start has left is gone.
    const int cycles = 2 + int(std::ceil(10 * relaxation.branches[1].time * frequency / (2 * pi)));
    std::complex<double> amplitude = 0.0;
    for (int i = 1; i <= cycles * steps; ++i) {
      Vector next = shape;
      next *= std::sin(2 * pi * i / steps);
      block.memory.advance(block.u, next);
      block.u = next;
      if (i > (cycles - 1) * steps)
        amplitude +=
            block.stress()(0, 1) * std::exp(std::complex<double>(0.0, -2 * pi * i / steps));
    }
    amplitude *= std::complex<double>(0.0, 2.0) / double(steps) / (G * amount);
    const double storage = relaxation.storage(frequency), loss = relaxation.loss(frequency);
    EXPECT_NEAR(amplitude.real() / storage, 1.0, 1e-3) << frequency;
    EXPECT_NEAR(amplitude.imag() / amplitude.real() / (loss / storage), 1.0, 1e-3) << frequency;
  }
}

TEST(LinearMemory, KeepsItsEnergyAccount) {
  // Work put in is stored or dissipated; none comes out of nothing.
  LinearBlock block(relaxing(Strain::linear, false));
  double work = 0.0, dissipated = 0.0;
  const int steps = 2000;
  const double duration = 0.1 / steps, volume = length * length * length;
  for (int i = 1; i <= steps; ++i) {
    const Vector before = block.u;
    const Eigen::Matrix3d stress = block.stress();
    const double rate = block.memory.dissipation_rate();
    EXPECT_GE(rate, 0.0);
    const double gamma = 0.02 * std::sin(40.0 * i * duration);
    block.step(sheared(gamma) + 0.5 * (stretched(gamma) - one), duration);
    const Eigen::Matrix3d change =
        (sheared(gamma) + 0.5 * (stretched(gamma) - one)) -
        (sheared(0.02 * std::sin(40.0 * (i - 1) * duration)) +
         0.5 * (stretched(0.02 * std::sin(40.0 * (i - 1) * duration)) - one));
    work += 0.5 * volume * (stress + block.stress()).cwiseProduct(change).sum();
    dissipated += 0.5 * duration * (rate + block.memory.dissipation_rate());
  }
  LinearSystem system(block.body, false);
  assemble_force(block.body, *make_kernel<3>(block.job, 1.0, 0.0), block.u, system);
  EXPECT_NEAR((system.energy + block.memory.energy() + dissipated) / work, 1.0, 1e-5);
  EXPECT_GT(dissipated, 0.1 * work);
}

/// S of the branches over a path, by Runge and Kutta: with g = h - s, g' = -(g + s)/tau.
Eigen::Matrix3d nominal_after(const ReferenceJob& job,
                              const std::function<Eigen::Matrix3d(double)>& path, double time) {
  const meshes::HyperelasticLaw law(job.rubber);
  const auto relaxing_stress = [&](double t) -> Eigen::Matrix3d {
    const Eigen::Matrix3d F = path(t);
    return F.inverse() *
           (job.rubber.relaxation.bulk ? law.complete(F).stress : law.pointwise(F).stress);
  };
  const Eigen::Matrix3d F = path(time), s = relaxing_stress(time);
  Eigen::Matrix3d total = F.inverse() * law.complete(F).stress;
  constexpr int steps = 4000;
  const double dt = time / steps;
  for (std::size_t i = 0; i < job.rubber.relaxation.branches.size(); ++i) {
    const double tau = job.rubber.relaxation.branches[i].time;
    Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
    for (int k = 0; k < steps; ++k) {
      const double t = k * dt;
      const Eigen::Matrix3d start = relaxing_stress(t), middle = relaxing_stress(t + dt / 2),
                            end = relaxing_stress(t + dt);
      const Eigen::Matrix3d a = -(g + start) / tau, b = -(g + dt / 2 * a + middle) / tau,
                            c = -(g + dt / 2 * b + middle) / tau, d = -(g + dt * c + end) / tau;
      g += dt / 6 * (a + 2 * b + 2 * c + d);
    }
    total += job.rubber.relaxation.relative_modulus(i) * (g + s);
  }
  return F * total;
}

TEST(PointMemory, RampAndHoldFollowsHolzapfelAndSimo) {
  const double rise = 0.05;
  const auto path = [&](double t) -> Eigen::Matrix3d {
    const double s = std::min(1.0, t / rise);
    return sheared(0.7 * s) * stretched(-0.25 * s);
  };
  for (const bool bulk : {true, false}) {
    const ReferenceJob job = relaxing(Strain::finite, bulk);
    FiniteBlock block(job);
    const int steps = 500;
    for (int i = 1; i <= steps; ++i) block.step(path(rise * i / steps), rise / steps);
    const Eigen::Matrix3d at_once = nominal_after(job, path, rise);
    EXPECT_LT((block.stress() - at_once).norm(), 1e-6 * at_once.norm());
    // While it is held one step is as good as many.
    block.step(path(1.0), 0.1);
    const Eigen::Matrix3d held = nominal_after(job, path, rise + 0.1);
    EXPECT_LT((block.stress() - held).norm(), 1e-6 * held.norm());
    EXPECT_GT((at_once - held).norm(), 0.1 * held.norm());
    // The force that Newton's method balances is that of the end of the step.
    EXPECT_LT((block.tractions(block.in_step) - held).norm(), 1e-6 * held.norm());
  }
}

TEST(PointMemory, IsOfSecondOrderInTheStep) {
  const ReferenceJob job = relaxing(Strain::finite);
  const auto path = [](double t) -> Eigen::Matrix3d { return sheared(300.0 * t * t); };
  const Eigen::Matrix3d exact = nominal_after(job, path, 0.05);
  std::vector<double> errors;
  for (const int steps : {10, 20, 40}) {
    FiniteBlock block(job);
    for (int i = 1; i <= steps; ++i) block.step(path(0.05 * i / steps), 0.05 / steps);
    errors.push_back((block.stress() - exact).norm() / exact.norm());
  }
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.1);
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.05);
  EXPECT_LT(errors[0], 2e-3);
}

TEST(PointMemory, TurnsWithTheBody) {
  FiniteBlock block(relaxing(Strain::finite, false));
  const Eigen::Matrix3d F = sheared(0.4) * stretched(0.2);
  block.step(F, 0.01);
  const Eigen::Matrix3d before = block.stress();
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  block.step(turn * F, 1e-12);
  EXPECT_LT((block.stress() - turn * before).norm(), 1e-9 * before.norm());
}

TEST(PointMemory, TangentIsTheForcesDerivative) {
  FiniteBlock block(relaxing(Strain::finite), 2);
  block.step(sheared(0.4) * stretched(0.2), 0.01);
  block.memory.start_step(0.02);
  const auto kernel =
      make_kernel<3>(block.job, 1.0, block.memory.stiffening(), block.memory.carried());
  LinearSystem system(block.body, false), other(block.body, false);
  const Vector u = block.at(sheared(0.3) * stretched(0.1)), towards = block.at(sheared(-1.0));
  assemble(block.body, *kernel, u, system);
  Vector wanted = u;
  system.matrix.vmult(wanted, towards);
  const double h = 1e-6;
  Vector ahead = u, behind = u;
  ahead.add(h, towards);
  behind.add(-h, towards);
  assemble_force(block.body, *kernel, ahead, system);
  assemble_force(block.body, *kernel, behind, other);
  Vector found = system.force;
  found -= other.force;
  found *= 1 / (2 * h);
  found -= wanted;
  EXPECT_LT(found.l2_norm(), 1e-6 * wanted.l2_norm());
}

TEST(MemoryAndFields, StressHasWhatIsRemembered) {
  const Eigen::Matrix3d F = sheared(0.02) * stretched(0.01);
  for (const bool bulk : {true, false}) {
    LinearBlock small(relaxing(Strain::linear, bulk));
    small.step(F, 0.02);
    const StressField<3> of_small(small.body, small.job, small.u, {small.memory.past(), {}});
    FiniteBlock large(relaxing(Strain::finite, bulk));
    large.step(F, 0.02);
    const StressField<3> of_large(large.body, large.job, large.u, {{}, large.memory.past()});
    const Eigen::Matrix3d cauchy = large.stress() * F.transpose() / F.determinant();
    for (const auto& cell : small.body.fine.dofs.active_cell_iterators())
      for (const Eigen::Matrix3d& found : of_small.on(cell))
        EXPECT_LT((found - small.stress()).norm(), 1e-9 * small.stress().norm());
    for (const auto& cell : large.body.fine.dofs.active_cell_iterators())
      for (const Eigen::Matrix3d& found : of_large.on(cell))
        EXPECT_LT((found - cauchy).norm(), 1e-9 * cauchy.norm());
  }
}

}  // namespace
