#include "studies/bench/plan.h"

namespace fingertip::studies::inline bench {

namespace {

using lattice::Integrator;
using lattice::ModelKind;

/// The longest step of scaled masses: a control period.
constexpr double scaled_step = 1e-3;

/// `spacings`: R/a. Masses are scaled in the models that consist of cells.
std::vector<PressedLattice> presses(const std::vector<int>& spacings) {
  std::vector<PressedLattice> all;
  const auto add = [&](ModelKind model, int threads, bool scaled, bool whole = false) {
    for (const int n : spacings) {
      PressedLattice press{model, n, threads};
      if (scaled) {
        press.integrator = Integrator::mass_scaled;
        press.time_step = scaled_step;
      }
      press.whole = whole;
      all.push_back(press);
    }
  };
  for (const bool scaled : {false, true})
    for (const int threads : {1, 2}) add(ModelKind::network, threads, scaled);
  for (const int threads : {1, 2}) add(ModelKind::network, threads, true, true);
  for (const bool scaled : {false, true}) add(ModelKind::hookean, 1, scaled);
  add(ModelKind::published, 1, false);
  return all;
}

}  // namespace

BenchPlan full_plan() {
  BenchPlan plan;
  plan.sizes = {20, 48};
  plan.presses = presses({6, 8, 12, 16, 24});
  plan.continua = {{1, 1.0}, {1, 2.0}, {2, 0.5}, {2, 1.0}, {2, 2.0}};
  return plan;
}

BenchPlan quick_plan() {
  BenchPlan plan;
  plan.quick = true;
  plan.rounds = 3;
  plan.wide_rounds = 1;
  plan.seconds = 0.05;
  plan.sizes = {20, 48};
  plan.presses = presses({6, 8});
  plan.static_finest = 8;
  plan.continua = {{1, 1.0}, {2, 0.5}, {2, 1.0}};
  return plan;
}

BenchPlan smallest_plan() {
  BenchPlan plan = quick_plan();
  plan.rounds = plan.wide_rounds = 1;
  plan.seconds = 0.001;
  plan.sizes = {20};
  plan.presses = {{ModelKind::network, 4, 1},
                  {ModelKind::network, 4, 1, Integrator::mass_scaled, scaled_step},
                  {ModelKind::network, 4, 1, Integrator::mass_scaled, scaled_step, true}};
  plan.depth = 0.0005;
  plan.error_from = 0.0002;
  plan.reference_degree = 1;
  plan.reference_refinement = 1.0;
  plan.reference_error = plan.small_strain = false;
  plan.continua = {};
  plan.times = false;
  return plan;
}

}  // namespace fingertip::studies::inline bench
