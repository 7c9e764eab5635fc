#include "studies/files/press_condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "studies/files/shown_units.h"

namespace fingertip::studies::inline files {

namespace {

namespace fs = std::filesystem;

/// Of numbers that went through a file as text.
constexpr double rounding = 1e-9;

struct Number {
  const char* name;
  double PressCondition::*value;
  ShownUnit ShownUnits::*unit;  ///< null: a ratio or an angle
};

/// Those that make another problem of it when they differ.
constexpr Number numbers[] = {
    {"friction", &PressCondition::friction, nullptr},
    {"Young's modulus", &PressCondition::youngs_modulus, &ShownUnits::stress},
    {"shear modulus", &PressCondition::shear_modulus, &ShownUnits::stress},
    {"tilt", &PressCondition::tilt, nullptr},
    {"lateral motion on the way down", &PressCondition::lateral, &ShownUnits::length}};

constexpr Number lengths_of_domes[] = {
    {"tip radius", &PressCondition::tip_radius, &ShownUnits::length},
    {"rod radius", &PressCondition::rod_radius, &ShownUnits::length},
    {"sleeve length", &PressCondition::sleeve_length, &ShownUnits::length},
    {"rod length", &PressCondition::rod_length, &ShownUnits::length}};

/// A dome's tip radius is its largest one; other shapes keep theirs under that name.
constexpr Number length_of_any_shape = {"largest radius", &PressCondition::tip_radius,
                                        &ShownUnits::length};

/// Other shapes keep the height of their endpoint as the length of a rod below z = 0.
constexpr Number endpoint_of_others = {"depth of the endpoint below z = 0",
                                       &PressCondition::rod_length, &ShownUnits::length};

bool differ(double a, double b) {
  return std::abs(a - b) > rounding * std::max(std::abs(a), std::abs(b));
}

bool differ(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && a != b;
}

std::string told(const Number& number, double value) {
  if (number.value == &PressCondition::tilt)
    return fmt::format("{:.4g} degrees", value * 180.0 / std::numbers::pi);
  return number.unit == nullptr ? fmt::format("{:.4g}", value)
                                : (shown_units().*number.unit).text(value);
}

std::string moved(double speed) {
  return speed > 0.0 ? "pressed at " + shown_units().speed.text(speed) : "in equilibrium";
}

std::string kind_of(const std::string& profile) {
  if (profile == "dome") return "dome";
  return profile.starts_with('[') ? "profile" : "solid";
}

void tell_if_different(const PressCondition& press, const PressCondition& other,
                       const Number& number, std::vector<ConditionDifference>& found) {
  const double a = press.*number.value, b = other.*number.value;
  if (differ(a, b))
    found.push_back(
        {fmt::format("{}: {}, not {}", number.name, told(number, a), told(number, b)), true});
}

/// Shapes of two kinds, or two of one kind, have only some lengths in common.
void tell_shapes(const PressCondition& press, const PressCondition& other,
                 std::vector<ConditionDifference>& found) {
  const std::string kind = kind_of(press.profile), other_kind = kind_of(other.profile);
  if (differ(press.profile, other.profile)) {
    found.push_back({kind == other_kind ? "another " + kind
                                        : fmt::format("shape: {}, not {}", kind, other_kind),
                     true});
    tell_if_different(press, other, length_of_any_shape, found);
  } else if (kind == "dome") {
    for (const Number& number : lengths_of_domes) tell_if_different(press, other, number, found);
  } else {
    tell_if_different(press, other, endpoint_of_others, found);
  }
}

}  // namespace

PressCondition condition_of(const JsonEntry& inputs) {
  PressCondition condition;
  const JsonEntry geometry = object_if_any(inputs, "geometry"),
                  rubber = object_if_any(inputs, "rubber");
  condition.tip_radius = number_if_any(geometry, "tip_radius");
  condition.rod_radius = number_if_any(geometry, "rod_radius");
  condition.sleeve_length = number_if_any(geometry, "sleeve_length");
  condition.rod_length = number_if_any(geometry, "rod_length");
  if (geometry.contains("profile")) condition.profile = geometry.at("profile").content().dump();
  if (geometry.contains("solid")) condition.profile = text_if_any(geometry, "solid");
  condition.youngs_modulus = number_if_any(rubber, "youngs_modulus");
  condition.shear_modulus = number_if_any(rubber, "shear_modulus");
  const bool lattice = inputs.contains("lattice");
  // Older runs of the continuum do not keep the press apart.
  const bool apart = lattice || inputs.contains("protocol");
  const JsonEntry press = apart ? object_if_any(inputs, "protocol") : inputs;
  const std::string strain = lattice ? text_if_any(object_if_any(inputs, "lattice"), "kinematics")
                                     : text_if_any(inputs, "strain");
  condition.strain = strain == "linear" ? "small" : strain;
  condition.contact = text_if_any(press, "contact");
  condition.friction = number_if_any(press, "friction");
  condition.tilt = number_if_any(press, "tilt");
  if (press.contains("obstacle")) condition.obstacle = press.at("obstacle").content().dump();
  condition.lateral =
      text_if_any(press, "lateral_path") == "after" ? 0.0 : number_if_any(press, "lateral");
  const double speed = number_if_any(press, "speed");
  condition.speed = std::isnan(speed) ? 0.0 : speed;
  return condition;
}

std::optional<PressCondition> read_condition(const fs::path& folder, FolderReader& reader) {
  for (const char* name : {"finished.json", "unfinished.json"}) {
    const JsonEntry note = reader.json(folder / name);
    if (!note.contains("inputs")) continue;
    return reader.attempt([&]() -> std::optional<PressCondition> {
      return condition_of(object_if_any(note, "inputs"));
    });
  }
  return {};
}

std::vector<ConditionDifference> differences(const PressCondition& press,
                                             const PressCondition& other) {
  std::vector<ConditionDifference> found;
  if (differ(press.contact, other.contact))
    found.push_back({fmt::format("contact: {}, not {}", press.contact, other.contact), true});
  tell_shapes(press, other, found);
  if (press.obstacle != other.obstacle) found.push_back({"another obstacle", true});
  for (const Number& number : numbers) tell_if_different(press, other, number, found);
  if (differ(press.strain, other.strain))
    found.push_back({fmt::format("{} strain, not {}", press.strain, other.strain), false});
  if (differ(press.speed, other.speed))
    found.push_back({fmt::format("{}, not {}", moved(press.speed), moved(other.speed)), false});
  return found;
}

std::optional<ComparisonRemark> remark_on(const std::string& press_name,
                                          const std::optional<PressCondition>& press,
                                          const std::string& other_name,
                                          const std::optional<PressCondition>& other) {
  if (!press || !other) {
    return ComparisonRemark{
        fmt::format("How {} was pressed is not known (no finished.json): "
                    "whether it is the same problem as {} cannot be told.",
                    press ? other_name : press_name, press ? press_name : other_name)};
  }
  const std::vector<ConditionDifference> found = differences(*press, *other);
  if (found.empty()) return {};
  ComparisonRemark remark;
  std::string list;
  for (const ConditionDifference& difference : found) {
    list += (list.empty() ? "" : "; ") + difference.what;
    remark.meaningless = remark.meaningless || difference.other_problem;
  }
  remark.text =
      remark.meaningless
          ? fmt::format(
                "{} and {} are not the same problem ({}): the percentages between them are "
                "no errors of either model.",
                press_name, other_name, list)
          : fmt::format("{} differs from {} ({}): that is part of the percentages.", press_name,
                        other_name, list);
  return remark;
}

}  // namespace fingertip::studies::inline files
