/// From files and --set texts to a checked Config that remembers where every value came from.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibration/material.h"
#include "meshes/errors.h"
#include "studies/config/config.h"

namespace fingertip::studies {

/// One thing that is wrong with the input, and where it was written.
struct Problem {
  std::string place;  ///< "file.toml:12", "--set rubber.density=1 m" or "default"
  std::string key;    ///< configuration key; may be empty for a file that cannot be read
  std::string value;  ///< as the user wrote it
  std::string rule;
  std::string remedy;
};

/// "place: key = value: rule; remedy"
std::string to_string(const Problem& problem);

/// The input is wrong; carries every problem found. Programs exit with 2.
class ConfigError : public std::runtime_error {
 public:
  explicit ConfigError(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// What the user gave, in the order of precedence: defaults < file < sets < threads.
struct ConfigSource {
  std::filesystem::path file;          ///< TOML; empty for none
  std::vector<std::string> sets;       ///< "section.key=value"
  std::optional<std::string> threads;  ///< option --threads, as written
};

/// Where a key's value comes from and how it was written.
struct Entry {
  std::string literal;  ///< TOML literal, e.g. "\"40 gf/cm^2\""
  std::string place;    ///< "file.toml:12", "--set ...", "--threads" or "default"
  bool given = false;   ///< false for a default
};

struct LoadedConfig {
  Config config;
  std::map<std::string, Entry> entries;  ///< by full key name; every key of the table is present
  std::vector<std::string> notes;        ///< remarks for the log, e.g. an overridden depth
  /// What the file of lattice.constants says, once somebody has read it; shared by copies.
  std::shared_ptr<std::optional<calibration::Material>> material =
      std::make_shared<std::optional<calibration::Material>>();

  /// The same configuration with one more --set, e.g. for a series of runs. Throws ConfigError.
  LoadedConfig with(const std::vector<std::string>& further_sets) const;

  /// Violations reported by a library as problems with their place and the user's own spelling.
  ConfigError locate(const std::vector<meshes::Violation>& violations) const;
};

/// Reads, converts and checks. `--set` values are TOML literals when they parse as one, else the
/// bare text as a string. The table [case] of a case file is skipped here (studies/cases reads
/// it). Throws ConfigError with all problems: unreadable file, syntax, unknown section or key
/// (naming the nearest valid one), dimension, range, and the rules of specimen and protocol.
LoadedConfig load_config(const ConfigSource& source);

}  // namespace fingertip::studies
