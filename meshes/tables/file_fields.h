/// How members of a struct are called in files: one list for those who write them, those who read
/// them back, and tests.
///
///     struct Row { double time = unknown; bool held = false; std::string note; };
///     FINGERTIP_FIELDS(Row, time, held, note);
///
/// or, where the file says it otherwise,
///
///     consteval auto fields_of(const Row*) {
///       return FINGERTIP_ALL_MEMBERS(Row, time, held, note).in("s", "time").if_known("note");
///     }
///
/// A member that is not listed does not compile; FINGERTIP_MEMBERS lists some of them.
/// Results are read back long after they were written: a list says which fields a file must have.
/// Tables of such rows: table_rows.h. JSON objects: fields_json.h. An enumeration stands there by
/// the name(...) of its values(...).
#pragma once

#include <algorithm>
#include <boost/preprocessor/punctuation/remove_parens.hpp>
#include <boost/preprocessor/seq/enum.hpp>
#include <boost/preprocessor/seq/transform.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "meshes/base/names.h"

namespace fingertip::meshes::inline tables {

/// A quantity a program does not know; an empty cell in the CSV.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

enum class Presence {
  always,    ///< a file without it is damaged
  newer,     ///< always written; runs of earlier versions lack it
  if_known,  ///< written where it has a value
};

template <typename Struct, typename Member>
struct Field {
  std::string_view name;  ///< in tables perhaps with its unit, or of several columns: "x [m],y [m]"
  Member member;          ///< of the struct, or a function of it
  std::string_view unit = {};  ///< of a column
  Presence presence = Presence::always;
  bool (Struct::*when)() const = nullptr;  ///< whether a struct has it; null: every one

  /// What stands above it in the list is known then.
  bool is_in(const Struct& whole) const { return when == nullptr || (whole.*when)(); }
};

template <typename Struct, typename Member>
constexpr Field<Struct, Member> field(std::string_view name, Member member) {
  return {name, member};
}

/// The fields of a struct, and what is changed of those named in one text between blanks.
template <typename... Field>
struct Fields {
  std::tuple<Field...> all;

  constexpr explicit Fields(Field... fields) : all(fields...) {}

  consteval Fields newer(std::string_view names) const {
    return changed(names, [](auto& field) { field.presence = Presence::newer; });
  }
  consteval Fields if_known(std::string_view names) const {
    return changed(names, [](auto& field) { field.presence = Presence::if_known; });
  }
  /// There where `when` is true of the struct, and never otherwise.
  template <typename Struct>
  consteval Fields only(bool (Struct::*when)() const, std::string_view names) const {
    return changed(names, [&](auto& field) { field.when = when; });
  }
  /// Columns in this unit.
  consteval Fields in(std::string_view unit, std::string_view names) const {
    return changed(names, [&](auto& field) { field.unit = unit; });
  }
  /// In files by another name than the member's.
  consteval Fields called(std::string_view member, std::string_view name) const {
    return changed(member, [&](auto& field) { field.name = name; });
  }

 private:
  consteval Fields changed(std::string_view names, const auto& change) const {
    Fields result = *this;
    while (!names.empty()) {
      const std::string_view name = names.substr(0, names.find(' '));
      names.remove_prefix(std::min(names.size(), name.size() + 1));
      bool found = false;
      const auto change_if_meant = [&](auto& field) {
        if (field.name == name) change(field), found = true;
      };
      std::apply([&](auto&... field) { (change_if_meant(field), ...); }, result.all);
      if (!found) throw "no field has this name";
    }
    return result;
  }
};

/// `fields`; the guard names as many members as the struct has.
consteval auto guarded(auto /*guard*/, auto fields) {
  return fields;
}

#define FINGERTIP_MEMBER(r, Struct, member) \
  ::fingertip::meshes::field<Struct>(#member, &Struct::member)
#define FINGERTIP_MEMBERS(Struct, ...)           \
  ::fingertip::meshes::Fields(BOOST_PP_SEQ_ENUM( \
      BOOST_PP_SEQ_TRANSFORM(FINGERTIP_MEMBER, Struct, BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__))))
#define FINGERTIP_ALL_MEMBERS(Struct, ...)                                         \
  ::fingertip::meshes::guarded(                                                    \
      [](const Struct& whole_) { [[maybe_unused]] auto& [__VA_ARGS__] = whole_; }, \
      FINGERTIP_MEMBERS(Struct, __VA_ARGS__))
/// All but `others`, in parentheses, stand in files.
#define FINGERTIP_FIELDS_BUT(others, Struct, ...)                                        \
  consteval auto fields_of(const Struct*) {                                              \
    return ::fingertip::meshes::guarded(                                                 \
        [](const Struct& whole_) {                                                       \
          [[maybe_unused]] auto& [BOOST_PP_REMOVE_PARENS(others), __VA_ARGS__] = whole_; \
        },                                                                               \
        FINGERTIP_MEMBERS(Struct, __VA_ARGS__));                                         \
  }                                                                                      \
  static_assert(true)
#define FINGERTIP_FIELDS(Struct, ...)                  \
  consteval auto fields_of(const Struct*) {            \
    return FINGERTIP_ALL_MEMBERS(Struct, __VA_ARGS__); \
  }                                                    \
  static_assert(true)

template <typename Struct>
concept HasFields = requires {
  fields_of(static_cast<const Struct*>(nullptr));
};

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

/// Calls use(field) for each field of a struct.
template <typename Struct, typename Use>
void for_each_field(const Use& use) {
  constexpr auto fields = fields_of(static_cast<const Struct*>(nullptr));
  std::apply([&](const auto&... field) { (use(field), ...); }, fields.all);
}

}  // namespace fingertip::meshes::inline tables
