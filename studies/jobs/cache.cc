#include "studies/jobs/cache.h"

#include <unistd.h>

#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"
#include "studies/jobs/digest.h"
#include "studies/jobs/file_lock.h"
#include "studies/jobs/result_files.h"

namespace fingertip::studies::inline jobs {

namespace fs = std::filesystem;

std::string Job::key() const {
  return sha256(kind + "\n" + inputs.dump() + "\n" + source_hash);
}

namespace {

/// An entry of the file `note` when that one is about `job`, else nothing.
std::string noted(const Job& job, const fs::path& note, const char* entry) {
  if (!fs::exists(note)) return {};
  try {
    const auto content =
        note.filename() == marker_name ? read_marker(note.parent_path()) : parse_json(note);
    return content.value("key", "") == job.key() ? content.value(entry, "") : "";
  } catch (const std::exception&) {
    return {};  // damaged: the job has to run again
  }
}

}  // namespace

std::string marked_status(const Job& job, const fs::path& folder) {
  const std::string status = noted(job, folder / marker_name, "status");
  return status.empty() || damaged_result(folder).empty() ? status : "";
}

bool attempted(const Job& job, const fs::path& folder) {
  return !noted(job, folder / attempt_name, "key").empty();
}

void mark_attempt(const Job& job, const fs::path& folder) {
  meshes::write_json_file({{"kind", job.kind},
                           {"key", job.key()},
                           {"source_hash", job.source_hash},
                           {"inputs", job.inputs}},
                          folder / attempt_name);
}

void mark(const Job& job, const fs::path& folder, const std::string& status, double wall_time) {
  write_marker({{"kind", job.kind},
                {"status", status},
                {"key", job.key()},
                {"source_hash", job.source_hash},
                {"wall_time", wall_time},
                {"inputs", job.inputs},
                {"files", result_digests(folder)}},
               folder);
  fs::remove(folder / attempt_name);
}

fs::path Cache::entry(const Job& job) const {
  return folder_ / (job.kind + "-" + job.key());
}

void Cache::tidy() const {
  remove_abandoned_parts(folder_);
}

bool Cache::fetch(const Job& job, const fs::path& target) const {
  const fs::path source = entry(job);
  std::error_code failed;
  fs::remove_all(target, failed);
  if (!fs::is_regular_file(source / marker_name, failed)) return false;
  fs::copy(source, target, fs::copy_options::recursive, failed);
  // What is checked is what was copied: another process may replace the entry meanwhile.
  const bool sound =
      !failed && !noted(job, target / marker_name, "status").empty() && is_whole_result(target);
  std::error_code ignored;
  if (!sound) fs::remove_all(target, ignored);
  return sound;
}

bool Cache::store(const Job& job, const fs::path& source) const {
  std::error_code failed, ignored;
  fs::create_directories(folder_, failed);
  const fs::path target = entry(job);
  // Threads of one process may store equal jobs at a time.
  const auto temporary = [&](const char* role) {
    return fs::path(target.string() + role + ".part" + std::to_string(::gettid()));
  };
  const fs::path made = temporary(""), replaced = temporary(".old");
  fs::remove_all(made, failed);
  fs::create_directory(made, failed);
  for (const auto& item : fs::directory_iterator(source, failed)) {
    if (is_run_file(item.path())) continue;
    fs::copy(item.path(), made / item.path().filename(), fs::copy_options::recursive, failed);
    if (failed) break;
  }
  if (!failed) {
    fs::rename(target, replaced, ignored);  // of a damaged entry, or of another process
    fs::rename(made, target, failed);
  }
  const bool stored = !failed && fs::exists(target, ignored);
  for (const fs::path& left : {made, replaced}) fs::remove_all(left, ignored);
  return stored;
}

}  // namespace fingertip::studies::inline jobs
