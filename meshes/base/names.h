/// The words by which enumerators stand in files, keys and messages: one table for an enumeration,
/// beside it,
///
///     enum class Strain { linear, finite };
///     constexpr auto names_of(Strain) {
///       return meshes::names<Strain>({{Strain::linear, "linear"}, {Strain::finite, "finite"}});
///     }
///
/// from which name() and values() follow. Other libraries name both in a using-declaration.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

namespace fingertip::meshes::inline base {

/// The table, in the order in which values() has the enumerators.
template <class Enum, std::size_t count>
constexpr auto names(const std::pair<Enum, std::string_view> (&table)[count]) {
  return std::to_array(table);
}

template <class Enum>
concept Named = std::is_enum_v<Enum> && requires(Enum value) {
  names_of(value);
};

template <Named Enum>
constexpr std::string_view name(Enum value) {
  for (const auto& [own, word] : names_of(value))
    if (own == value) return word;
  return "";
}

template <Named Enum>
constexpr auto values(Enum /*any*/) {
  constexpr auto table = names_of(Enum());
  std::array<Enum, table.size()> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = table[i].first;
  return all;
}

/// The enumerator whose name(...) is `text`, among its values(...).
template <typename Enum>
std::optional<Enum> enumerator(std::string_view text) {
  for (const Enum value : values(Enum()))
    if (name(value) == text) return value;
  return {};
}

}  // namespace fingertip::meshes::inline base
