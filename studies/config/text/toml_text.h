/// Text to TOML and back.
#pragma once

#include <filesystem>
#include <string>

#include <toml++/toml.h>

namespace fingertip::studies::inline config::inline text {

/// A file as TOML; empty for what is none, of which load_config tells.
toml::table parsed_file(const std::filesystem::path& file);

/// The value of a literal, as "v"; empty for what is no literal.
toml::table parsed_literal(const std::string& text);

/// The node as TOML text on one line: "40 gf/cm^2" in quotes, [0.0, 0.5, 0.0], true.
std::string toml_literal(const toml::node& node);

/// The same without quotes around a single string, for messages.
std::string unquoted(const std::string& literal);

}  // namespace fingertip::studies::inline config::inline text
