/// Words for enumerators.
#pragma once

#include <cstddef>
#include <string_view>

namespace fingertip::meshes::inline base {

/// The word of `value`, whose enumeration counts from 0; a word for each that values() lists.
template <typename Enum, std::size_t count>
constexpr std::string_view word_of(Enum value, const char* const (&words)[count]) {
  if constexpr (requires { values(value); })
    static_assert(values(Enum()).size() == count, "a word for every value");
  return std::size_t(value) < count ? words[std::size_t(value)] : "unknown";
}

}  // namespace fingertip::meshes::inline base
