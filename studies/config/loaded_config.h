/// A checked Config that remembers where every value came from.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/material/material.h"
#include "meshes/base/errors.h"
#include "studies/config/keys/config.h"

namespace fingertip::studies::inline config {

/// What is wrong with a configuration: all of it, with its places.
using ConfigError = meshes::InvalidInput;

/// Entry::place of a default.
inline constexpr const char* default_place = "default";

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

  /// Violations reported by a library with their place and the user's own spelling; those that have
  /// a place keep it.
  ConfigError locate(const std::vector<meshes::Violation>& violations) const;
};

/// What is wrong with the file that `key` names.
ConfigError refused_file(const LoadedConfig& loaded, const std::string& key,
                         const meshes::InvalidInput& error);

/// The one key that breaks a rule, with its place; `value` stands where the key is unknown.
ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy);

}  // namespace fingertip::studies::inline config
