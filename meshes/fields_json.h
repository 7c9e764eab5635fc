/// Settings as JSON: an object with an entry per member, SI, enumerations by their names.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "meshes/fields.h"

namespace fingertip::meshes {

template <typename T>
struct IsOptional : std::false_type {};
template <typename T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Whether visit_fields knows the members of `T`.
template <typename T>
concept HasFields = requires(T& settings) {
  visit_fields(settings, [](const char*, auto&, const char*) {});
};

/// What is absent is null, a vector or matrix a list of its coefficients.
template <typename Json = nlohmann::ordered_json, typename T>
Json json_of(const T& value) {
  if constexpr (std::is_enum_v<T>) {
    return std::string(name(value));
  } else if constexpr (IsOptional<T>::value) {
    return value ? json_of<Json>(*value) : Json();
  } else if constexpr (requires { value.derived(); }) {  // of Eigen
    return std::vector<double>(value.data(), value.data() + value.size());
  } else if constexpr (HasFields<const T>) {
    Json object = Json::object();
    visit_fields(value, [&](const char* key, const auto& member, const char*) {
      object[key] = json_of<Json>(member);
    });
    return object;
  } else {
    return value;
  }
}

}  // namespace fingertip::meshes
