/// VTK's XML files read back without the code that wrote them.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

inline std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = (bits << 6U) | unsigned(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += char((bits >> count) & 0xFFU);
  }
  return bytes;
}

/// The text from `from`, exclusive, to the next `to`.
inline std::string between(const std::string& text, const std::string& from,
                           const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return {};
  const std::size_t start = begin + from.size();
  return text.substr(start, text.find(to, start) - start);
}

template <class Number>
std::vector<Number> array_of(const std::string& piece, const std::string& name) {
  const std::string element = between(piece, "Name=\"" + name + "\"", "</DataArray>");
  const std::string bytes = decoded(element.substr(element.find('>') + 1));
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), sizeof(size));
  EXPECT_EQ(size, bytes.size() - sizeof(size)) << name;
  std::vector<Number> numbers(size / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data() + sizeof(size), size);
  return numbers;
}

inline std::vector<std::string> pieces_of(const std::string& file) {
  std::vector<std::string> pieces;
  for (std::size_t at = file.find("<Piece"); at != std::string::npos;
       at = file.find("<Piece", at + 1))
    pieces.push_back(file.substr(at, file.find("</Piece>", at) - at));
  return pieces;
}
