/// From a TOML node to a Value, by the kind that the key table declares.
#pragma once

#include <string>

#include <toml++/toml.h>

#include "studies/config/key_table.h"

namespace fingertip::studies {

/// Throws UnitError (rule and remedy) when the node is not what `key` declares, is not finite or
/// lies outside the key's range.
Value read_value(const Key& key, const toml::node& node);

/// The node as TOML text on one line: "40 gf/cm^2" in quotes, [0.0, 0.5, 0.0], true.
std::string toml_literal(const toml::node& node);

/// The same without quotes around a single string, for messages.
std::string unquoted(const std::string& literal);

}  // namespace fingertip::studies
