#include "studies/files/shown_units.h"

#include <fmt/format.h>

#include <algorithm>

namespace fingertip::studies {

namespace {

constexpr double gf = 9.80665e-3;  ///< standard gravity times 1 g [N]
constexpr double cm = 1e-2;        ///< [m]

/// mN, mm, kPa and mN/mm = N/m go together: no power of ten stands between them.
constexpr ShownUnits tables[] = {{UnitSystem::si,
                                  {"length", "m", "mm", "mm", 1e3},
                                  {"force", "N", "mN", "mN", 1e3},
                                  {"stress", "Pa", "kPa", "kPa", 1e-3},
                                  {"stiffness", "N/m", "N/m", "N/m", 1.0},
                                  {"torque", "N m", "mN mm", "mN mm", 1e6},
                                  {"speed", "m/s", "mm/s", "mm/s", 1e3},
                                  {"compliance", "m/N", "mm/N", "mm/N", 1e3}},
                                 {UnitSystem::paper,
                                  {"length", "m", "cm", "cm", 1.0 / cm},
                                  {"force", "N", "gf", "gf", 1.0 / gf},
                                  {"stress", "Pa", "gf/cm²", "gf/cm^2", cm* cm / gf},
                                  {"stiffness", "N/m", "gf/cm", "gf/cm", cm / gf},
                                  {"torque", "N m", "gf cm", "gf cm", 1.0 / (gf * cm)},
                                  {"speed", "m/s", "cm/s", "cm/s", 1.0 / cm},
                                  {"compliance", "m/N", "cm/gf", "cm/gf", gf / cm}}};

UnitSystem today = UnitSystem::si;

}  // namespace

std::string_view name(UnitSystem system) {
  return system == UnitSystem::si ? "si" : "paper";
}

UnitSystem unit_system(std::string_view word) {
  return word == name(UnitSystem::paper) ? UnitSystem::paper : UnitSystem::si;
}

std::string ShownUnit::label(std::string_view what) const {
  return fmt::format("{} [{}]", what, name);
}

std::string ShownUnit::text(double value) const {
  return fmt::format("{:.4g} {}", factor * value, name);
}

std::string ShownUnit::decimals(double value) const {
  std::string text = fmt::format("{:.4f}", factor * value);
  return text == "-0.0000" ? text.substr(1) : text;
}

std::array<const ShownUnit*, 7> ShownUnits::all() const {
  return {&length, &force, &stress, &stiffness, &torque, &speed, &compliance};
}

const ShownUnit* ShownUnits::of(std::string_view si) const {
  const auto units = all();
  const auto found = std::ranges::find(units, si, &ShownUnit::si);
  return found == units.end() ? nullptr : *found;
}

const ShownUnits& units_of(UnitSystem system) {
  return tables[std::size_t(system)];
}

const ShownUnits& shown_units() {
  return units_of(today);
}

ShowIn::ShowIn(UnitSystem system) : before_(today) {
  today = system;
}

ShowIn::~ShowIn() {
  today = before_;
}

}  // namespace fingertip::studies
