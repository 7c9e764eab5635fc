#include "studies/jobs/run_folder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "meshes/tables/fields_json.h"
#include "source_hash.h"
#include "studies/config/asked_units.h"
#include "studies/config/documents.h"
#include "studies/jobs/digest.h"
#include "studies/jobs/fresh_folder.h"
#include "studies/jobs/provenance.h"

namespace fingertip::studies::inline jobs {

namespace {

namespace fs = std::filesystem;

/// The first file in a run folder, by which it is known.
constexpr const char* manifest_name = "manifest.json";

/// Where --force keeps the old content until the new run has got through its input.
constexpr const char* replaced_name = ".replaced";

ConfigError refusal(const fs::path& out, const std::string& rule, const std::string& remedy) {
  return ConfigError({"", "", rule, remedy, "--out " + out.string()});
}

/// Makes the folder; false when it is there already. Of several processes one makes it.
bool make(const fs::path& folder) {
  const fs::path clean = folder.has_filename() ? folder : folder.parent_path();
  if (fs::exists(clean)) return false;
  if (clean.has_parent_path()) fs::create_directories(clean.parent_path());
  return fs::create_directory(clean);
}

/// Also when its process was killed before there was a manifest.
bool is_run_folder(const fs::path& folder) {
  if (!fs::is_directory(folder)) return false;
  if (fs::exists(folder / manifest_name)) return true;
  return std::all_of(fs::directory_iterator(folder), {}, [](const fs::directory_entry& item) {
    return item.path().filename().string().starts_with(std::string(manifest_name) + ".part");
  });
}

/// Everything in `folder` whose name does not start with a dot, the manifest first.
std::vector<fs::path> content_of(const fs::path& folder) {
  std::vector<fs::path> items;
  for (const auto& item : fs::directory_iterator(folder)) {
    if (item.path().filename().string().front() != '.') items.push_back(item.path());
  }
  std::ranges::partition(items,
                         [](const fs::path& item) { return item.filename() == manifest_name; });
  return items;
}

/// Works for a folder that is the current one or a mount point, unlike renaming it. Whenever it is
/// stopped, a folder without a manifest is the one whose content is incomplete.
void put_aside(const fs::path& folder) {
  fs::create_directory(folder / replaced_name);
  for (const fs::path& item : content_of(folder))
    fs::rename(item, folder / replaced_name / item.filename());
}

void put_back(const fs::path& folder) {
  std::vector<fs::path> items = content_of(folder / replaced_name);
  std::ranges::reverse(items);
  for (const fs::path& item : items) fs::rename(item, folder / item.filename());
  fs::remove(folder / replaced_name);
}

/// Makes sure that a folder which was there is empty, or is to be resumed. True when resumed.
bool prepare(const fs::path& folder, const RunFolderOptions& options, const FileLock& lock) {
  const fs::path replaced = folder / replaced_name;
  if (fs::exists(replaced) && !fs::exists(folder / manifest_name)) {
    put_back(folder);  // a run with --force was killed before it had begun
  }
  if (!is_run_folder(folder)) {
    throw refusal(folder, "exists and is not the folder of a run (no manifest.json inside)",
                  "choose another folder; nothing has been removed");
  }
  remove_abandoned_parts(folder, lock);
  if (options.resume) return !fs::is_empty(folder);
  if (fs::exists(replaced)) {
    // A run with --force was killed: what it was to replace is still there.
    for (const fs::path& item : content_of(folder)) fs::remove_all(item);
  } else if (!fs::is_empty(folder)) {
    put_aside(folder);
  }
  return false;
}

}  // namespace

fs::path make_run_folder(const std::string& verb) {
  const std::string stem =
      fmt::format("runs/{}-{:%Y%m%d-%H%M%S}", verb, fmt::localtime(std::time(nullptr)));
  fs::path candidate = stem;
  for (int number = 2; !make(candidate); ++number) {
    candidate = stem + "-" + std::to_string(number);
  }
  return candidate;
}

class RunFolder::Log {
 public:
  explicit Log(const fs::path& file)
      : logger_("run", std::make_shared<spdlog::sinks::basic_file_sink_mt>(file.string(), false)) {
    logger_.set_pattern("%Y-%m-%dT%H:%M:%S.%e %v");
    logger_.flush_on(spdlog::level::info);
  }
  void write(const std::string& line) { logger_.info("{}", line); }

