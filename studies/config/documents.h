/// Everything that is written from the key table: template, explanations, schema, reference page,
/// and the resolved parameters.toml of a run.
#pragma once

#include <string>

#include "studies/config/keys/key_table.h"
#include "studies/config/loader.h"

namespace fingertip::studies::inline config {

/// A commented TOML file with every key at its default (verb `init`).
std::string config_template();

/// One key: help, kind and unit, allowed values, default (verb `explain KEY`).
std::string explanation(const Key& key);

/// All keys, one line each, by section (verb `explain`).
std::string key_overview();

/// JSON Schema (draft 2020-12) of a configuration file.
std::string json_schema();

/// Markdown reference page.
std::string markdown_reference();

/// parameters.toml: every key with its value as given or its default, the SI value and its origin
/// in comments. Loading it gives the same Config. `head` is put in front as a comment.
std::string parameters_toml(const LoadedConfig& loaded, const std::string& head);

}  // namespace fingertip::studies::inline config
