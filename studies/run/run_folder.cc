#include "studies/run/run_folder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/spdlog.h>

#include <ctime>

#include "meshes/files.h"
#include "source_hash.h"
#include "studies/config/documents.h"
#include "studies/run/digest.h"
#include "studies/run/fresh_folder.h"
#include "studies/run/json_file.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// Where --force keeps the old content until the new run has got through its input.
constexpr const char* replaced_name = ".replaced";

ConfigError refusal(const fs::path& out, const std::string& rule, const std::string& remedy) {
  return ConfigError({{"--out " + out.string(), "", "", rule, remedy}});
}

bool is_run_folder(const fs::path& folder) {
  return fs::is_directory(folder) && (fs::is_empty(folder) || fs::exists(folder / "manifest.json"));
}

/// Moves everything in `folder` whose name does not start with a dot into `target` inside it, or
/// back. Works for a folder that is the current one or a mount point, unlike renaming it.
void move_content(const fs::path& from, const fs::path& to) {
  std::vector<fs::path> items;
  for (const auto& item : fs::directory_iterator(from)) {
    if (item.path().filename().string().front() != '.') items.push_back(item.path());
  }
  for (const fs::path& item : items) fs::rename(item, to / item.filename());
}

/// Makes sure that a new or empty folder (or one to be resumed) is there. True when resumed.
bool prepare(const fs::path& folder, const RunFolderOptions& options) {
  if (fs::exists(folder)) {
    if (!options.force && !options.resume) {
      throw refusal(folder, "the output folder exists already and would be overwritten",
                    "choose another folder, or say --force to replace it or --resume auto to "
                    "continue it");
    }
    if (!is_run_folder(folder)) {
      throw refusal(folder, "exists and is not the folder of a run (no manifest.json inside)",
                    "choose another folder; nothing has been removed");
    }
    if (options.resume) return !fs::is_empty(folder);
    if (!fs::is_empty(folder)) {
      fs::create_directory(folder / replaced_name);
      move_content(folder, folder / replaced_name);
    }
    return false;
  }
  fs::create_directories(folder);
  return false;
}

}  // namespace

fs::path fresh_run_folder(const std::string& verb) {
  const std::string stem =
      fmt::format("runs/{}-{:%Y%m%d-%H%M%S}", verb, fmt::localtime(std::time(nullptr)));
  fs::path candidate = stem;
  for (int number = 2; fs::exists(candidate); ++number) {
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
    : path_(options.out.empty() ? fresh_run_folder(options.verb) : options.out) {
  const std::string head = fmt::format(
      "fingertip {} {}: resolved parameters, to be used again with"
      " --config",
      program_version(), options.verb);
  const std::string parameters = parameters_toml(loaded, head) + case_text;
  manifest_ = {{"program", "fingertip"},
               {"version", program_version()},
               {"verb", options.verb},
               {"status", "running"},
               {"command_line", options.command_line},
               {"started", utc_now()},
               {"finished", nullptr},
               {"source_hash", source_hash::everything},
               {"input_hash", sha256(parameters)},
               {"packages", package_versions()},
               {"host", host_description()}};
  try {
    resumed_ = prepare(path_, options);
    meshes::write_atomically(path_ / "parameters.toml",
                             [&](std::ostream& out) { out << parameters; });
    write_json(manifest_, path_ / "manifest.json");
    log_ = std::make_unique<Log>(path_ / "log.txt");
  } catch (const ConfigError&) {
    throw;
  } catch (const std::exception& error) {
    throw refusal(path_, std::string("the output folder cannot be written: ") + error.what(),
                  "choose a folder in which you may write, with space left");
  }
  log(resumed_ ? "resumed" : "started");
  for (const std::string& note : loaded.notes) log("note: " + note);
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
    move_content(old, path_);
    fs::remove(old);
  } else {
    fs::remove(path_);
  }
}

void RunFolder::log(const std::string& line) {
  log_->write(line);
}

void RunFolder::finish(const std::string& status, int exit_code,
                       const nlohmann::ordered_json& further) {
  manifest_["status"] = status;
  manifest_["exit_code"] = exit_code;
  manifest_["finished"] = utc_now();
  manifest_.update(further);
  finished_ = true;
  log(fmt::format("{} (exit code {})", status, exit_code));
  write_json(manifest_, path_ / "manifest.json");
  fs::remove_all(path_ / replaced_name);
}

}  // namespace fingertip::studies
