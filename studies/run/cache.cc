#include "studies/run/cache.h"

#include <unistd.h>

#include <cstdlib>

#include "studies/run/digest.h"
#include "studies/run/json_file.h"
#include "studies/run/result_files.h"

namespace fingertip::studies {

namespace fs = std::filesystem;

std::string Job::key() const {
  return sha256(kind + "\n" + inputs.dump() + "\n" + source_hash);
}

namespace {

/// An entry of the file `note` when that one is about `job`, else nothing.
std::string noted(const Job& job, const fs::path& note, const char* entry) {
  if (!fs::exists(note)) return {};
  try {
    const auto content = read_json(note);
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
  write_json({{"kind", job.kind},
              {"key", job.key()},
              {"source_hash", job.source_hash},
              {"inputs", job.inputs}},
             folder / attempt_name);
}

void mark(const Job& job, const fs::path& folder, const std::string& status, double wall_time) {
  write_json({{"kind", job.kind},
              {"status", status},
              {"key", job.key()},
              {"source_hash", job.source_hash},
              {"wall_time", wall_time},
              {"inputs", job.inputs},
              {"files", result_digests(folder)}},
             folder / marker_name);
  fs::remove(folder / attempt_name);
}

bool is_run_file(const fs::path& file) {
  const fs::path name = file.filename();
  return name == "parameters.toml" || name == "manifest.json" || name == "log.txt" ||
         name.string().front() == '.';
}

fs::path Cache::default_folder() {
  const char* const xdg = std::getenv("XDG_CACHE_HOME");
  if (xdg != nullptr && *xdg != '\0') return fs::path(xdg) / "fingertip";
  const char* const home = std::getenv("HOME");
  if (home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "fingertip";
  return fs::temp_directory_path() / "fingertip-cache";
}

fs::path Cache::entry(const Job& job) const {
  return folder_ / (job.kind + "-" + job.key());
}

bool Cache::holds(const Job& job) const {
  return !noted(job, entry(job) / marker_name, "status").empty();
}

bool Cache::fetch(const Job& job, const fs::path& target) const {
  const fs::path source = entry(job);
  std::error_code failed;
  if (!holds(job)) return false;
  fs::create_directories(target, failed);
  constexpr auto how = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
  for (const auto& item : fs::directory_iterator(source, failed)) {
    if (item.path().filename() == marker_name) continue;
    fs::copy(item.path(), target / item.path().filename(), how, failed);
    if (failed) return false;
  }
  fs::copy_file(source / marker_name, target / marker_name, fs::copy_options::overwrite_existing,
                failed);
  return !failed;
}

bool Cache::store(const Job& job, const fs::path& source) const {
  std::error_code failed;
  fs::create_directories(folder_, failed);
  const fs::path target = entry(job);
  fs::path temporary = target;
  temporary += ".part" + std::to_string(::getpid());
  fs::remove_all(temporary, failed);
  fs::create_directory(temporary, failed);
  for (const auto& item : fs::directory_iterator(source, failed)) {
    if (is_run_file(item.path())) continue;
    fs::copy(item.path(), temporary / item.path().filename(), fs::copy_options::recursive, failed);
    if (failed) break;
  }
  if (!failed) {
    std::error_code ignored;
    fs::remove_all(target, ignored);  // left from a damaged entry
    fs::rename(temporary, target, failed);
  }
  const bool stored = !failed;
  fs::remove_all(temporary, failed);
  return stored;
}

}  // namespace fingertip::studies
