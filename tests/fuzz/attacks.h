/// What the attacks on the real program have in common.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/studies/program.h"

namespace attacks {

/// The exit codes that the program may have.
bool told(int code);

/// A script for bash in `folder`, in which `fingertip` is the program that was built.
ProgramResult shell(const std::filesystem::path& folder, const std::string& script);

/// A press in equilibrium of some tenths of a second, and one in time of a second.
std::vector<std::string> static_press(const std::vector<std::string>& more = {});
std::vector<std::string> moving_press(const std::vector<std::string>& more = {});

/// `words` as bash reads them.
std::string quoted(const std::vector<std::string>& words);

/// The results in a run folder by name: all tables (.csv) and material.toml, but for columns of
/// wall time.
std::map<std::string, std::string> results_in(const std::filesystem::path& run);

/// Files below `folder` with the names of temporary ones.
std::vector<std::string> leftovers(const std::filesystem::path& folder);

/// $FINGERTIP_FUZZ_KILLS, else what this program was built for.
int wanted_kills();

}  // namespace attacks
