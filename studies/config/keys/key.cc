#include "studies/config/keys/key.h"

#include "meshes/base/files.h"

namespace fingertip::studies::inline config::inline keys {

std::string Key::description() const {
  switch (kind) {
    case Kind::quantity: return "quantity";
    case Kind::quantities: return "list of quantities";
    case Kind::number: return "number";
    case Kind::terms:
      return number_first ? "list of pairs of a number and a quantity"
                          : "list of pairs of a quantity and a number";
    case Kind::stages:
      return "list of stages: [indentation, speed], [hold, duration], [lateral, displacement, "
             "speed] or [twist, angle, speed]";
    case Kind::numbers: return "list of 3 numbers";
    case Kind::number_pair: return "list of 2 numbers";
    case Kind::integer: return "integer";
    case Kind::boolean: return "true or false";
    case Kind::choice: return "word";
    case Kind::source: return "word or path";
    case Kind::text: return "text";
    case Kind::file: return "path";
    case Kind::texts: return "list of texts";
    case Kind::files: return "list of paths";
    case Kind::fields: return or_file ? "table or path" : "table";
  }
  return "";
}

bool Key::takes_list() const {
  using enum Kind;
  for (const Kind list : {quantities, terms, stages, numbers, number_pair, texts, files})
    if (kind == list) return true;
  return false;
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
  if (kind == Kind::source || or_file) text += " | path of a file";
  if (or_file) text += " | table";
  for (const std::string& other : {pattern, word})
    if (!other.empty()) text += (text.empty() ? "or " : ", or ") + other;
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
      {"sensor", "Taxels on the finger, and markers, whose displacements are told"},
      {"grasp", "Two fingers that lift a rigid block, with press.contact, press.friction"},
      {"reference", "The continuum (finite elements)"},
      {"calibration", "How spring constants are fitted"},
      {"exchange", "An undamped lattice for another program (export --format lammps)"},
      {"run", "How to compute"},
  };
  return all;
}

}  // namespace fingertip::studies::inline config::inline keys
