/// From files and --set texts to a checked Config that remembers where every value came from.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "studies/config/loaded_config.h"

namespace fingertip::studies::inline config {

/// What the user gave, in the order of precedence: defaults < file < sets < threads.
struct ConfigSource {
  std::filesystem::path file;          ///< TOML; empty for none
  std::vector<std::string> sets;       ///< "section.key=value"
  std::optional<std::string> threads;  ///< option --threads, as written
};

/// Reads, converts and checks. `--set` values are TOML literals when they parse as one, else the
/// bare text as a string. The table [case] of a case file is skipped here (studies/cases reads
/// it). Throws ConfigError with all problems: unreadable file, syntax, unknown section or key
/// (naming the nearest valid one), dimension, range, and the rules of specimen and protocol.
LoadedConfig load_config(const ConfigSource& source);

/// The same configuration with further --set, e.g. for a series of runs. Throws ConfigError.
LoadedConfig with_sets(const LoadedConfig& loaded, const std::vector<std::string>& further_sets);

}  // namespace fingertip::studies::inline config
