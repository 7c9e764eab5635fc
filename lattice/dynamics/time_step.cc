#include "lattice/dynamics/time_step.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline dynamics {

namespace {

/// Largest change of a cell's volume within a step.
constexpr double volume_change_of_a_step = 0.1;

/// Growth of the cells' extremes that the step allows for.
constexpr double allowance = 1.2;

constexpr double longest_scaled = 1e-3;

/// Of spans, which are differences of times: what they may exceed a whole number of steps by.
constexpr double relative_round_off = 1e-9;

/// What a Lanczos estimate, which comes from below, may lack.
constexpr double margin = 1.05;

/// Of a tie's energy the particles' part is taken care of (tied_bond.h), the rod has the other. Its
/// ties act as after the step, lambda dt² + 2 (lambda dt) dt <= 4.
double bonded_rod(const LatticeModel& model, const RodBody* rod) {
  return rod != nullptr ? 3.0 * rod_bounds(model, *rod).stiffness : 0.0;
}

/// Of a lattice with true surfaces, from what Lanczos found.
SpectralBounds bonded_bounds(SpectralBounds held, double growth, double rod) {
  held.stiffness = std::max(growth * held.stiffness, rod);
  held.damping *= growth;
  return held;
}

/// With scaled masses neither rubber nor ties set a limit. Steps above `longest_scaled` see too
/// little of a contact that grows.
SpectralBounds scaled_bounds() {
  SpectralBounds bounds;
  bounds.stiffness = 4.0 / (longest_scaled * longest_scaled);
  return bounds;
}

double safety_factor(const LatticeModel& model) {
  if (model.kinematics == Kinematics::small) return 0.95;
  return model.has_springs() ? 0.8 : 0.9;
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
  if (integrator != Integrator::explicit_euler) {
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
  // The particle among whole cells: the largest mass.
  const double mass = *std::max_element(model.mass.begin(), model.mass.end());
  const SpringConstants& constants = model.constants;
  return std::sqrt(2.0 * std::max({constants.k1, constants.k2, constants.k3}) / mass);
}

SpectralBounds tightest_bounds(const LatticeModel& model, const RodBody* rod) {
  const SpectralBounds held = spectral_estimate(model);
  if (model.kind != ModelKind::published)
    return bonded_bounds(held, margin, bonded_rod(model, rod));
  const SpectralBounds own = rod != nullptr ? rod_bounds(model, *rod) : SpectralBounds{};
  SpectralBounds bounds = spectral_bounds(model, rod);
  // The largest eigenvalue of a positive matrix is at most the sum of those of its diagonal blocks.
  bounds.stiffness = std::min(bounds.stiffness, margin * held.stiffness + own.stiffness);
  bounds.damping = std::min(bounds.damping, margin * held.damping + own.damping);
  return bounds;
}

StepController::StepController(const LatticeModel& model, const RodBody* rod, Integrator integrator,
                               std::optional<double> wanted, const Team& team)
    : model_(&model),
      integrator_(integrator),
      safety_(safety_factor(model)),
      rod_stiffness_(bonded_rod(model, rod)) {
  const bool scaled = integrator == Integrator::mass_scaled;
  const SpectralBounds bounds = scaled ? scaled_bounds() : tightest_bounds(model, rod);
  if (scaled && !wanted) wanted = usual_scaled_step;
  if (model.kind == ModelKind::published) {
    report_.omega0 = paper_frequency(model);
    report_.paper_bound = 1.0 / report_.omega0;
  }
  const double stable = largest_stable_step(bounds, integrator);
  if (!scaled) report_.spectral_bound = stable;
  if (!(stable > 0.0)) {
    throw meshes::InvalidInput(
        {"run.integrator", std::string(name(integrator)),
         "explicit Euler is unstable at any step without damping: it adds energy to every mode",
         "use symplectic-euler, or give rubber.retardation_time a positive value"});
  }
  why_ = scaled ? "with scaled masses accuracy rules, not stability"
                : ruling(bounds, integrator, stable);
  if (wanted && !(*wanted > 0.0 && *wanted <= stable)) refuse(*wanted, stable, why_);
  largest_ = now_.present = wanted ? *wanted : safety_ * stable;
  const bool follows = !scaled && integrator != Integrator::runge_kutta;
  if (follows && model.kinematics == Kinematics::finite && !model.cell_lattice.empty()) {
    search_ = std::make_unique<SpectrumSearch>(model, team);
    search_->finish(now_.search);
  }
}

/// Of what bounds the spectrum, since it was computed.
double StepController::growth(const CellExtremes& now) const {
  return std::max(now.stiffening / now_.reference.stiffening,
                  now.thickening / now_.reference.thickening);
}

bool StepController::outdated(const CellExtremes& now) const {
  const double decline = std::min(now.stiffening / now_.reference.stiffening,
                                  now.thickening / now_.reference.thickening);
  return growth(now) > allowance || decline < 1.0 / (allowance * allowance);
}

void StepController::adopt(const SpectralBounds& estimate, const CellExtremes& at) {
  const SpectralBounds bounds = bonded_bounds(estimate, allowance * margin, rod_stiffness_);
  now_.present = std::min(largest_, safety_ * largest_stable_step(bounds, integrator_));
  now_.reference = at;
}

void StepController::update(const State& state, const CellExtremes& now) {
  if (search_ == nullptr) return;
  search_->begin(now_.search, state);
  while (now_.search.active) search_->advance(now_.search);
  adopt(now_.search.found, now);
}

void StepController::follow(const State& state, const CellExtremes& now) {
  constexpr int steps_per_portion = 4;
  if (search_ == nullptr) return;
  if (!now_.search.active) {
    if (!outdated(now)) return;
    search_->begin(now_.search, state);
    now_.begun = now;
    now_.steps = 0;
  }
  if (++now_.steps % steps_per_portion != 0) return;
  search_->advance(now_.search);
  if (!now_.search.active) adopt(now_.search.found, now_.begun);
}

void StepController::note(const CellExtremes& now) {
  now_.reference = now;
}

double StepController::limit(const CellExtremes& now) const {
  // Both eigenvalues grow no faster than the extremes, so the stable step shrinks no faster.
  const double step = now_.present * std::min(1.0, allowance / growth(now));
  if (!(now.fastest > 0.0)) return step;
  return std::min(step, volume_change_of_a_step / now.fastest);
}

double StepController::divide(double span, const CellExtremes& now) const {
  return span / std::ceil(span / limit(now) * (1.0 - relative_round_off));
}

double StepController::at_rest(double span) const {
  return span / std::ceil(span / largest_ * (1.0 - relative_round_off));
}

StepReport StepController::report(double step) const {
  StepReport report = report_;
  report.step = step;
  std::ostringstream text;
  text.precision(3);
  text << name(integrator_) << " with steps of " << step * 1e6 << " us";
  if (!std::isnan(report.spectral_bound))
    text << ", " << step / report.spectral_bound << " of the spectral bound "
         << report.spectral_bound * 1e6 << " us";
  if (!std::isnan(report.omega0))
    text << ", " << step * report.omega0 << "/omega0 with the paper's omega0 = " << report.omega0
         << " rad/s, whose bound 1/omega0 = " << report.paper_bound * 1e6
         << " us sees a single spring of those around a particle";
  text << "; " << why_;
  report.explanation = text.str();
  return report;
}

}  // namespace fingertip::lattice::inline dynamics
