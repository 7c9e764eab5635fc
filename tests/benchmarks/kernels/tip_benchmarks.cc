#include <benchmark/benchmark.h>

#include <random>
#include <string>

#include "benchmarks.h"
#include "lattice/dynamics/finger.h"
#include "lattice/forces/forces.h"
#include "lattice/kernels/by_width.h"
#include "lattice/model/cut_model.h"
#include "operation_count.h"

namespace kernel_benchmarks {

using namespace fingertip;

namespace {

struct Kind {
  lattice::ModelKind model;
  lattice::Kinematics kinematics;
};

constexpr Kind kinds[] = {{lattice::ModelKind::published, lattice::Kinematics::finite},
                          {lattice::ModelKind::central, lattice::Kinematics::small},
                          {lattice::ModelKind::hookean, lattice::Kinematics::small},
                          {lattice::ModelKind::network, lattice::Kinematics::finite}};

/// The default tip of the default rubber at R/per_radius.
lattice::LatticeModel tip(const Kind& kind, int per_radius) {
  const meshes::Rubber rubber;
  lattice::LatticeSettings settings;
  settings.model = kind.model;
  settings.kinematics = kind.kinematics;
  settings.spacing = meshes::Geometry{}.tip_radius / per_radius;
  settings.constants = kind.model == lattice::ModelKind::published
                           ? lattice::published_constants(rubber, settings.spacing)
                           : lattice::hookean_constants(rubber, settings.spacing, 0.0);
  if (kind.model == lattice::ModelKind::central) settings.constants.kappa = 0.0;
  return lattice::build_tip({}, rubber, settings);
}

/// Displacements up to a hundredth of the spacing.
lattice::State shaken(const lattice::LatticeModel& model) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  lattice::State state(model);
  for (const std::size_t i : model.particles) {
    for (std::size_t c = 0; c < 3; ++c) {
      state.displacement.component[c][i] = 0.01 * model.spacing() * uniform(generator);
      state.velocity.component[c][i] = 0.01 * uniform(generator);
    }
  }
  return state;
}

void count(benchmark::State& state, const lattice::LatticeModel& model, double operations) {
  state.counters["masses"] = double(model.particles.size());
  state.counters["springs"] = double(model.spring_count());
  state.counters["steps"] = 1;
  state.counters["operations"] = operations;
}

/// Springs, cells with volume term, cut-cell weights and dampers: all internal forces.
void measure_forces(benchmark::State& state, const Kind& kind, int per_radius, int width,
                    int threads) {
  const lattice::LatticeModel model = tip(kind, per_radius);
  lattice::Team team(threads);
  lattice::InternalForces forces(model, team, width);
  const lattice::State at = shaken(model);
  lattice::VectorField force(model.points());
  for (auto _ : state) forces.accumulate(at, force);
  count(state, model, kernel_probes::operations_per_spring(model));
}

/// A step of the whole finger, far from the plane: forces, bond, integration, balances.
void measure_step(benchmark::State& state, const Kind& kind, int per_radius, int threads) {
  const lattice::LatticeModel model = tip(kind, per_radius);
  const lattice::Plane far{meshes::Vector3(0.0, 0.0, 1.0), -meshes::Vector3::UnitZ()};
  lattice::Finger finger(model, lattice::rod_body({}, {}), far, meshes::ContactMode::stick,
                         lattice::Integrator::symplectic_euler, 1e-6, threads);
  for (auto _ : state) finger.advance(lattice::Wrench{});
  count(state, model, 0.0);
}

}  // namespace

void register_tips(const Scope& scope) {
  const auto add = [&](const std::string& name, auto&& body) {
    benchmark::RegisterBenchmark(name.c_str(), body)->MinTime(scope.seconds)->UseRealTime();
  };
  const int n = scope.per_radius;
  for (const Kind& kind : kinds) {
    const std::string model(lattice::name(kind.model));
    for (int width = 2; width <= scope.widest; width *= 2) {
      for (int threads = 1; threads <= (width == scope.widest ? scope.threads : 1); threads *= 2) {
        add(full_name(model + "_forces", width, "float64", threads, n),
            [=](benchmark::State& state) { measure_forces(state, kind, n, width, threads); });
      }
    }
    // The finger's step takes the widest registers there are: not comparable below them.
    if (scope.widest < lattice::kernel::supported_width()) continue;
    for (int threads = 1; threads <= scope.threads; threads *= 2)
      add(full_name(model + "_step", scope.widest, "float64", threads, n),
          [=](benchmark::State& state) { measure_step(state, kind, n, threads); });
  }
}

}  // namespace kernel_benchmarks
