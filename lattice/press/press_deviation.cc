#include "lattice/press/press_deviation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

#include "lattice/dynamics/time_step.h"
#include "meshes/press/marker_measures.h"
#include "meshes/press/obstacle.h"
#include "meshes/press/press_motion.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline press {

namespace {

using Complex = std::complex<double>;
using meshes::Geometry;
using meshes::Rubber;

constexpr double sway_factor = 43.0;     // of (w dt)², measured
constexpr double contact_factor = 5.5;   // chi, with the margin that S leaves for stiffening
constexpr double resolved_patch = 1.25;  // spacings
constexpr double cost = 2.0;             // of a scaled step, in plain ones

/// A x² + B x³ + D y² + T, at most C, or E z where that is more; never more than half of the force.
/// Of the profile P x^3/2.
struct GridError {
  double contact = 0.0, edge = 0.0, wall = 0.0, point = 0.0, points = 0.0, profile = 0.0,
         ties = 3e-3;
  ForceEstimate at(double x, double y, double z) const {
    const double most = std::max(point, std::min(points * z, 0.5)),
                 inside = std::min(wall * y * y + ties, most);
    return {.contact = std::min((contact + edge * x) * x * x, most - inside),
            .inside = inside,
            .profile = profile * x * std::sqrt(x)};
  }
};
constexpr GridError solid_cells{0.06, 0.15, 0.2, 0.24, 0.15, 0.3};   // hookean, network
constexpr GridError springs_alone{0.04, 0.1, 1.7, 0.18, 0.25, 0.4};  // central

/// e: by how many spacings the radius of what sticks may be too large.
constexpr double edge_of_stick = 0.16;

/// Of what another Poisson's ratio sends outward, over u_z of the surface at delta a/r; 4/(3 pi) on
/// a half space, about twice that of rubber that a rod holds.
constexpr double outward = 0.8;

/// Mindlin's d ln Q/d ln u where Q is the share `s` of what friction holds, from 0 to 1.
double still_held(double s) {
  return s > 0.0 ? 1.5 * std::cbrt(1.0 - s) * (1.0 - std::pow(1.0 - s, 2.0 / 3.0)) / s : 1.0;
}

/// F = factor (delta^3/2 + layer delta²).
struct RoughForce {
  double factor = 0.0, layer = 0.0, pole_radius = 0.0, wall = 0.0;

  RoughForce(const Geometry& geometry, const Rubber& rubber, const meshes::Obstacle& obstacle) {
    const auto shape = meshes::shape_of(geometry);
    pole_radius = meshes::relative_radius(*shape, obstacle);
    wall = shape->wall();
    const double nu = rubber.poissons_ratio(), radius = std::sqrt(pole_radius),
                 alpha = (1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1.0 - nu);
    factor = 4.0 / 3.0 * rubber.youngs_modulus / (1.0 - nu * nu) * radius;
    layer = 2.0 / std::numbers::pi * alpha * radius / wall;
  }
  double value(double d) const { return factor * (std::pow(d, 1.5) + layer * d * d); }
  double slope(double d) const { return factor * (1.5 * std::sqrt(d) + 2.0 * layer * d); }
  double curvature(double d) const { return factor * (0.75 / std::sqrt(d) + 2.0 * layer); }
};

/// By how much a contact of half axes A > B is resolved worse than a round one of their geometric
/// mean: sqrt of the mean of (a/A)² and (a/B)². Hertz: about B/A = (R_B/R_A)^(2/3).
double elongation(const Geometry& geometry, const meshes::Obstacle& obstacle) {
  if (obstacle.is_plane() || obstacle.shape == meshes::ObstacleShape::sphere) return 1.0;
  const auto shape = meshes::shape_of(geometry);
  const double radii =
                   std::pow(meshes::relative_radius(*shape, obstacle) / shape->pole_radius(), 2),
               axes = std::pow(radii, 2.0 / 3.0);
  return std::sqrt(0.5 * (axes + 1.0 / axes));
}

/// Of the rubber on its rod, the sleeve's lowest mode.
struct Sway {
  double frequency = 0.0;  ///< [rad/s]
  double mass = 0.0;       ///< mu m [kg]

