#include "studies/files/press_condition.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// Of numbers that went through a file as text.
constexpr double rounding = 1e-9;

struct Number {
  const char* name;
  double PressCondition::*value;
  double factor;  ///< from SI to the unit that is shown
  const char* unit;
};

/// Those that make another problem of it when they differ.
constexpr Number numbers[] = {
    {"friction", &PressCondition::friction, 1.0, ""},
    {"tip radius", &PressCondition::tip_radius, 1e3, " mm"},
    {"rod radius", &PressCondition::rod_radius, 1e3, " mm"},
    {"sleeve length", &PressCondition::sleeve_length, 1e3, " mm"},
    {"rod length", &PressCondition::rod_length, 1e3, " mm"},
    {"Young's modulus", &PressCondition::youngs_modulus, 1e-3, " kPa"},
    {"shear modulus", &PressCondition::shear_modulus, 1e-3, " kPa"},
    {"tilt", &PressCondition::tilt, 180.0 / std::numbers::pi, " deg"},
    {"lateral motion on the way down", &PressCondition::lateral, 1e3, " mm"}};

bool differ(double a, double b) {
  return std::abs(a - b) > rounding * std::max(std::abs(a), std::abs(b));
}

bool differ(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && a != b;
}

std::string moved(double speed) {
  return speed > 0.0 ? fmt::format("pressed at {:.4g} mm/s", 1e3 * speed) : "in equilibrium";
}

}  // namespace

PressCondition condition_of(const JsonEntry& inputs) {
  PressCondition condition;
  const JsonEntry geometry = object_at(inputs, "geometry"), rubber = object_at(inputs, "rubber");
  condition.tip_radius = number_at(geometry, "tip_radius");
  condition.rod_radius = number_at(geometry, "rod_radius");
  condition.sleeve_length = number_at(geometry, "sleeve_length");
  condition.rod_length = number_at(geometry, "rod_length");
  condition.youngs_modulus = number_at(rubber, "youngs_modulus");
  condition.shear_modulus = number_at(rubber, "shear_modulus");
  // A lattice keeps its press apart, the continuum does not.
  const bool lattice = inputs.contains("lattice");
  const JsonEntry press = lattice ? object_at(inputs, "protocol") : inputs;
  const std::string strain =
      lattice ? text_at(object_at(inputs, "lattice"), "kinematics") : text_at(inputs, "strain");
  condition.strain = strain == "linear" ? "small" : strain;
  condition.contact = text_at(press, "contact");
  condition.friction = number_at(press, "friction");
  condition.tilt = number_at(press, "tilt");
  condition.lateral = text_at(press, "lateral_path") == "after" ? 0.0 : number_at(press, "lateral");
  const double speed = number_at(press, "speed");
  condition.speed = std::isnan(speed) ? 0.0 : speed;
  return condition;
}

std::optional<PressCondition> read_condition(const fs::path& folder, FolderReader& reader) {
  for (const char* name : {"finished.json", "unfinished.json"}) {
    const JsonEntry note = reader.json(folder / name);
    if (!note.contains("inputs")) continue;
    return reader.attempt(
        [&]() -> std::optional<PressCondition> { return condition_of(object_at(note, "inputs")); });
  }
  return {};
}

std::vector<ConditionDifference> differences(const PressCondition& press,
                                             const PressCondition& other) {
  std::vector<ConditionDifference> found;
  if (differ(press.contact, other.contact))
    found.push_back({fmt::format("contact: {}, not {}", press.contact, other.contact), true});
  for (const Number& number : numbers) {
    const double a = press.*number.value, b = other.*number.value;
    if (!differ(a, b)) continue;
    found.push_back({fmt::format("{}: {:.4g}{u}, not {:.4g}{u}", number.name, number.factor * a,
                                 number.factor * b, fmt::arg("u", number.unit)),
                     true});
  }
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
  for (const ConditionDifference& one : found) {
    list += (list.empty() ? "" : "; ") + one.what;
    remark.meaningless = remark.meaningless || one.other_problem;
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

}  // namespace fingertip::studies
