/// How members of a struct are called in files of results: one table for those who write them,
/// those who read them back, and tests.
///
///     struct Row { double time = unknown; bool held = false; };
///     constexpr auto fields_of(const Row*) {
///       return std::tuple{field("time [s]", &Row::time),
///                         field("held", &Row::held, Presence::newer)};
///     }
///
/// Settings with units (geometry, rubber) have visit_fields (fields.h) instead: all members,
/// always, each with its unit. Results are read back long after they were written: a table says
/// which of its members a file must have, and its names are the titles of columns.
///
/// Tables of such rows: table_rows.h. JSON objects: fields_json.h. An enumeration stands there by
/// the name(...) of its values(...).
#pragma once

#include <algorithm>
#include <boost/preprocessor/seq/for_each_i.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace fingertip::meshes::inline tables {

/// A quantity a program does not know; an empty cell in the CSV.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

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

/// Fields that are always there, their names in one text between blanks or commas.
template <typename... Member>
constexpr auto named(std::string_view names, Member... members) {
  const auto next = [&] {
    const std::string_view word = names.substr(0, names.find_first_of(", "));
    const std::size_t other = names.find_first_not_of(", ", word.size());
    names.remove_prefix(std::min(other, names.size()));
    return word;
  };
  return std::tuple{Field<Member>{next(), members}...};
}

/// named() of members by the names that they have: FINGERTIP_FIELDS(Mesh, cells, wall_time).
#define FINGERTIP_FIELDS(Struct, ...)                            \
  fingertip::meshes::named(#__VA_ARGS__ BOOST_PP_SEQ_FOR_EACH_I( \
      FINGERTIP_MEMBER, Struct, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__)))
#define FINGERTIP_MEMBER(r, Struct, i, member) , &Struct::member

/// The same fields, all of them newer, or there if known.
template <typename... Member>
constexpr auto newer(std::tuple<Field<Member>...> fields) {
  std::apply([](auto&... field) { ((field.presence = Presence::newer), ...); }, fields);
  return fields;
}
template <typename... Member>
constexpr auto if_known(std::tuple<Field<Member>...> fields) {
  std::apply([](auto&... field) { ((field.presence = Presence::if_known), ...); }, fields);
  return fields;
}

/// The same fields, always there when `when`, a member function, is true of the struct, and never
/// otherwise.
template <typename When, typename... Member>
constexpr auto only(When when, std::tuple<Field<Member>...> fields) {
  return std::apply(
      [&](const auto&... field) {
        return std::tuple{Field<Member, When>{field.name, field.member, field.presence, when}...};
      },
      fields);
}

/// The table of a struct.
template <typename Struct>
constexpr auto fields() {
  return fields_of(static_cast<const Struct*>(nullptr));
}

/// Equal entries of an object, in the order in which they are written.
template <typename Value>
struct Entries : std::vector<std::pair<std::string, Value>> {
  using mapped_type = Value;
  using std::vector<std::pair<std::string, Value>>::vector;

  /// Null when there is none of this name.
  const Value* find(std::string_view name) const {
    const auto found = std::find_if(this->begin(), this->end(),
                                    [&](const auto& entry) { return entry.first == name; });
    return found == this->end() ? nullptr : &found->second;
  }
  Value& operator[](std::string_view name) {
    if (const Value* known = find(name)) return const_cast<Value&>(*known);
    return this->emplace_back(std::string(name), Value()).second;
  }
};

template <typename Struct>
concept HasFileFields = requires {
  fields_of(static_cast<const Struct*>(nullptr));
};

/// Calls use(field) for each field of a struct.
template <typename Struct, typename Use>
void for_each_field(const Use& use) {
  std::apply([&](const auto&... field) { (use(field), ...); }, fields<Struct>());
}

/// The enumerator whose name(...) is `text`, among its values(...).
template <typename Enum>
std::optional<Enum> enumerator(std::string_view text) {
  for (const Enum value : values(Enum()))
    if (name(value) == text) return value;
  return {};
}

}  // namespace fingertip::meshes::inline tables
