/// Whether the files of a finished job are what it wrote.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

namespace fingertip::studies::inline jobs {

/// Written last into a job's folder: its presence with the right key says that the job is done.
inline constexpr const char* marker_name = "finished.json";

/// Written first: names the job that is, or was when it ended early, at work in a folder.
inline constexpr const char* attempt_name = "unfinished.json";

/// What belongs to the run itself: parameters.toml, manifest.json, log.txt, what is made of the
/// job's files and settings beside its own (taxels.csv, contact/), and hidden files.
bool is_run_file(const std::filesystem::path& file);

/// Every file of the job in `folder` by its name there, with its SHA-256; without what belongs to
/// the run (is_run_file) and the markers. An entry of the marker finished.json.
nlohmann::ordered_json result_digests(const std::filesystem::path& folder);

/// The first file that is missing or not as it was when `folder` was marked, the marker itself when
/// that is damaged or tells no digests; empty when all is well or nothing was marked.
std::string damaged_result(const std::filesystem::path& folder);

/// Whether `folder` holds the files that its marker tells of, as they were, and no others. Throws
/// InvalidInput for a damaged marker.
bool is_whole_result(const std::filesystem::path& folder);

/// The marker of `folder`. Throws InvalidInput where it is not as it was written.
nlohmann::ordered_json read_marker(const std::filesystem::path& folder);

/// Writes it, with a digest of its own.
void write_marker(nlohmann::ordered_json marker, const std::filesystem::path& folder);

/// Has the marker know a file of the finished job in `folder` that has been written anew.
void mark_rewritten(const std::filesystem::path& folder, const std::string& name);

/// Writes a JSON file anew and marks it.
void rewrite_result(const std::filesystem::path& folder, const std::string& name,
                    const nlohmann::ordered_json& content);

}  // namespace fingertip::studies::inline jobs
