#include "studies/config/finger_defaults.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lattice/model/cut_tip.h"
#include "lattice/press/press_deviation.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/cells/surface_points.h"
#include "meshes/shape/geometry.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/text/units.h"

namespace fingertip::studies::inline config {

namespace {

constexpr const char* chosen_place = "default for this finger";

/// N of the coarsest tip_radius/N, N whole, that is at most `spacing`.
double divisor_of(const meshes::Geometry& geometry, double spacing) {
  return std::ceil(geometry.tip_radius / spacing);
}

void take_spacing(LoadedConfig& loaded, double divisor) {
  lattice::PressSetup& press = loaded.config.press;
  loaded.config.spacing_divisor = divisor;
  press.lattice.spacing = press.geometry.tip_radius / divisor;
}

void choose_depth(LoadedConfig& loaded, const char* key, double& depth) {
  Entry& entry = loaded.entries.at(key);
  const double thickness = loaded.config.press.geometry.thickness();
  if (entry.given || !(thickness > 0.0 && thickness <= depth)) return;
  const std::string chosen = fmt::format("{:.3g} mm", 1e2 * thickness);
  depth = parse_quantity(chosen, "m", chosen);  // as it will be read from the run's parameters
  entry = {'"' + chosen + '"', chosen_place, false};
}

}  // namespace

double first_kept_depth(const LoadedConfig& loaded) {
  const meshes::PressProtocol& protocol = loaded.config.press.protocol;
  const Entry& entry = loaded.entries.at("press.samples");
  // Where none are asked for, the protocol has usual ones by now.
  const bool asked = entry.given && entry.literal != find_key("press.samples")->preset;
  return asked ? protocol.samples.front() : 0.1 * protocol.depth;
}

void choose_for_finger(LoadedConfig& loaded) {
  meshes::PressProtocol& protocol = loaded.config.press.protocol;
  if (protocol.samples.empty() && protocol.program.empty())
    choose_depth(loaded, "press.depth", protocol.depth);
  choose_depth(loaded, "calibration.depth", loaded.config.calibration.depth);
}

namespace {

/// Of the coarsest lattice that the finger's walls allow.
double least_divisor(const lattice::PressSetup& press) {
  return divisor_of(press.geometry, lattice::coarsest_spacing(press.geometry, press.lattice.model));
}

/// Whose estimate chooses the spacing, whatever the model: one configuration has one grid.
lattice::ForceEstimator estimator_of_cells(lattice::PressSetup press) {
  press.lattice.model = lattice::ModelKind::hookean;
  return lattice::ForceEstimator(press);
}

}  // namespace

void choose_automatic_spacing(LoadedConfig& loaded) {
  const Config& config = loaded.config;
  if (!config.automatic_spacing) return;
  const lattice::PressSetup& press = config.press;
  double divisor = divisor_of(
      press.geometry,
      estimator_of_cells(press).spacing_for(first_kept_depth(loaded), config.spacing_tolerance));
  // Masses go with the cube.
  const double masses =
      meshes::expected_particle_count(press.geometry, press.geometry.tip_radius / divisor);
  if (masses > config.max_particles)
    divisor = std::floor(divisor * std::cbrt(config.max_particles / masses));
  take_spacing(loaded, std::max(divisor, least_divisor(press)));
}

void keep_spacing(LoadedConfig& loaded, const LoadedConfig& of) {
  if (!loaded.config.automatic_spacing || !of.config.automatic_spacing) return;
  take_spacing(loaded, std::max(*of.config.spacing_divisor, least_divisor(loaded.config.press)));
}

void choose_limits(LoadedConfig& loaded) {
  lattice::PressSetup& press = loaded.config.press;
  if (press.protocol.mode != meshes::DriveMode::pid) return;
  const lattice::ActuatorLimits suitable = lattice::suitable_limits(press);
  const auto choose = [&](const char* key, double wanted, double& limit, const char* unit) {
    Entry& entry = loaded.entries.at(key);
    if (entry.given || !(wanted > limit)) return;
    limit = std::stod(fmt::format("{:.2g}", wanted));  // as it will be read again
    entry = {fmt::format("\"{} {}\"", limit, unit), chosen_place, false};
  };
  choose("controller.force_limit", suitable.force, press.controller.force_limit, "N");
  choose("controller.torque_limit", suitable.torque, press.controller.torque_limit, "N m");
}

namespace {

/// Straight inward behind all but the thinnest share of what may touch [m].
double wall_of_most(const meshes::Geometry& geometry, double share) {
  struct Behind {
    double depth, area;
  };
  const auto shape = meshes::shape_of(geometry);
  const double near = 1e-4 * geometry.tip_radius;
  std::vector<Behind> all;
  double left = 0.0;
  for (const meshes::SurfacePoint& point : meshes::surface_points(
           geometry, meshes::ProfileSurface::contact, geometry.tip_radius / 12.0)) {
    // As far as no surface is near, until the other side is met.
    double depth = near, step = near;
    while (step > 0.5 * near) {
      step = -shape->signed_distance(point.position - depth * point.normal);
      depth += std::max(step, 0.0);
    }
    all.push_back({depth, point.area});
    left += share * point.area;
  }
  std::ranges::sort(all, {}, &Behind::depth);
  std::size_t first = 0;
  while (first + 1 < all.size() && (left -= all[first].area) > 0.0) ++first;
  return all[first].depth;
}

}  // namespace

std::string thin_part(const meshes::Geometry& geometry) {
  constexpr double share = 0.25, worth_telling = 1.5;
  if (geometry.is_dome()) return {};
  const double wall = meshes::shape_of(geometry)->wall(), rest = wall_of_most(geometry, share);
  if (!(rest > worth_telling * wall)) return {};
  const double divisor = std::max(12.0, std::ceil(4.0 * geometry.tip_radius / rest));
  return fmt::format(
      "the thinnest wall, {:.3g} mm, asks for this; behind three quarters of what may touch lie at "
      "least {:.3g} mm, for which tip_radius/{:.0f} would do, {:.2g} masses",
      1e3 * wall, 1e3 * rest, divisor,
      meshes::expected_particle_count(geometry, geometry.tip_radius / divisor));
}

namespace {

/// What an automatic spacing of so many masses is good for.
std::string accuracy_note(const LoadedConfig& loaded, double masses) {
  constexpr double many = 1e6;
  const Config& config = loaded.config;
  const double depth = first_kept_depth(loaded), wanted = config.spacing_tolerance;
  const lattice::ModelKind model = config.press.lattice.model;
  const double error = estimator_of_cells(config.press).at(depth)->grid();  // of cells known
  std::string text;
  if (masses > config.max_particles) {
    const std::string thin = masses > many ? thin_part(config.press.geometry) : "";
    text = fmt::format(
        "more than lattice.max_particles = {:.3g}, for the finger's walls ask for it{}{}; ",
        config.max_particles, thin.empty() ? "" : ": ", thin);
  } else if (error > wanted) {
    text = fmt::format("as fine as lattice.max_particles = {:.3g} allows; ", config.max_particles);
  }
  text += fmt::format(
      "it may put {:.2g} % on the force at {:.3g} mm, and less at larger depths ({:.3g} % wanted)",
      100.0 * error, 1e3 * depth, 100.0 * wanted);
  if (model == lattice::ModelKind::published || model == lattice::ModelKind::central)
    text += fmt::format(", but of a hookean lattice; what {} springs cannot be comes on top",
                        lattice::name(model));
  return text;
}

}  // namespace

std::string spacing_note(const LoadedConfig& loaded) {
  if (!loaded.config.automatic_spacing) return "";
  const lattice::PressSetup& press = loaded.config.press;
  const double spacing = press.lattice.spacing,
               masses = meshes::expected_particle_count(press.geometry, spacing);
  return fmt::format(
      "lattice.spacing = \"auto\" (tip_radius/{:.0f}, {:.3g} mm, some {:.2g} masses): {}",
      *loaded.config.spacing_divisor, 1e3 * spacing, masses, accuracy_note(loaded, masses));
}

}  // namespace fingertip::studies::inline config
