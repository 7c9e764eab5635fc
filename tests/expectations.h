/// What tests expect of words and of refusals.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "meshes/base/errors.h"

/// One or several parts of a text.
struct Parts : std::vector<std::string> {
  Parts(const char* part) : vector({part}) {}
  Parts(const std::string& part) : vector({part}) {}
  Parts(std::initializer_list<std::string> parts) : vector(parts) {}
  Parts(const std::vector<std::string>& parts) : vector(parts) {}
};

/// Whether the text has every one of the parts.
inline testing::AssertionResult says(const std::string& text, const Parts& parts) {
  for (const std::string& part : parts)
    if (text.find(part) == text.npos)
      return testing::AssertionFailure() << "no \"" << part << "\" in\n" << text;
  return testing::AssertionSuccess();
}

/// Whether it has none of them.
inline testing::AssertionResult omits(const std::string& text, const Parts& parts) {
  for (const std::string& part : parts)
    if (text.find(part) != text.npos)
      return testing::AssertionFailure() << '"' << part << "\" in\n" << text;
  return testing::AssertionSuccess();
}

/// What an `Error` says that the action throws; empty where it throws none.
template <typename Error = fingertip::meshes::InvalidInput>
std::string refusal(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Whether the action throws an `Error` that says every one of the parts.
template <typename Error = fingertip::meshes::InvalidInput>
testing::AssertionResult refuses(const auto& action, const Parts& parts) {
  return says(refusal<Error>(action), parts);
}

/// As EXPECT_THROW, and that the error says so.
#define EXPECT_THROW_SAYING(statement, Error, parts) \
  EXPECT_TRUE(::refuses<Error>([&] { statement; }, parts))
