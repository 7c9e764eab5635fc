#include "lattice/time_step.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::lattice {

namespace {

double safety(Kinematics kinematics) {
  return kinematics == Kinematics::small ? 0.95 : 0.8;
}

/// Which of the bounds decides, in words.
std::string ruling(const SpectralBounds& bounds, Integrator integrator, double stable) {
  if (integrator == Integrator::explicit_euler) {
    if (stable == bounds.shortest_retardation) {
      return "explicit Euler adds energy to modes with less damping than dt times stiffness: the "
             "shortest retardation time mu/k rules";
    }
    return "the fastest damped motion rules (explicit Euler: c (2 dt - dt²/tau) <= 4)";
  }
  const double stiffness_part = bounds.stiffness * stable * stable;
  return stiffness_part > 2.0 ? "the stiffness of the lattice rules (lambda dt² + 2 c dt <= 4)"
                              : "the damping of the lattice rules (lambda dt² + 2 c dt <= 4)";
}

[[noreturn]] void refuse(double wanted, double stable, const std::string& why) {
  std::ostringstream rule;
  rule.precision(4);
  rule << "the step must be positive and at most " << stable << " s, the computed stability bound ("
       << why << ")";
  throw meshes::InvalidInput({"run.time_step", meshes::to_text(wanted) + " s", rule.str(),
                              "choose a smaller step, or leave it out to take the largest safe "
                              "one"});
}

}  // namespace

double largest_stable_step(const SpectralBounds& bounds, Integrator integrator) {
  const double lambda = bounds.stiffness, c = bounds.damping;
  if (integrator == Integrator::symplectic_euler) {
    return 4.0 / (c + std::sqrt(c * c + 4.0 * lambda));  // root of lambda dt² + 2 c dt = 4
  }
  const double tau = bounds.longest_retardation;
  if (!(tau > 0.0)) return 0.0;
  // Root of c (2 dt - dt²/tau) = 4; if there is none, any dt < tau satisfies the inequality.
  const double discriminant = 1.0 - 4.0 / (c * tau);
  const double fastest = discriminant >= 0.0 ? tau * (1.0 - std::sqrt(discriminant)) : tau;
  return std::min(fastest, bounds.shortest_retardation);
}

double paper_frequency(const LatticeModel& model) {
  double mass = model.mass[model.particles.front()];
  for (const std::size_t i : model.particles) mass = std::min(mass, model.mass[i]);
  const double k = *std::max_element(model.stiffness.begin(), model.stiffness.end());
  return std::sqrt(2.0 * k / mass);
}

SpectralBounds tightest_bounds(const LatticeModel& model, const RodBody* rod) {
  constexpr double margin = 1.05;
  SpectralBounds bounds = spectral_bounds(model, rod);
  const SpectralBounds held = spectral_estimate(model);
  const SpectralBounds own = rod != nullptr ? rod_bounds(model, *rod) : SpectralBounds{};
  // The largest eigenvalue of a positive matrix is at most the sum of those of its diagonal blocks.
  bounds.stiffness = std::min(bounds.stiffness, margin * held.stiffness + own.stiffness);
  bounds.damping = std::min(bounds.damping, margin * held.damping + own.damping);
  return bounds;
}

StepReport choose_step(const LatticeModel& model, const RodBody* rod, Integrator integrator,
                       std::optional<double> wanted, double period) {
  const SpectralBounds bounds = tightest_bounds(model, rod);
  StepReport report;
  report.omega0 = paper_frequency(model);
  report.paper_bound = 1.0 / report.omega0;
  report.spectral_bound = largest_stable_step(bounds, integrator);
  if (!(report.spectral_bound > 0.0)) {
    throw meshes::InvalidInput(
        {"run.integrator", std::string(name(integrator)),
         "explicit Euler is unstable at any step without damping: it adds energy to every mode",
         "use symplectic-euler, or give rubber.retardation_time a positive value"});
  }
  const std::string why = ruling(bounds, integrator, report.spectral_bound);
  if (wanted) {
    if (!(*wanted > 0.0 && *wanted <= report.spectral_bound)) {
      refuse(*wanted, report.spectral_bound, why);
    }
    report.step = *wanted;
  } else {
    const double safe = safety(model.kinematics) * report.spectral_bound;
    report.step = period / std::ceil(period / safe);
  }
  std::ostringstream text;
  text.precision(3);
  text << "step " << report.step * 1e6 << " us = " << report.step / report.spectral_bound
       << " of the spectral bound " << report.spectral_bound * 1e6
       << " us = " << report.step * report.omega0
       << "/omega0 with the paper's omega0 = " << report.omega0
       << " rad/s, whose bound 1/omega0 = " << report.paper_bound * 1e6
       << " us does not see the 26 springs of a particle; " << why;
  report.explanation = text.str();
  return report;
}

}  // namespace fingertip::lattice
