#include "studies/files/folder_reader.h"

#include <algorithm>

#include "meshes/base/text_file.h"
#include "meshes/press/press_response.h"

namespace fingertip::studies::inline files {

namespace fs = std::filesystem;

namespace {

/// Also a link that leads nowhere is there, and must not pass for a file that was never written.
bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(file, ignored));
}

}  // namespace

meshes::CsvTable FolderReader::csv(const fs::path& file) {
  if (!is_there(file)) return {};
  return attempt([&] { return meshes::read_csv(file); });
}

JsonEntry FolderReader::json(const fs::path& file) {
  if (!is_there(file)) return {};
  return attempt([&] { return read_entry(file); });
}

meshes::PressResponse FolderReader::response(const fs::path& file) {
  if (!is_there(file)) return {};
  return attempt([&] {
    const meshes::CsvTable table = meshes::read_csv(file);
    const auto missing = meshes::missing_columns<meshes::PressSample>(table);
    if (!missing.empty()) note(meshes::InvalidInput(missing));
    return meshes::PressResponse::of(table);
  });
}

std::string FolderReader::text(const fs::path& file) {
  if (!is_there(file)) return {};
  return attempt([&] { return meshes::read_text(file); });
}

void FolderReader::note_missing(const fs::path& folder) {
  const JsonEntry marker = json(folder / "finished.json");
  for (const auto& [name, digest] :
       attempt([&] { return object_if_any(marker, "files").members(); }))
    if (!is_there(folder / name))
      note(meshes::InvalidInput({(folder / name).string(), "", "is missing: the run had written it",
                                 "run again with --resume auto, which computes it anew"}));
}

void FolderReader::note(const meshes::InvalidInput& error) {
  for (const meshes::Violation& violation : error.violations()) {
    const auto same = [&](const meshes::Violation& other) {
      return to_string(other) == to_string(violation);
    };
    if (std::ranges::none_of(damage_, same)) damage_.push_back(violation);
  }
}

void FolderReader::throw_if_damaged() const {
  if (!damage_.empty()) throw meshes::InvalidInput(damage_);
}

}  // namespace fingertip::studies::inline files
