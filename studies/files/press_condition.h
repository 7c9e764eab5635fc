/// How a press was made, as far as its force depends on it, and in what two presses differ.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "studies/files/folder_reader.h"

namespace fingertip::studies::inline files {

/// SI. NaN and "" where a file does not tell.
struct PressCondition {
  std::string contact;  ///< "stick", "frictionless", "coulomb"
  double friction = meshes::unknown;
  std::string strain;  ///< "small" or "finite"
  double tip_radius = meshes::unknown, rod_radius = meshes::unknown;
  double sleeve_length = meshes::unknown, rod_length = meshes::unknown;
  std::string profile = "dome";  ///< or the corners of a profile, as JSON
  std::string obstacle = {};     ///< empty: a plane, or an obstacle as JSON
  double youngs_modulus = meshes::unknown, shear_modulus = meshes::unknown;
  double tilt = meshes::unknown;
  double lateral = meshes::unknown;  ///< on the way down; what follows at full depth is no matter
  double speed = 0.0;                ///< of the approach; 0 in equilibrium
};

/// From the inputs of a job of `press` or `reference`. Throws InvalidInput for damaged ones.
PressCondition condition_of(const JsonEntry& inputs);

/// Of the press in `folder`, from the inputs that its finished.json or unfinished.json keeps;
/// nothing when there is neither. Damage is noted in `reader`.
std::optional<PressCondition> read_condition(const std::filesystem::path& folder,
                                             FolderReader& reader);

/// One thing in which two presses differ.
struct ConditionDifference {
  std::string what;    ///< "contact: stick, not frictionless"
  bool other_problem;  ///< forces are then no measure of each other, whatever the models
};

/// In what `press` differs from `other`. What either does not tell counts as equal.
std::vector<ConditionDifference> differences(const PressCondition& press,
                                             const PressCondition& other);

/// What a reader of relative differences of `press` from `other` must know; empty when nothing
/// differs.
struct ComparisonRemark {
  std::string text;
  bool meaningless = false;  ///< the percentages are then no errors
};
std::optional<ComparisonRemark> remark_on(const std::string& press_name,
                                          const std::optional<PressCondition>& press,
                                          const std::string& other_name,
                                          const std::optional<PressCondition>& other);

}  // namespace fingertip::studies::inline files
