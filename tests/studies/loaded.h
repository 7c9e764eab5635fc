/// Configurations made of settings, or of a file in a folder, and what is said against them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "studies/config/loader.h"
#include "tests/expectations.h"

inline fingertip::studies::LoadedConfig config_of(std::vector<std::string> settings = {}) {
  return fingertip::studies::load_config({{}, std::move(settings), {}});
}

inline fingertip::studies::LoadedConfig config_in(const std::filesystem::path& file,
                                                  std::vector<std::string> settings = {}) {
  return fingertip::studies::load_config({file, std::move(settings), {}});
}

/// What the action is refused with as bad configuration; empty where it is not.
inline std::string config_refusal(const auto& action) {
  return refusal<fingertip::studies::ConfigError>(action);
}
