/// Structs as JSON objects, by the names that fields.h gives their members.
///
/// Members are numbers, texts, true or false, std::optional (null), std::vector (a list), std::map
/// (an object of equal entries), structs with a table of their own, and JSON passed on as it is.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

#include "meshes/fields.h"
#include "meshes/files.h"

namespace fingertip::meshes {

template <typename Value>
concept HasFields = requires {
  fields_of(static_cast<const Value*>(nullptr));
};
template <typename Value>
inline constexpr bool is_optional = false;
template <typename Value>
inline constexpr bool is_optional<std::optional<Value>> = true;
template <typename Value>
inline constexpr bool is_list = false;
template <typename Value>
inline constexpr bool is_list<std::vector<Value>> = true;
template <typename Value>
inline constexpr bool is_map = false;
template <typename Value>
inline constexpr bool is_map<std::map<std::string, Value>> = true;

/// Calls use(field) for each field of a struct.
template <typename Struct, typename Use>
void for_each_field(const Use& use) {
  std::apply([&](const auto&... field) { (use(field), ...); }, fields<Struct>());
}

/// Whether a value is told at all where it is there only if known.
template <typename Value>
bool is_known(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>)
    return std::isfinite(value);
  else if constexpr (is_optional<Value>)
    return value.has_value();
  else if constexpr (requires { value.empty(); })
    return !value.empty();
  else
    return true;
}

/// A value as JSON: null for what is unknown.
template <typename Value>
nlohmann::ordered_json json_of(const Value& value) {
  using nlohmann::ordered_json;
  if constexpr (HasFields<Value>) {
    ordered_json object = ordered_json::object();
    for_each_field<Value>([&](const auto& field) {
      const auto& own = std::invoke(field.member, value);
      if (std::invoke(field.when, value) && (field.presence != Presence::if_known || is_known(own)))
        object[std::string(field.name)] = json_of(own);
    });
    return object;
  } else if constexpr (is_optional<Value>) {
    return value ? json_of(*value) : ordered_json();
  } else if constexpr (is_list<Value>) {
    ordered_json list = ordered_json::array();
    for (const auto& one : value) list.push_back(json_of(one));
    return list;
  } else if constexpr (is_map<Value>) {
    ordered_json object = ordered_json::object();
    for (const auto& [name, one] : value) object[name] = json_of(one);
    return object;
  } else if constexpr (std::is_enum_v<Value>) {
    return std::string(name(value));
  } else if constexpr (std::is_floating_point_v<Value>) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json();
  } else {
    return value;
  }
}

/// Writes the struct atomically. Names of files need not be UTF-8, JSON must.
template <typename Struct>
void write_json_file(const Struct& content, const std::filesystem::path& file) {
  const std::string text =
      json_of(content).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  write_atomically(file, [&](std::ostream& out) { out << text << '\n'; });
}

}  // namespace fingertip::meshes
