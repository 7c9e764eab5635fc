/// Presses made of settings alone.
#pragma once

#include "studies/presses/press_setup.h"
#include "tests/studies/loaded.h"

inline fingertip::lattice::PressSetup setup_of(std::vector<std::string> settings = {}) {
  return fingertip::studies::press_setup(config_of(std::move(settings)));
}

/// What is said against a press with these settings; empty when it is fine.
inline std::string press_refusal(const std::vector<std::string>& settings) {
  return config_refusal([&] { setup_of(settings); });
}
