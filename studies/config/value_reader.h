/// From a TOML node to a Value, by the kind that the key table declares.
#pragma once

#include <filesystem>
#include <string>

#include <toml++/toml.h>

#include "studies/config/keys/key_table.h"
#include "studies/config/text/toml_text.h"

namespace fingertip::studies::inline config {

/// What a user has written for a key.
struct Reading {
  Value value;
  std::string literal;
};

/// The files that it names are absolute then, seen from the folder `base`. Throws UnitError (rule
/// and remedy) when the node is not what `key` declares, is not finite or lies outside the key's
/// range.
Reading read(const Key& key, const toml::node& node, const std::filesystem::path& base = {});

/// The default as entries have it: "1e-6" is "1e-06" there.
std::string default_literal(const Key& key);

}  // namespace fingertip::studies::inline config