  Sway(const Geometry& geometry, const Rubber& rubber) {
    if (!geometry.is_dome()) {  // a column in shear, held below
      frequency = 0.5 * std::numbers::pi * rubber.shear_wave_speed() / geometry.thickness();
      mass = 8.0 / (std::numbers::pi * std::numbers::pi) * rubber.density * geometry.tip_volume();
      return;
    }
    constexpr int intervals = 200;
    const double r = geometry.rod_radius, R = geometry.tip_radius, h = (R - r) / intervals;
    double area = 0.0, first = 0.0, second = 0.0, strain = 0.0;
    for (int i = 0; i < intervals; ++i) {  // midpoints
      const double at = r + (i + 0.5) * h, ring = at * h,
                   u = R * R * std::log(at / r) - 0.5 * (at * at - r * r), slope = R * R / at - at;
      area += ring;
      first += ring * u;
      second += ring * u * u;
      strain += ring * slope * slope;
    }
    frequency = rubber.shear_wave_speed() * std::sqrt(strain / second);
    mass = rubber.density * geometry.tip_volume() * first * first / (area * second);
  }
};

/// mu m z'' of one mode [N] after the rise, Re(amplitude exp(i frequency t)).
struct Swing {
  Complex amplitude;       ///< at a time, with its phase then
  double frequency = 0.0;  ///< [rad/s]; 0: it creeps back
};

Swing swing_of(double mass, double w, double s, double tau, const meshes::PressMotion& approach,
               double speed, double time) {
  const double T = approach.rise_time(), turn = 2.0 * std::numbers::pi / T;
  const double half = 0.5 * w * w * tau / (1.0 + s);
  const Complex root = std::sqrt(Complex(half * half - w * w / (1.0 + s)));
  // ∫ a(t') exp(p (time - t')) dt' of a = speed/T (1 - cos turn t')
  const auto response = [&](const Complex& p) {
    const Complex pulse = std::exp(p * time) - std::exp(p * (time - T));
    return speed / T * pulse * turn * turn / (p * (p * p + turn * turn));
  };
  const Complex up = -half + root, down = -half - root;
  const Complex both = mass / ((1.0 + s) * (up - down));
  if (root.imag() != 0.0) return {2.0 * both * up * up * response(up), root.imag()};
  return {both * (up * up * response(up) - down * down * response(down)), 0.0};
}

/// Largest difference that the two come to about `time`: once they have come apart by half a turn,
/// it counts no more that they meet again.
double largest_difference(const Swing& a, const Swing& b, double time) {
  const double apart = std::abs(a.frequency - b.frequency) * time;
  if (apart > std::numbers::pi) return std::abs(a.amplitude) + std::abs(b.amplitude);
  return std::abs(a.amplitude - b.amplitude);
}

/// The sway's amplitude at a time with plain masses, and what masses scaled to `step` change of it;
/// of the sum of the modes [N].
struct SwayForce {
  double plain = 0.0, scaled = 0.0;
};
SwayForce sway_force(const Sway& sway, const PressSetup& setup, double step, double time) {
  const double speed = setup.protocol.speed, tau = setup.rubber.retardation_time;
  const meshes::PressMotion approach(setup.protocol);
  SwayForce sum;
  for (const double n : {1.0, 3.0, 5.0}) {
    const double w = n * sway.frequency, mass = sway.mass / (n * n),
                 s = sway_factor * w * w * step * step;
    const auto swing = [&](double inertia) {
      return swing_of(mass, w, inertia, tau, approach, speed, time);
    };
    sum.plain += std::abs(swing(0.0).amplitude);
    sum.scaled += largest_difference(swing(s), swing(0.0), time - 0.5 * approach.rise_time());
  }
  return sum;
}

/// What masses scaled to `step` change where particles touch; nothing at a step of 0 [N].
double impact_force(const PressSetup& setup, const RoughForce& force, double step, double depth) {
  const double v = setup.protocol.speed,
               filter = contact_factor *
                        (0.25 * step * step + 0.5 * step * setup.rubber.retardation_time),
               patch = std::sqrt(force.pole_radius * depth);
  return filter * v * v * force.curvature(depth) +
         v * std::sqrt(filter) * force.slope(depth) * setup.lattice.spacing / patch;
}

/// Of a program: one press to its depth at its largest speed, for deviations grow with it.
PressSetup pressed_once(PressSetup setup) {
  for (const meshes::PressStage& stage : setup.protocol.program)
    setup.protocol.speed = std::max(setup.protocol.speed, stage.speed);
  setup.protocol.program.clear();
  return setup;
}

}  // namespace

