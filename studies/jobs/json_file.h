/// JSON files: written atomically, read with a message that names the file.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace fingertip::studies::inline jobs {

/// Throws std::runtime_error when the file cannot be written.
void write_json(const nlohmann::ordered_json& content, const std::filesystem::path& file);

/// The object in a file, to be changed; to look into one see JsonEntry. Throws like parse_json.
nlohmann::ordered_json read_json(const std::filesystem::path& file);

/// The number, NaN for null.
double number_of(const nlohmann::ordered_json& value);

/// NaN and infinities, which JSON cannot hold, become null.
nlohmann::ordered_json number_or_null(double value);

}  // namespace fingertip::studies::inline jobs
