/// Reading what is left of a damaged run folder.
#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/csv_table.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/read_fields.h"

namespace fingertip::studies::inline files {

/// Reads files of run folders and notes those that are damaged, so that the rest can be read. An
/// absent file gives an empty result, which is no damage: no run has every file.
class FolderReader {
 public:
  meshes::CsvTable csv(const std::filesystem::path& file);
  JsonEntry json(const std::filesystem::path& file);
  /// The rows of a table, none where one of its columns is missing or damaged.
  template <typename Row>
  std::vector<Row> rows(const std::filesystem::path& file) {
    return attempt([&] { return meshes::rows_of<Row>(csv(file)); });
  }
  /// The struct in a JSON object, as far as it is whole; each fault is noted.
  template <typename Struct>
  Struct take(const JsonEntry& entry) {
    Struct result;
    std::vector<meshes::Violation> wrong;
    if (!entry.empty()) read_value(entry, result, wrong);
    for (const meshes::Violation& violation : wrong) note(meshes::InvalidInput(violation));
    return result;
  }
  /// A press's or continuum's response.csv. Missing columns are noted, the others read.
  meshes::PressResponse response(const std::filesystem::path& file);
  std::string text(const std::filesystem::path& file);

  /// Notes files that the job in `folder` had written, by its finished.json, and that are gone.
  void note_missing(const std::filesystem::path& folder);

  /// What `make` gives; an empty value of its type when it meets damage, which is noted.
  template <typename Make>
  auto attempt(const Make& make) -> decltype(make()) {
    try {
      return make();
    } catch (const meshes::InvalidInput& error) {
      note(error);
      if constexpr (!std::is_void_v<decltype(make())>) return {};
    }
  }

  /// What is wrong with the files met so far, each thing once.
  const std::vector<meshes::Violation>& damage() const { return damage_; }
  /// Throws InvalidInput with all damage, if there is any.
  void throw_if_damaged() const;

 private:
  void note(const meshes::InvalidInput& error);
  std::vector<meshes::Violation> damage_;
};

}  // namespace fingertip::studies::inline files
