/// Structs with fields (file_fields.h) as JSON objects, SI, enumerations by their names.
///
/// Members are numbers, texts, true or false, std::optional (null), std::vector and Eigen's vectors
/// and matrices (a list of their coefficients), std::map and Entries (an object), pointers to what
/// has a digest `content()`, structs with fields of their own, and JSON passed on as it is.
#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "meshes/base/files.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline tables {

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
template <typename Value>
inline constexpr bool is_map<Entries<Value>> = true;

/// Whether a value is told at all where it is there only if known.
template <typename Value>
bool is_known(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>)
    return std::isfinite(value);
  else if constexpr (is_optional<Value>)
    return value.has_value();
  else if constexpr (requires { value.empty(); })
    return !value.empty();
  else if constexpr (requires { value->content(); })
    return value != nullptr;
  else
    return true;
}

/// A value as JSON: null for what is unknown.
template <typename Json = nlohmann::ordered_json, typename Value>
Json json_of(const Value& value) {
  if constexpr (HasFields<Value>) {
    Json object = Json::object();
    for_each_field<Value>([&](const auto& field) {
      const auto& own = std::invoke(field.member, value);
      if (field.is_in(value) && (field.presence != Presence::if_known || is_known(own)))
        object[std::string(field.name)] = json_of<Json>(own);
    });
    return object;
  } else if constexpr (is_optional<Value>) {
    return value ? json_of<Json>(*value) : Json();
  } else if constexpr (is_list<Value>) {
    Json list = Json::array();
    for (const auto& element : value) list.push_back(json_of<Json>(element));
    return list;
  } else if constexpr (is_map<Value>) {
    Json object = Json::object();
    for (const auto& [name, member] : value) object[name] = json_of<Json>(member);
    return object;
  } else if constexpr (requires { value.derived(); }) {  // of Eigen
    return std::vector<double>(value.data(), value.data() + value.size());
  } else if constexpr (requires { value->content(); }) {  // told by its digest
    return value ? Json(value->content()) : Json();
  } else if constexpr (std::is_enum_v<Value>) {
    return std::string(name(value));
  } else if constexpr (std::is_floating_point_v<Value>) {
    return std::isfinite(value) ? Json(value) : Json();
  } else {
    return value;
  }
}

/// What json_of has made of a value, for files that only programs touch; reading what people may
/// have damaged: studies/files/read_fields.h. Throws nlohmann::json::exception;
/// std::invalid_argument for a digest.
template <typename Json, typename Value>
void read_json(const Json& json, Value& value) {
  if constexpr (HasFields<Value>) {
    for_each_field<Value>([&](const auto& field) {
      const std::string name(field.name);
      const bool needed = field.presence == Presence::always && field.when == nullptr;
      if (needed || json.contains(name)) read_json(json.at(name), std::invoke(field.member, value));
    });
  } else if constexpr (is_optional<Value>) {
    value.reset();
    if (!json.is_null()) read_json(json, value.emplace());
  } else if constexpr (is_list<Value>) {
    value.clear();
    for (const Json& element : json) read_json(element, value.emplace_back());
  } else if constexpr (requires { value->content(); }) {
    if (!json.is_null()) throw std::invalid_argument("a digest does not tell what it is of");
  } else if constexpr (requires { value.derived(); }) {  // of Eigen, of fixed size
    for (std::size_t i = 0; i < std::size_t(value.size()); ++i) json.at(i).get_to(value.data()[i]);
  } else if constexpr (std::is_enum_v<Value>) {
    value = enumerator<Value>(json.template get<std::string>()).value_or(value);
  } else if constexpr (std::is_floating_point_v<Value>) {
    value = json.is_null() ? unknown : json.template get<double>();
  } else {
    json.get_to(value);
  }
}

/// Writes the struct atomically. Names of files need not be UTF-8, JSON must.
template <typename Struct = nlohmann::ordered_json>
void write_json_file(const Struct& content, const std::filesystem::path& file) {
  const std::string text =
      json_of(content).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  write_atomically(file, [&](std::ostream& out) { out << text << '\n'; });
}

}  // namespace fingertip::meshes::inline tables
