#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/base/text_file.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/documents.h"
#include "studies/files/places.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view in_the_repository = "studies/examples/";
constexpr std::string_view launcher = "./fingertip";

/// A configuration to begin with: its first comment tells what it is, and then what to type.
struct Start {
  fs::path file;
  std::string text, what;
  std::vector<std::string> commands;

  explicit Start(const fs::path& toml) : file(toml), text(meshes::read_text(toml)) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line) && line.starts_with("# ");) {
      const std::string said = line.substr(line.find_first_not_of(' ', 1));
      if (said.starts_with(launcher))
        commands.push_back(said);
      else
        what += (what.empty() ? "" : " ") + said;
    }
    if (what.ends_with(':')) what.back() = '.';
  }
  std::string name() const { return file.stem().string(); }
};

/// By name.
std::vector<Start> all_starts() {
  std::vector<Start> starts;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(data_folder("examples", FINGERTIP_EXAMPLES), none))
    if (entry.path().extension() == ".toml") starts.emplace_back(entry.path());
  std::ranges::sort(starts, {}, &Start::name);
  return starts;
}

/// The text with each `from` as `to`.
std::string replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Writes files of which none may be there yet, unless --force says so.
class NewFiles {
 public:
  explicit NewFiles(const CommandLine& line) : line_(&line) {}

  void add(const fs::path& file, std::string content) {
    if (fs::exists(file) && !line_->force)
      refuse(file, "the file exists already", "choose another name, or say --force to replace it");
    files_.emplace_back(file, std::move(content));
  }
  void write() const {
    for (const auto& [file, content] : files_) {
      try {
        meshes::write_atomically(file, [&](std::ostream& out) { out << content; });
      } catch (const std::runtime_error& error) {
        refuse(file, error.what(), "choose a folder in which you may write");
      }
      if (!line_->quiet) fmt::print("written: {}\n", file.string());
    }
  }

 private:
  static void refuse(const fs::path& file, const std::string& rule, const std::string& remedy) {
    throw ConfigError({"", "", rule, remedy, "init " + file.string()});
  }

  const CommandLine* line_;
  std::vector<std::pair<fs::path, std::string>> files_;
};

void write_start(const Start& start, const CommandLine& line) {
  const fs::path file = line.out.empty() ? fs::path(start.name() + ".toml") : line.out;
  const std::string there = std::string(in_the_repository) + start.file.filename().string();
  NewFiles files(line);
  files.add(file, replaced(start.text, there, file.string()));
  // What it names.
  for (const fs::directory_entry& entry : fs::directory_iterator(start.file.parent_path())) {
    const std::string name = entry.path().filename().string();
    if (start.text.find('"' + name + '"') != start.text.npos)
      files.add(file.parent_path() / name, meshes::read_text(entry.path()));
  }
  files.write();
  if (line.quiet) return;
  const bool launched = std::getenv("FINGERTIP_LAUNCHER") != nullptr;
  for (const std::string& command : start.commands)
    fmt::print("next: {}\n", replaced(replaced(command, there, file.string()), launcher,
                                      launched ? std::string(launcher) : "fingertip"));
}

}  // namespace

int run_init(const CommandLine& line) {
  const std::vector<Start> starts = all_starts();
  if (line.list) {
    std::size_t width = 0;
    for (const Start& start : starts) width = std::max(width, start.name().size());
    for (const Start& start : starts) fmt::print("{:<{}}  {}\n", start.name(), width, start.what);
    fmt::print("\n`init NAME` writes one and tells what to type next.\n");
    return 0;
  }
  const std::string argument = line.arguments.empty() ? "" : line.arguments.front();
  if (const auto start = std::ranges::find(starts, argument, &Start::name); start != starts.end()) {
    write_start(*start, line);
    return 0;
  }
  const fs::path file = argument.empty() ? line.out : fs::path(argument);
  if (file.empty()) {
    fmt::print("{}", config_template());
    return 0;
  }
  NewFiles files(line);
  files.add(file, config_template());
  files.write();
  return 0;
}

}  // namespace fingertip::studies::inline cli::inline verbs
