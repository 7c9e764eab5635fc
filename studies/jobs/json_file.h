/// JSON files, written atomically; to read them see studies/files/json_entry.h.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace fingertip::studies::inline jobs {

/// Throws std::runtime_error when the file cannot be written.
void write_json(const nlohmann::ordered_json& content, const std::filesystem::path& file);

/// The number, NaN for null.
double number_of(const nlohmann::ordered_json& value);

}  // namespace fingertip::studies::inline jobs
