/// From a TOML node to a Value, by the kind that the key table declares.
#pragma once

#include <filesystem>
#include <string>

#include <toml++/toml.h>

#include "studies/config/keys/key_table.h"

namespace fingertip::studies::inline config {

/// Throws UnitError (rule and remedy) when the node is not what `key` declares, is not finite or
/// lies outside the key's range.
Value read_value(const Key& key, const toml::node& node);

/// Makes the files that a value of `key` names absolute, seen from the folder `base`.
void locate_files(const Key& key, const std::filesystem::path& base, Value& value);

/// The value's literal where `key` names files, now absolute; else `literal`.
std::string located_literal(const Key& key, const Value& value, const std::string& literal);

/// The node as TOML text on one line: "40 gf/cm^2" in quotes, [0.0, 0.5, 0.0], true.
std::string toml_literal(const toml::node& node);

/// The same without quotes around a single string, for messages.
std::string unquoted(const std::string& literal);

/// The default as entries have it: "1e-6" is "1e-06" there.
std::string default_literal(const Key& key);

}  // namespace fingertip::studies::inline config
