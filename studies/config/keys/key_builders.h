/// How entries of the key table are written down.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "lattice/press/setup_fields.h"
#include "studies/config/keys/key.h"

namespace fingertip::studies::inline config::inline keys {

inline constexpr double endless = std::numeric_limits<double>::infinity();
inline constexpr Range positive{0.0, endless, false};
inline constexpr Range not_negative{0.0, endless, true};
inline constexpr Range any{};

/// "4e5", "0.5", "1.0": always a number with a point or an exponent.
std::string number_literal(double value);
/// "40 gf/cm^2" with its quotes, to twelve digits.
std::string quantity_literal(double value, const std::string& unit, const std::string& shown);

/// The way to a member of the configuration.
template <typename... Members>
auto at(Members... way) {
  return [way...](Config & config) -> auto& {
    return (config.*....*way);
  };
}

/// Of a member by its type: the kind of its key, ...
template <typename T>
inline constexpr Kind kind_of = std::is_same_v<T, bool>          ? Kind::boolean
                                : std::is_integral_v<T>          ? Kind::integer
                                : std::is_enum_v<T>              ? Kind::choice
                                : std::is_same_v<T, std::string> ? Kind::text
                                                                 : Kind::number;
template <typename T>
inline constexpr Kind kind_of<std::optional<T>> = kind_of<T>;
template <>
inline constexpr Kind kind_of<meshes::Vector3> = Kind::numbers;
template <>
inline constexpr Kind kind_of<std::vector<double>> = Kind::number_pair;
template <>
inline constexpr Kind kind_of<std::vector<meshes::RelaxationBranch>> = Kind::terms;
template <>
inline constexpr Kind kind_of<std::vector<meshes::PressStage>> = Kind::stages;
template <>
inline constexpr Kind kind_of<std::vector<std::string>> = Kind::texts;
template <>
inline constexpr Kind kind_of<std::filesystem::path> = Kind::source;
template <>
inline constexpr Kind kind_of<std::vector<std::filesystem::path>> = Kind::files;

/// ... how its value is written in TOML, ...
template <typename T>
std::string literal_of(const T& member) {
  if constexpr (requires { member.has_value(); }) {
    return member ? literal_of(*member) : "\"auto\"";
  } else if constexpr (std::is_same_v<T, bool>) {
    return member ? "true" : "false";
  } else if constexpr (std::is_integral_v<T>) {
    return std::to_string(member);
  } else if constexpr (std::is_floating_point_v<T>) {
    return number_literal(member);
  } else if constexpr (std::is_enum_v<T>) {
    return '"' + std::string(name(member)) + '"';
  } else if constexpr (std::is_same_v<T, meshes::RelaxationBranch>) {
    return '[' + number_literal(member.share) + ", " + quantity_literal(member.time, "s", "s") +
           ']';
  } else if constexpr (std::is_same_v<T, meshes::PressStage>) {
    if (!member.moves()) return "[\"hold\", " + quantity_literal(member.hold, "s", "s") + ']';
    if (member.move == meshes::StageMove::lateral)
      return "[\"lateral\", " + quantity_literal(member.lateral, "m", "cm") + ", " +
             quantity_literal(member.speed, "m/s", "cm/s") + ']';
    if (member.move == meshes::StageMove::twist)
      return "[\"twist\", " + quantity_literal(member.twist, "rad", "deg") + ", " +
             quantity_literal(member.speed, "rad/s", "deg/s") + ']';
    return '[' + quantity_literal(member.indentation, "m", "cm") + ", " +
           quantity_literal(member.speed, "m/s", "cm/s") + ']';
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    return '"' + (member.empty() ? "none" : member.string()) + '"';
  } else if constexpr (std::is_same_v<T, std::string>) {
    return '"' + member + '"';
  } else {
    std::string list;
    for (const auto& element : member) list += (list.empty() ? "" : ", ") + literal_of(element);
    return '[' + list + ']';
  }
}

/// ... and how it takes a value.
template <typename T>
void store(const Value& value, T& member) {
  if constexpr (requires { member.has_value(); }) {
    if (value.word == "auto") return member.reset();
    store(value, member.emplace());
  } else if constexpr (std::is_enum_v<T>) {
    // The libraries give the names, so that a choice cannot mean one thing here, another in a job's
    // file.
    member = meshes::enumerator<T>(value.word).value_or(member);
  } else if constexpr (std::is_arithmetic_v<T>) {
    member = T(value.number);
  } else if constexpr (std::is_same_v<T, meshes::Vector3>) {
    member = meshes::Vector3(value.numbers.data());
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    member = value.numbers;
  } else if constexpr (std::is_same_v<T, std::vector<meshes::RelaxationBranch>>) {
    member.clear();
    for (std::size_t i = 0; i + 1 < value.numbers.size(); i += 2)
      member.push_back({value.numbers[i], value.numbers[i + 1]});
  } else if constexpr (std::is_same_v<T, std::vector<meshes::PressStage>>) {
    member.clear();
    for (std::size_t i = 0; i + 5 < value.numbers.size(); i += 6) {
      const double* stage = &value.numbers[i];
      member.push_back(
          {stage[0], stage[1], stage[2], meshes::StageMove(stage[3]), stage[4], stage[5]});
    }
  } else if constexpr (std::is_same_v<T, std::filesystem::path>) {
    member = value.word == "none" ? "" : value.word;
  } else if constexpr (std::is_same_v<T, std::string>) {
    member = value.word;
  } else {
    member.assign(value.words.begin(), value.words.end());
  }
}

/// A key for the member that `target` finds in a Config; its default is the member's own.
template <typename Target>
Key plain(const char* section, const char* name, Range range, const char* help, Target target) {
  Config usual;
  const auto& member = target(usual);
  using Member = std::remove_cvref_t<decltype(member)>;
  Key key;
  key.section = section;
  key.name = name;
  key.kind = kind_of<Member>;
  key.preset = literal_of(member);
  key.range = range;
  if (key.preset == "\"auto\"" && key.kind != Kind::choice) key.word = "auto";
  key.help = help;
  key.assign = [target](Config& config, const Value& value) { store(value, target(config)); };
  return key;
}

/// A quantity, whose default is written in the unit `shown`.
template <typename Target>
Key quantity(const char* section, const char* name, const char* shown, const char* unit,
             Range range, const char* help, Target target) {
  Key key = plain(section, name, range, help, target);
  key.kind = Kind::quantity;
  key.unit = unit;
  if (key.word.empty()) key.preset = quantity_literal(std::stod(key.preset), unit, shown);
  return key;
}

/// An enumeration, or a boolean that is true for the second of two words.
template <typename Target>
Key choice(const char* section, const char* name, std::vector<Choice> choices, const char* help,
           Target target) {
  Key key = plain(section, name, any, help, target);
  if (key.kind == Kind::boolean) {
    const auto word = choices[1].word;
    key.preset = '"' + choices[key.preset == "true" ? 1 : 0].word + '"';
    key.assign = [assign = key.assign, word](Config& config, Value value) {
      value.number = value.word == word ? 1.0 : 0.0;
      assign(config, value);
    };
    key.kind = Kind::choice;
  }
  key.choices = std::move(choices);
  return key;
}

/// A choice that is no part of Config, so that no job can depend on it; the first is the default.
inline Key choice(const char* section, const char* name, std::vector<Choice> choices,
                  const char* help) {
  Key key;
  key.section = section;
  key.name = name;
  key.kind = Kind::choice;
  key.preset = '"' + choices.front().word + '"';
  key.choices = std::move(choices);
  key.help = help;
  key.assign = [](Config&, const Value&) {};
  return key;
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

}  // namespace fingertip::studies::inline config::inline keys