double plain_step(const PressSetup& setup) {
  const double highest = 2.0 * setup.rubber.longitudinal_wave_speed() / setup.lattice.spacing;
  SpectralBounds bounds;  // README of dynamics/: stable steps
  bounds.stiffness = 1.15 * highest * highest;
  bounds.damping = setup.rubber.retardation_time * bounds.stiffness;
  return largest_stable_step(bounds, Integrator::symplectic_euler);
}

double rough_force(const Geometry& geometry, const Rubber& rubber, double indentation) {
  return RoughForce(geometry, rubber, {}).value(indentation);
}

namespace {

/// Of the free surface from the axis, on the side of +x, at a height [m].
double radius_at(const meshes::Shape& shape, double height) {
  double inside = 0.0, outside = shape.largest_radius();
  while (outside - inside > 1e-3 * shape.largest_radius()) {
    const double middle = 0.5 * (inside + outside);
    (shape.signed_distance({middle, 0.0, height}) < 0.0 ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

/// To two digits, upward.
double in_two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return unit * std::ceil(value / unit * (1.0 - 1e-12));
}

}  // namespace

double expected_force(const PressSetup& setup) {
  Rubber rubber = setup.rubber;
  rubber.youngs_modulus *= rubber.relaxation.instantaneous_ratio();
  rubber.shear_modulus *= rubber.relaxation.instantaneous_ratio();
  const auto shape = meshes::shape_of(setup.geometry);
  const double depth = setup.protocol.depth, thickness = shape->wall();
  const RoughForce round(setup.geometry, rubber, setup.protocol.obstacle);
  double radius = radius_at(*shape, shape->pole() - 0.5 * depth);
  if (!setup.protocol.obstacle.is_plane())
    radius = std::min(radius, std::sqrt(round.pole_radius * depth));
  const double shape_factor = 0.5 * radius / thickness,
               modulus = std::min(rubber.youngs_modulus * (1.0 + 2.0 * shape_factor * shape_factor),
                                  rubber.longitudinal_modulus());
  return std::max(round.value(depth),
                  modulus * std::numbers::pi * radius * radius * depth / thickness);
}

ActuatorLimits suitable_limits(const PressSetup& setup) {
  constexpr double margin = 3.0;
  const double force = in_two_digits(margin * expected_force(setup)),
               lever = setup.geometry.pole() + setup.geometry.rod_length;
  return {force, in_two_digits(force * lever)};
}

std::vector<ForceDeviation> scaling_deviations(const PressSetup& setup_with_program, double step) {
  const PressSetup setup = pressed_once(setup_with_program);
  const meshes::PressProtocol& protocol = setup.protocol;
  const RoughForce force(setup.geometry, setup.rubber, protocol.obstacle);
  const Sway sway(setup.geometry, setup.rubber);
  std::vector<ForceDeviation> found;
  const auto depths =
      protocol.samples.empty() ? meshes::default_samples(protocol.depth) : protocol.samples;
  for (const double depth : depths) {
    if (std::sqrt(force.pole_radius * depth) < resolved_patch * setup.lattice.spacing) continue;
    const double changed =
        impact_force(setup, force, step, depth) +
        sway_force(sway, setup, step, meshes::PressMotion(protocol).time_at(depth)).scaled;
    found.push_back({depth, changed / force.value(depth)});
  }
  return found;
}

ForceDeviation worst_of(const std::vector<ForceDeviation>& deviations, double from) {
  ForceDeviation worst;
  for (const ForceDeviation& deviation : deviations) {
    if (deviation.indentation >= from && deviation.relative > worst.relative) worst = deviation;
  }
  return worst;
}

double judged_from(const PressSetup& setup) {
  constexpr double round_off = 1e-9;
  return setup.protocol.depth / 6.0 * (1.0 - round_off);
}

ScalingChoice best_scaling(const PressSetup& setup) {
  return best_scaling(setup, usual_scaled_step, judged_from(setup));
}

ScalingChoice best_scaling(const PressSetup& setup, double longest, double from) {
  const auto worst = [&](double step) {
    return worst_of(scaling_deviations(setup, step), from).relative;
  };
  const double plain = plain_step(setup);
  double step = longest;
  while (step >= cost * plain && worst(step) > tolerated_deviation) step *= 0.9;
  if (step < cost * plain) return {false, plain, {}};
  return {true, step, scaling_deviations(setup, step)};
}

ScalingChoice choose_scaling(const PressSetup& setup) {
  if (!setup.time_step) return best_scaling(setup);
  return {true, *setup.time_step, scaling_deviations(setup, *setup.time_step)};
}

namespace {

/// A rubber of Poisson's ratio 1/4 and the same E.
Rubber quarter_of(Rubber rubber) {
  rubber.shear_modulus = rubber.youngs_modulus / 2.5;
  return rubber;
}

}  // namespace

struct ForceEstimator::Terms {
  PressSetup setup;
  RoughForce force, of_quarter;
  double elongated = 1.0;    ///< of the contact
  std::optional<Sway> sway;  ///< in presses in time
  double scaled_step = 0.0;  ///< of scaled masses [s]; 0: plain ones
  meshes::Vector3 touched;   ///< first, in the undeformed finger [m]

  explicit Terms(const PressSetup& with_program)
      : setup(pressed_once(with_program)),
        force(setup.geometry, setup.rubber, setup.protocol.obstacle),
        of_quarter(setup.geometry, quarter_of(setup.rubber), setup.protocol.obstacle),
        elongated(elongation(setup.geometry, setup.protocol.obstacle)),
        touched(touched_first(setup.geometry, setup.protocol.tilt, setup.protocol.obstacle)) {
    if (setup.protocol.mode == meshes::DriveMode::equilibrium) return;
    sway.emplace(setup.geometry, setup.rubber);
    if (setup.integrator != Integrator::mass_scaled) return;
    if (const ScalingChoice choice = choose_scaling(setup); choice.scaled)
      scaled_step = choice.step;
  }

  /// Of the grid; of a patch of this radius, or else Hertz'.
  ForceEstimate grid(double spacing, std::optional<double> patch, double depth) const {
    const double hertz = std::sqrt(force.pole_radius * depth);
    const bool central = setup.lattice.model == ModelKind::central;
    return (central ? springs_alone : solid_cells)
        .at(elongated * spacing / patch.value_or(hertz), spacing / force.wall, spacing / hertz);
  }
  double model(double depth) const {
    if (setup.lattice.model != ModelKind::central) return 0.0;
    return std::abs(of_quarter.value(depth) / force.value(depth) - 1.0);
  }
  double motion(double depth) const {
    if (!sway) return 0.0;
    const double damping =
                     setup.rubber.retardation_time * setup.protocol.speed * force.slope(depth),
                 impact = impact_force(setup, force, scaled_step, depth),
                 time = meshes::PressMotion(setup.protocol).time_at(depth);
    const SwayForce swings = sway_force(*sway, setup, scaled_step, time);
    return (damping + impact + swings.plain + swings.scaled) / force.value(depth);
  }
  ForceEstimate estimate(std::optional<double> patch, double depth) const {
    ForceEstimate found = grid(setup.lattice.spacing, patch, depth);
    found.model = model(depth);
    found.motion = motion(depth);
    return found;
  }
};

ForceEstimator::ForceEstimator(const PressSetup& setup)
    : terms_(std::make_shared<const Terms>(setup)) {}

bool ForceEstimator::knows_model() const {
  return terms_->setup.lattice.model != ModelKind::published;
}

std::optional<ForceEstimate> ForceEstimator::of(const meshes::PressSample& sample) const {
  const double depth = sample.indentation, patch = sample.contact_radius;
  if (!knows_model() || !(sample.normal_force > 0.0 && depth > 0.0 && patch > 0.0)) return {};
  ForceEstimate found = terms_->estimate(patch, depth);
  if (!std::isnan(sample.step_error)) found.steps = sample.step_error / sample.normal_force;
  return found;
}

std::optional<ForceEstimate> ForceEstimator::at(double depth) const {
  if (!knows_model()) return {};
  return terms_->estimate({}, depth);
}

meshes::RelativeErrors ForceEstimator::errors(const meshes::PressSample& sample,
                                              const ForceEstimate& estimate) const {
  const PressSetup& setup = terms_->setup;
  meshes::RelativeErrors errors{
      .normal = estimate.sum(),
      .aside = estimate.sum(),
      .spin = estimate.sum(),
      .lever = (setup.geometry.rod_endpoint() - setup.geometry.pole() * meshes::Vector3::UnitZ())
                   .norm()};
  if (setup.protocol.contact == meshes::ContactMode::frictionless) return errors;
  double held_aside = 1.0, held_in_turn = 1.0;
  if (setup.protocol.contact == meshes::ContactMode::coulomb) {
    constexpr double of_hertz = 3.0 * std::numbers::pi / 16.0;
    const double most = setup.protocol.friction * sample.normal_force,
                 spin = std::isnan(sample.spin_torque) ? 0.0 : std::abs(sample.spin_torque);
    held_aside = still_held(std::min(sample.force().head<2>().norm() / most, 1.0));
    held_in_turn = std::sqrt(1.0 - std::min(spin / (of_hertz * most * sample.contact_radius), 1.0));
  }
  const bool central = setup.lattice.model == ModelKind::central;
  const double x = terms_->elongated * setup.lattice.spacing / sample.contact_radius,
               edge = edge_of_stick * x,
               springs =
                   central ? std::abs((2.0 - setup.rubber.poissons_ratio()) / 1.75 - 1.0) : 0.0,
               slipping = 2.0 * (central ? springs_alone : solid_cells).edge * x * x * x;
  errors.aside += held_aside * (edge + springs - estimate.model);
  errors.spin += held_in_turn * (3.0 * edge - estimate.model) + (1.0 - held_in_turn) * slipping;
  errors.centre = 2.0 / 3.0 * held_in_turn * edge;
  return errors;
}

double ForceEstimator::displacement_error(const meshes::PressSample& sample,
                                          const meshes::MarkerRow& marker) const {
  const auto estimate = of(sample);
  if (!estimate) return meshes::unknown;
  const PressSetup& setup = terms_->setup;
  const meshes::RelativeErrors relative = errors(sample, *estimate);
  const auto moved = [](double value) { return std::isnan(value) ? 0.0 : std::abs(value); };
  const double depth = sample.indentation, aside = moved(sample.lateral_displacement),
               turned = moved(sample.twist) * sample.contact_radius,
               off = relative.normal * depth + relative.aside * aside + relative.spin * turned;
  double error =
      off * marker_share(marker, terms_->touched, sample.contact_radius, depth + aside + turned);
  if (setup.lattice.model == ModelKind::central) {
    const double nu = setup.rubber.poissons_ratio();
    error += outward * std::abs((1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)) - 1.0 / 3.0) * depth *
             std::min(1.0, sample.contact_radius / (marker.place - terms_->touched).norm());
  }
  return error;
}

double ForceEstimator::spacing_for(double depth, double tolerance) const {
  double fine = 0.0, coarse = terms_->setup.geometry.tip_radius;
  for (int n = 0; n < 40; ++n) {
    const double middle = 0.5 * (fine + coarse);
    (terms_->grid(middle, {}, depth).grid() <= tolerance ? fine : coarse) = middle;
  }
  return fine;
}

}  // namespace fingertip::lattice::inline press
