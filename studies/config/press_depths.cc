#include "studies/config/press_depths.h"

#include <algorithm>
#include <cmath>

#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_table.h"
#include "studies/config/value_reader.h"

namespace fingertip::studies::inline config {

namespace {

/// A default gives way to the program's value, anything else must not contradict it.
void take_from_program(LoadedConfig& loaded, std::vector<meshes::Violation>& problems,
                       const char* name, const std::string& literal, const std::string& what) {
  Entry& entry = loaded.entries.at(name);
  const bool usual = !entry.given || entry.literal == default_literal(*find_key(name));
  if (!usual)
    problems.push_back({name, unquoted(entry.literal),
                        "press.program (" + loaded.entries.at("press.program").place +
                            ") says otherwise: " + what + " is " + unquoted(literal),
                        "leave " + std::string(name) + " out", entry.place});
  entry.literal = literal;
  entry.place = "press.program";
}

/// Depth, speed and samples of a program.
void resolve_program(LoadedConfig& loaded, std::vector<meshes::Violation>& problems) {
  meshes::PressProtocol& protocol = loaded.config.press.protocol;
  const meshes::PressStage& first = protocol.program.front();
  double deepest = first.indentation;
  for (const meshes::PressStage& stage : protocol.program)
    deepest = std::max(deepest, stage.indentation);
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-9 * std::abs(b); };
  if (!same(protocol.depth, deepest))
    take_from_program(loaded, problems, "press.depth", quantity_literal(deepest, "m", "cm"),
                      "the largest indentation");
  if (first.moves() && !same(protocol.speed, first.speed))
    take_from_program(loaded, problems, "press.speed", quantity_literal(first.speed, "m/s", "cm/s"),
                      "the speed of the first stage");
  protocol.depth = deepest;
  if (first.moves()) protocol.speed = first.speed;
  if (protocol.samples.empty()) {
    protocol.samples = meshes::default_samples(deepest);
  } else if (same(protocol.samples.back(), deepest)) {
    protocol.samples.back() = deepest;
  } else if (protocol.samples.back() < deepest) {
    protocol.samples.push_back(deepest);
  } else {
    const Entry& entry = loaded.entries.at("press.samples");
    problems.push_back({"press.samples", unquoted(entry.literal),
                        "some lie deeper than press.program goes",
                        "leave them out, or let the program go deeper", entry.place});
  }
}

}  // namespace

void resolve_depths(LoadedConfig& loaded, std::vector<meshes::Violation>& problems) {
  meshes::PressProtocol& protocol = loaded.config.press.protocol;
  if (!protocol.program.empty()) return resolve_program(loaded, problems);
  if (protocol.samples.empty()) {
    protocol.samples = meshes::default_samples(protocol.depth);
    return;
  }
  if (loaded.entries["press.depth"].given && protocol.depth != protocol.samples.back()) {
    loaded.notes.push_back("press.depth = " + loaded.entries["press.depth"].literal +
                           " is overridden by the largest of press.samples");
  }
  protocol.depth = protocol.samples.back();
}

}  // namespace fingertip::studies::inline config
