/// What earlier runs of `bench` measured.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace fingertip::studies::inline bench {

/// The file in `folder`, or in the cache when that is empty.
std::filesystem::path history_file(const std::filesystem::path& folder);

/// Adds one line: the run without what its single rounds measured. Makes the folder. Throws
/// std::runtime_error when it cannot be written.
void append_history(const nlohmann::ordered_json& bench, const std::filesystem::path& file);

}  // namespace fingertip::studies::inline bench
