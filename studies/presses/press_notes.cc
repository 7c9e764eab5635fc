#include "studies/presses/press_notes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/press/press_deviation.h"
#include "lattice/press/press_task.h"
#include "meshes/press/press_motion.h"
#include "studies/jobs/progress.h"

namespace fingertip::studies::inline presses {

namespace {

using lattice::ForceDeviation;
using lattice::Integrator;
using lattice::PressSetup;
using lattice::ScalingChoice;

std::string percent(double part) {
  return part > 1.0 ? "more than 100 %" : fmt::format("{:.2g} %", 100.0 * part);
}

std::string millimetres(double length) {
  return fmt::format("{:.3g} mm", 1e3 * length);
}

std::string length_of(double step) {
  return step < 1e-3 ? fmt::format("{:.3g} us", 1e6 * step) : fmt::format("{:.3g} ms", 1e3 * step);
}

/// "leave run.time_step out, which takes ..."
std::string remedy(const PressSetup& setup) {
  const ScalingChoice best = lattice::best_scaling(setup);
  if (!best.scaled) return "run.time_step = auto takes plain masses here, which have no such error";
  const double from = lattice::judged_from(setup);
  return fmt::format("run.time_step = auto takes {} here, within {} from {} on",
                     length_of(best.step),
                     percent(lattice::worst_of(best.deviations, from).relative), millimetres(from));
}

/// Of a given or chosen step that is too long for some depth.
std::string deviation_note(const PressSetup& setup, const ScalingChoice& choice) {
  const auto& all = choice.deviations;
  const ForceDeviation worst = lattice::worst_of(all);
  const auto beyond = std::count_if(all.begin(), all.end(), [](const ForceDeviation& deviation) {
    return deviation.relative > lattice::tolerated_deviation;
  });
  std::string text = fmt::format(
      "scaled masses at steps of {}: the force is estimated to be off by {} at {}, and by more "
      "than "
      "{:.0f} % at {} of {} depths",
      length_of(choice.step), percent(worst.relative), millimetres(worst.indentation),
      100.0 * lattice::tolerated_deviation, beyond, setup.protocol.samples.size());
  const double from = lattice::judged_from(setup);
  const double judged = lattice::worst_of(all, from).relative;
  if (judged > lattice::tolerated_deviation) return text + "; " + remedy(setup);
  return text +
         fmt::format(", within {} from {} on; run.integrator = symplectic-euler has no such error",
                     percent(judged), millimetres(from));
}

/// Of one evaluation of forces and all that goes with a step of plain masses, per particle [s]. A
/// rough figure: processors differ by a factor of two.
constexpr double plain_cost = 5e-8;

double pressing_time(const PressSetup& setup, double step, double cost, int threads) {
  const double time = meshes::PressMotion(setup.protocol).duration(),
               particles = 1.4 * lattice::moving_particles(setup);
  const double gain = 1.0 + 0.8 * (std::max(threads, 1) - 1);
  return time / step * particles * cost / gain;
}

}  // namespace

std::vector<std::string> law_notes(const PressSetup& setup) {
  const lattice::LatticeSettings& lattice = setup.lattice;
  if (setup.rubber.energy == meshes::StrainEnergy() ||
      (lattice.model == lattice::ModelKind::network &&
       lattice.kinematics == lattice::Kinematics::finite))
    return {};
  return {fmt::format(
      "rubber.law = {}: lattice.model = {} at {} strain knows E and G alone; lattice.model = "
      "network takes the law",
      meshes::describe(setup.rubber.energy), lattice::name(lattice.model),
      lattice::name(lattice.kinematics))};
}

std::vector<std::string> scaling_notes(const PressSetup& setup) {
  if (setup.integrator != Integrator::mass_scaled ||
      setup.protocol.mode == meshes::DriveMode::equilibrium)
    return {};
  const ScalingChoice choice = lattice::choose_scaling(setup);
  if (!choice.scaled) {
    return {fmt::format(
        "run.integrator = mass-scaled: at press.speed = {:.3g} mm/s scaled masses would keep the "
        "force within {:.0f} % only at steps that are no gain; plain masses are pressed "
        "(symplectic-euler)",
        1e3 * setup.protocol.speed, 100.0 * lattice::tolerated_deviation)};
  }
  if (lattice::worst_of(choice.deviations).relative <= lattice::tolerated_deviation) return {};
  return {deviation_note(setup, choice)};
}

std::string integrator_note(const PressSetup& setup) {
  if (setup.integrator != Integrator::mass_scaled)
    return fmt::format(
        "run.integrator = auto: {}; scaled masses would not press this as well and faster",
        lattice::name(setup.integrator));
  const ScalingChoice choice = lattice::best_scaling(setup);
  const double from = lattice::judged_from(setup);
  return fmt::format(
      "run.integrator = auto: mass-scaled, steps of {}, force within an estimated {} from {} on",
      length_of(choice.step), percent(lattice::worst_of(choice.deviations, from).relative),
      millimetres(from));
}

std::optional<std::string> duration_note(const PressSetup& setup, int threads) {
  constexpr double long_time = 30.0, worth_it = 5.0;  // [s]; times as fast
  if (setup.integrator != Integrator::symplectic_euler ||
      setup.protocol.mode == meshes::DriveMode::equilibrium)
    return {};
  PressSetup scaled = setup;
  scaled.integrator = Integrator::mass_scaled;
  scaled.time_step.reset();
  if (!lattice::beyond_the_lattice(scaled).empty()) return {};
  const ScalingChoice best = lattice::best_scaling(scaled);
  const double plain = pressing_time(setup, setup.time_step.value_or(lattice::plain_step(setup)),
                                     plain_cost, threads);
  if (plain < long_time || !best.scaled) return {};
  const double faster = pressing_time(scaled, best.step, 2.0 * plain_cost, threads);
  if (plain < worth_it * faster) return {};
  const double from = lattice::judged_from(setup);
  return fmt::format(
      "this press takes some {}; run.integrator = mass-scaled would take some {} and change the "
      "force by an estimated {} at most from {} on",
      rough_duration(plain), rough_duration(faster),
      percent(lattice::worst_of(best.deviations, from).relative), millimetres(from));
}

}  // namespace fingertip::studies::inline presses
