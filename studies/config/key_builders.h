/// How entries of the key table are written down.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "studies/config/key_table.h"

namespace fingertip::studies {

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr Range positive{0.0, endless, false};
inline constexpr Range not_negative{0.0, endless, true};
inline constexpr Range any{};

/// A key whose value is one quantity, stored in `member`.
template <typename Target>
Key quantity(const char* section, const char* name, const char* preset, const char* unit,
             Range range, const char* help, Target target) {
  Key key;
  key.section = section;
  key.name = name;
  key.kind = Kind::quantity;
  key.preset = "\"" + std::string(preset) + "\"";
  key.unit = unit;
  key.range = range;
  key.help = help;
  key.assign = [target](Config& config, const Value& value) { target(config) = value.number; };
  return key;
}

inline Key plain(const char* section, const char* name, Kind kind, const char* preset, Range range,
                 const char* help, std::function<void(Config&, const Value&)> assign) {
  Key key;
  key.section = section;
  key.name = name;
  key.kind = kind;
  key.preset = preset;
  key.range = range;
  key.help = help;
  key.assign = std::move(assign);
  return key;
}

inline Key choice(const char* section, const char* name, const char* preset,
                  std::vector<Choice> choices, const char* help,
                  std::function<void(Config&, const Value&)> assign) {
  const std::string literal = "\"" + std::string(preset) + "\"";
  Key key = plain(section, name, Kind::choice, literal.c_str(), any, help, std::move(assign));
  key.choices = std::move(choices);
  return key;
}

/// For a choice: stores in `target` the one of `values` that is called as the key's value says;
/// they have the names that the rooms give them, so that a choice cannot mean one thing here and
/// another in a job file.
template <typename Target, typename Enum>
auto assign_named(Target target, std::vector<Enum> values) {
  return [target, values = std::move(values)](Config& config, const Value& value) {
    for (const Enum one : values)
      if (name(one) == value.word) target(config) = one;
  };
}

inline Key with_rule(Key key, const char* rule, std::vector<std::string> related) {
  key.rule = rule;
  key.related = std::move(related);
  return key;
}

/// Elsewhere it is inert, and whoever sets it is told so.
inline Key only_with(const char* other, std::vector<std::string> words, Key key) {
  key.matters_with = other;
  key.matters_words = std::move(words);
  return key;
}

}  // namespace fingertip::studies
