/// How members of a struct are called in files: one table for those who write them, those who read
/// them back, and tests.
///
///     struct Row { double time = unknown; bool held = false; };
///     constexpr auto fields_of(const Row*) {
///       return std::tuple{field("time [s]", &Row::time),
///                         field("held", &Row::held, Presence::newer)};
///     }
///
/// Tables of such rows: table_rows.h. JSON objects: json_fields.h. An enumeration stands there by
/// the name(...) of its values, of which values_of(...) has the list.
#pragma once

#include <string_view>
#include <tuple>

namespace fingertip::meshes {

enum class Presence {
  always,    ///< a file without it is damaged
  newer,     ///< always written; runs of earlier versions lack it
  if_known,  ///< written where it has a value
};

/// For fields that every struct of their kind has.
struct InEveryCase {
  constexpr bool operator()(const auto& /*whole*/) const { return true; }
};

template <typename Member, typename When = InEveryCase>
struct Field {
  std::string_view name;  ///< with its unit in tables, "time [s]"
  Member member;          ///< of the struct, or a function from the struct to a reference
  Presence presence = Presence::always;
  When when = {};  ///< the structs that have it; what stands above it in the table is known then
};

template <typename Member>
constexpr auto field(std::string_view name, Member member, Presence presence = Presence::always) {
  return Field<Member>{name, member, presence};
}

/// Fields that are always there, their names in one text between blanks.
template <typename... Member>
constexpr auto named(std::string_view names, Member... members) {
  const auto next = [&] {
    const std::string_view word = names.substr(0, names.find(' '));
    names.remove_prefix(word.size() < names.size() ? word.size() + 1 : names.size());
    return word;
  };
  return std::tuple{Field<Member>{next(), members}...};
}

/// The same fields, all of them newer, or there if known.
template <typename... Member>
constexpr auto newer(std::tuple<Field<Member>...> fields) {
  std::apply([](auto&... one) { ((one.presence = Presence::newer), ...); }, fields);
  return fields;
}
template <typename... Member>
constexpr auto if_known(std::tuple<Field<Member>...> fields) {
  std::apply([](auto&... one) { ((one.presence = Presence::if_known), ...); }, fields);
  return fields;
}

/// The same fields, always there when `when`, a member function, is true of the struct, and never
/// otherwise.
template <typename When, typename... Member>
constexpr auto only(When when, std::tuple<Field<Member>...> fields) {
  return std::apply(
      [&](const auto&... one) {
        return std::tuple{Field<Member, When>{one.name, one.member, one.presence, when}...};
      },
      fields);
}

/// The table of a struct.
template <typename Struct>
constexpr auto fields() {
  return fields_of(static_cast<const Struct*>(nullptr));
}

/// The enumerator whose name(...) is `text`, among its values_of(...); null when there is none.
template <typename Enum>
const Enum* enumerator(std::string_view text) {
  for (const Enum& one : values_of(Enum{}))
    if (name(one) == text) return &one;
  return nullptr;
}

}  // namespace fingertip::meshes
