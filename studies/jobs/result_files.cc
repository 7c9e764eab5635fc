#include "studies/jobs/result_files.h"

#include <map>

#include "meshes/base/errors.h"
#include "meshes/base/text_file.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"
#include "studies/jobs/digest.h"

namespace fingertip::studies::inline jobs {

namespace fs = std::filesystem;

namespace {

constexpr const char* files_entry = "files";  ///< of the marker
constexpr const char* seal = "digest";        ///< of the marker without it

bool is_marker(const fs::path& file) {
  return file.filename() == marker_name || file.filename() == attempt_name;
}

}  // namespace

bool is_run_file(const fs::path& file) {
  const fs::path name = file.filename();
  return name == "parameters.toml" || name == "manifest.json" || name == "log.txt" ||
         name == "real_time.json" || name == "taxels.csv" || name == "contact" || name.string().front() == '.';
}

nlohmann::ordered_json result_digests(const fs::path& folder) {
  std::map<std::string, std::string> found;
  for (fs::recursive_directory_iterator item(folder), end; item != end; ++item) {
    if (item.depth() == 0 && (is_run_file(item->path()) || is_marker(item->path()))) {
      item.disable_recursion_pending();
    } else if (item->is_regular_file()) {
      const fs::path name = fs::relative(item->path(), folder);
      found[name.generic_string()] = sha256(meshes::read_text(item->path()));
    }
  }
  return found;
}

std::string damaged_result(const fs::path& folder) {
  if (!fs::exists(folder / marker_name)) return {};
  std::string name = marker_name;
  try {
    const auto marker = read_marker(folder);
    if (!marker.contains(files_entry) || !marker[files_entry].is_object()) return name;
    for (const auto& [file, digest] : marker[files_entry].items()) {
      name = file;
      if (digest != nlohmann::ordered_json(sha256(meshes::read_text(folder / file)))) return name;
    }
  } catch (const meshes::InvalidInput&) {
    return name;
  }
  return {};
}

bool is_whole_result(const fs::path& folder) {
  return read_marker(folder).value(files_entry, nlohmann::ordered_json()) == result_digests(folder);
}

nlohmann::ordered_json read_marker(const fs::path& folder) {
  const fs::path file = folder / marker_name;
  const nlohmann::ordered_json marker = parse_json(file);
  nlohmann::ordered_json content = marker;
  if (content.is_object()) content.erase(seal);
  if (!marker.is_object() || marker.value(seal, nlohmann::ordered_json()) !=
                                 nlohmann::ordered_json(sha256(content.dump())))
    throw meshes::InvalidInput(
        {file.string(), "", "is not as it was written", "remove it: the job is then run again"});
  return marker;
}

void write_marker(nlohmann::ordered_json marker, const fs::path& folder) {
  marker.erase(seal);
  marker[seal] = sha256(marker.dump());
  meshes::write_json_file(marker, folder / marker_name);
}

void mark_rewritten(const fs::path& folder, const std::string& name) {
  auto marker = read_marker(folder);
  marker[files_entry][name] = sha256(meshes::read_text(folder / name));
  write_marker(std::move(marker), folder);
}

void rewrite_result(const fs::path& folder, const std::string& name,
                    const nlohmann::ordered_json& content) {
  meshes::write_json_file(content, folder / name);
  mark_rewritten(folder, name);
}

}  // namespace fingertip::studies::inline jobs
