#include "studies/bench/plan.h"

namespace fingertip::studies {

namespace {

using lattice::ModelKind;

std::vector<PressPlan> presses(const std::vector<int>& network, const std::vector<int>& others) {
  std::vector<PressPlan> all;
  for (const int n : network)
    for (const int threads : {1, 2}) all.push_back({ModelKind::network, n, threads});
  for (const ModelKind model : {ModelKind::hookean, ModelKind::published})
    for (const int n : others) all.push_back({model, n, 1});
  return all;
}

}  // namespace

BenchPlan full_plan() {
  BenchPlan plan;
  plan.sizes = {20, 48, 22, 70, 100};
  plan.presses = presses({6, 8, 12, 16, 24}, {6, 8, 12, 16, 24});
  plan.continua = {{1, 0.25}, {1, 0.5}, {1, 1.0}, {2, 0.25}, {2, 0.5}};
  return plan;
}

BenchPlan quick_plan() {
  BenchPlan plan;
  plan.quick = true;
  plan.rounds = 3;
  plan.wide_rounds = 1;
  plan.seconds = 0.05;
  plan.sizes = {20, 48};
  plan.presses = presses({6, 8}, {6, 8});
  plan.continua = {{1, 0.25}, {1, 0.5}};
  return plan;
}

BenchPlan smallest_plan() {
  BenchPlan plan = quick_plan();
  plan.rounds = plan.wide_rounds = 1;
  plan.seconds = 0.001;
  plan.sizes = {20};
  plan.presses = {{ModelKind::network, 4, 1}};
  plan.depth = 0.0005;
  plan.error_from = 0.0002;
  plan.reference_degree = 1;
  plan.reference_refinement = 0.25;
  plan.reference_error = plan.small_strain = false;
  plan.continua = {};
  plan.times = false;
  return plan;
}

}  // namespace fingertip::studies
