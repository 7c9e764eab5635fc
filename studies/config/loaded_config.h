/// A checked Config that remembers where every value came from, and what is wrong with an input.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibration/material/material.h"
#include "meshes/base/errors.h"
#include "studies/config/keys/config.h"

namespace fingertip::studies::inline config {

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

  /// Violations reported by a library as problems with their place and the user's own spelling.
  ConfigError locate(const std::vector<meshes::Violation>& violations) const;
};

/// The one key that breaks a rule, with its place; `value` stands where the key is unknown.
ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy);

}  // namespace fingertip::studies::inline config
