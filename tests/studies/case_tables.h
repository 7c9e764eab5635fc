/// Case files that a test writes, and what is said against them.
#pragma once

#include <string>

#include "studies/cases/case_file.h"
#include "studies/cases/validation.h"
#include "tests/temporary_folder.h"

/// The case whose table [case] ends with `table`, after a press of two samples.
inline fingertip::studies::Case case_with(const TemporaryFolder& folder, const std::string& table) {
  write_text(folder / "case.toml",
             "[press]\nsamples = [\"0.1 cm\", \"0.2 cm\"]\n[case]\ntitle = \"t\"\n" + table);
  return fingertip::studies::load_case(folder / "case.toml", {});
}

/// What is said against that case; empty when it is a good one.
inline std::string refusal(const TemporaryFolder& folder, const std::string& table) {
  try {
    check_case(case_with(folder, table));
  } catch (const fingertip::studies::ConfigError& error) {
    return error.what();
  }
  return {};
}

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}
