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

std::string without_remedy(const Violation& violation) {
  std::string text = violation.place + (violation.place.empty() ? "" : ": ");
  if (!violation.key.empty())
    text += violation.key + (violation.value.empty() ? "" : " = " + violation.value) + ": ";
  return text + violation.rule;
}

std::string to_string(const Violation& violation) {
  return without_remedy(violation) + (violation.remedy.empty() ? "" : "; " + violation.remedy);
}

InvalidInput::InvalidInput(std::vector<Violation> violations)
    : std::runtime_error(joined(violations)), violations_(std::move(violations)) {}

InvalidInput::InvalidInput(Violation violation)
    : InvalidInput(std::vector<Violation>{std::move(violation)}) {}

}  // namespace fingertip::meshes::inline base
