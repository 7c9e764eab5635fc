#include "studies/config/keys/key.h"

#include "meshes/base/files.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

/// Of every kind, in the order of the enumeration.
constexpr struct {
  const char *name, *description;
} kinds[] = {{"quantity", "quantity"},
             {"quantities", "list of quantities"},
             {"number", "number"},
             {"terms", "list of pairs of a quantity and a number"},
             {"stages", "list of pairs [indentation, speed] or [hold, duration]"},
             {"numbers", "list of 3 numbers"},
             {"number_pair", "list of 2 numbers"},
             {"integer", "integer"},
             {"boolean", "true or false"},
             {"choice", "word"},
             {"source", "word or path"},
             {"text", "text"},
             {"file", "path"},
             {"texts", "list of texts"},
             {"files", "list of paths"},
             {"fields", "table"}};

}  // namespace

const char* name(Kind kind) {
  return kinds[std::size_t(kind)].name;
}

std::string Key::description() const {
  if (kind == Kind::terms && number_first) return "list of pairs of a number and a quantity";
  return kinds[std::size_t(kind)].description;
}

std::string Key::example() const {
  if (kind == Kind::quantities || kind == Kind::terms)
    return unit == "Pa" ? "2 kPa" : unit == "rad" ? "10 deg" : unit == "s" ? "0.1 s" : "0.1 cm";
  const bool quoted = preset.size() > 2 && preset.front() == '"';
  const bool default_is_quantity = quoted && preset.find(' ') != preset.npos;
  return default_is_quantity ? preset.substr(1, preset.size() - 2) : "1 " + unit;
}

std::string Key::allowed() const {
  std::string text;
  const std::string suffix = unit.empty() ? "" : " " + unit;
  const bool below = range.minimum > -std::numeric_limits<double>::infinity();
  const bool above = range.maximum < std::numeric_limits<double>::infinity();
  if (below)
    text = (range.minimum_allowed ? ">= " : "> ") + meshes::to_text(range.minimum) + suffix;
  if (above) text += (below ? " and <= " : "<= ") + meshes::to_text(range.maximum) + suffix;
  for (const Choice& choice : choices) text += (text.empty() ? "" : " | ") + choice.word;
  if (kind == Kind::source) text += " | path of a file";
  if (!word.empty()) text += (text.empty() ? "or " : ", or ") + word;
  return text;
}

const std::vector<Section>& sections() {
  static const std::vector<Section> all = {
      {"geometry", "The finger: rigid rod inside a rubber tip (paper, Fig. 1)"},
      {"rubber", "The tip's material: isotropic, at small and at large strain"},
      {"rod", "The rigid rod"},
      {"lattice", "The mass-spring model of the tip"},
      {"press", "What is done to the finger"},
      {"obstacle", "The rigid obstacle that the finger is pressed against"},
      {"controller", "The 6-degree-of-freedom controller that moves the rod in mode pid"},
      {"hardware", "Sensors and actuators between controller and rod; the defaults are perfect"},
      {"grasp", "Two fingers that lift a rigid block, with press.contact, press.friction"},
      {"reference", "The continuum (finite elements)"},
      {"calibration", "How spring constants are fitted"},
      {"exchange", "An undamped lattice for another program (export --format lammps)"},
      {"run", "How to compute"},
  };
  return all;
}

}  // namespace fingertip::studies::inline config::inline keys
