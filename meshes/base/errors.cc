#include "meshes/base/errors.h"

namespace fingertip::meshes::inline base {

namespace {

std::string joined(const std::vector<Violation>& violations) {
  std::string text;
  for (const Violation& violation : violations) {
    if (!text.empty()) text += '\n';
    text += to_string(violation);
  }
  return text;
}

}  // namespace

std::string to_string(const Violation& violation) {
  std::string text = violation.key;
  if (!violation.value.empty()) text += " = " + violation.value;
  text += ": " + violation.rule;
  if (!violation.remedy.empty()) text += "; " + violation.remedy;
  return text;
}

InvalidInput::InvalidInput(std::vector<Violation> violations)
    : std::runtime_error(joined(violations)), violations_(std::move(violations)) {}

InvalidInput::InvalidInput(Violation violation)
    : InvalidInput(std::vector<Violation>{std::move(violation)}) {}

}  // namespace fingertip::meshes::inline base
