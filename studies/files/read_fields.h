/// Structs read back from JSON files, by the names that meshes/tables/file_fields.h gives their
/// members; they are written by meshes/tables/fields_json.h.
#pragma once

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"

namespace fingertip::studies::inline files {

using meshes::HasFields, meshes::for_each_field, meshes::is_list, meshes::is_map,
    meshes::is_optional, meshes::json_of;

/// Calls read() and collects what is wrong with the file, once per place.
template <typename Read>
void collect(std::vector<meshes::Violation>& wrong, const Read& read) {
  try {
    read();
  } catch (const meshes::InvalidInput& error) {
    wrong.insert(wrong.end(), error.violations().begin(), error.violations().end());
  }
}

/// Puts an entry into `value`. What is missing or damaged is told in `wrong` and stays as it was.
template <typename Value>
void read_value(const JsonEntry& entry, Value& value, std::vector<meshes::Violation>& wrong) {
  if constexpr (HasFields<Value>) {
    for_each_field<Value>([&](const auto& field) {
      if (!field.is_in(value)) return;
      collect(wrong, [&] {
        if (field.presence == meshes::Presence::always) entry.need(std::string(field.name));
        if (const JsonEntry own = entry.at(std::string(field.name)); own.is_there())
          read_value(own, std::invoke(field.member, value), wrong);
      });
    });
  } else if constexpr (is_optional<Value>) {
    if (entry.is_null()) {
      value = std::nullopt;
    } else {
      typename Value::value_type inner{};
      read_value(entry, inner, wrong);
      value = std::move(inner);
    }
  } else if constexpr (is_list<Value>) {
    for (const JsonEntry& element : entry.elements())
      read_value(element, value.emplace_back(), wrong);
  } else if constexpr (is_map<Value>) {
    for (const auto& [name, member] : entry.members()) read_value(member, value[name], wrong);
  } else if constexpr (std::is_enum_v<Value>) {
    const auto found = meshes::enumerator<Value>(entry.text());
    if (!found) entry.refuse("must be a word that the program writes");
    value = *found;
  } else if constexpr (std::is_same_v<Value, bool>) {
    value = entry.flag();
  } else if constexpr (std::is_integral_v<Value>) {
    value = Value(entry.whole_number());
  } else if constexpr (std::is_floating_point_v<Value>) {
    value = entry.number();
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = entry.text();
  } else {
    value = entry.content();
  }
}

/// The struct in an object. Throws InvalidInput with everything that is missing or damaged.
template <typename Struct>
Struct struct_of(const JsonEntry& entry) {
  Struct result;
  std::vector<meshes::Violation> wrong;
  read_value(entry, result, wrong);
  if (!wrong.empty()) throw meshes::InvalidInput(wrong);
  return result;
}

}  // namespace fingertip::studies::inline files
