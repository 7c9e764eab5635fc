#include "studies/config/finger_defaults.h"

#include <fmt/format.h>

#include <cmath>

#include "lattice/model/cut_tip.h"
#include "lattice/press/press_deviation.h"
#include "studies/config/key_table.h"
#include "studies/config/units.h"

namespace fingertip::studies {

namespace {

constexpr const char* chosen_place = "default for this finger";

void choose_spacing(LoadedConfig& loaded) {
  Config& config = loaded.config;
  Entry& entry = loaded.entries.at("lattice.spacing");
  if (entry.given) return;
  lattice::LatticeSettings& lattice = config.press.lattice;
  const double radius = config.press.geometry.tip_radius,
               coarsest = lattice::coarsest_spacing(config.press.geometry, lattice.model);
  // Of an invalid dome it may be anything.
  if (!(coarsest > 0.0 && coarsest < lattice.spacing)) return;
  config.spacing_divisor = std::ceil(radius / coarsest);
  lattice.spacing = radius / *config.spacing_divisor;
  entry = {fmt::format("\"tip_radius/{:.0f}\"", *config.spacing_divisor), chosen_place, false};
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

void choose_for_finger(LoadedConfig& loaded) {
  choose_spacing(loaded);
  meshes::PressProtocol& protocol = loaded.config.press.protocol;
  if (protocol.samples.empty() && protocol.program.empty())
    choose_depth(loaded, "press.depth", protocol.depth);
  choose_depth(loaded, "calibration.depth", loaded.config.calibration.depth);
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

std::vector<std::string> spacing_notes(const LoadedConfig& loaded) {
  const Entry& entry = loaded.entries.at("lattice.spacing");
  if (entry.place != chosen_place) return {};
  return {
      fmt::format("lattice.spacing = {} ({:.3g} mm) is the coarsest that this finger's walls "
                  "allow; the usual {} is too coarse for them",
                  entry.literal, 1e3 * loaded.config.press.lattice.spacing,
                  find_key("lattice.spacing")->preset)};
}

}  // namespace fingertip::studies