 private:
  spdlog::logger logger_;
};

RunFolder::RunFolder(const RunFolderOptions& options, const LoadedConfig& loaded,
                     const std::string& case_text)
    : path_(options.out) {
  const std::string head = fmt::format(
      "fingertip {} {}: resolved parameters, to be used again with"
      " --config",
      program_version(), options.verb);
  const std::string parameters = parameters_toml(loaded, head) + case_text;
  manifest_.program = "fingertip";
  manifest_.version = program_version();
  manifest_.verb = options.verb;
  manifest_.units = name(asked_units(loaded));
  manifest_.status = "running";
  manifest_.command_line = options.command_line;
  manifest_.started = utc_now();
  manifest_.source_hash = source_hash::everything;
  manifest_.input_hash = sha256(parameters);
  manifest_.packages = package_versions();
  manifest_.host = host_description();
  try {
    claim(options);
    meshes::write_json_file(manifest_, path_ / manifest_name);
    meshes::write_atomically(path_ / "parameters.toml",
                             [&](std::ostream& out) { out << parameters; });
    log_ = std::make_unique<Log>(path_ / "log.txt");
  } catch (const meshes::InvalidInput&) {
    throw;
  } catch (const std::exception& error) {
    std::error_code ignored;
    if (made_) fs::remove_all(path_, ignored);
    throw refusal(path_, std::string("the output folder cannot be written: ") + error.what(),
                  "choose a folder in which you may write, with space left");
  }
  log(resumed_ ? "resumed" : "started");
  for (const std::string& note : loaded.notes) log("note: " + note);
}

void RunFolder::claim(const RunFolderOptions& options) {
  if (path_.empty())
    path_ = make_run_folder(options.stem.empty() ? options.verb : options.stem), made_ = true;
  else
    made_ = make(path_);
  if (!made_ && !options.force && !options.resume) {
    throw refusal(path_, "the output folder exists already and would be overwritten",
                  "choose another folder, or say --force to replace it or --resume auto to "
                  "continue it");
  }
  lock_ = std::make_unique<FileLock>(path_);
  if (lock_->taken()) {
    throw refusal(path_, "another process is at work in the output folder",
                  "choose another folder, or wait until that one has ended");
  }
  if (!made_) resumed_ = prepare(path_, options, *lock_);
}

RunFolder::~RunFolder() {
  if (finished_) return;
  try {
    finish("failed", 1);
  } catch (const std::exception&) {
    // Nothing more can be done for this folder; the manifest keeps saying "running".
  }
}

void RunFolder::discard() {
  finished_ = true;
  log_.reset();
  const fs::path old = path_ / replaced_name;
  const bool replaced = fs::exists(old);
  for (const auto& item : fs::directory_iterator(path_)) {
    if (item.path() != old) fs::remove_all(item.path());
  }
  if (replaced) {
    put_back(path_);
  } else {
    fs::remove(path_);
  }
}

void RunFolder::log(const std::string& line) {
  log_->write(line);
}

void RunFolder::finish(const std::string& status, int exit_code, const std::string& error) {
  manifest_.status = status;
  manifest_.exit_code = exit_code;
  manifest_.finished = utc_now();
  manifest_.packages = package_versions();  // with those of a continuum that was built on the way
  manifest_.error = error;
  finished_ = true;
  log(fmt::format("{} (exit code {})", status, exit_code));
  meshes::write_json_file(manifest_, path_ / manifest_name);
  fs::remove_all(path_ / replaced_name);
}

}  // namespace fingertip::studies::inline jobs
