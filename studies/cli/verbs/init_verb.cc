#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/base/text_file.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/config/documents.h"
#include "studies/config/keys/key_table.h"
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

/// By name. A file without a command belongs to one that has.
std::vector<Start> all_starts() {
  std::vector<Start> starts;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(data_folder("examples", FINGERTIP_EXAMPLES), none))
    if (entry.path().extension() == ".toml") starts.emplace_back(entry.path());
  std::erase_if(starts, [](const Start& start) { return start.commands.empty(); });
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
        if (file.has_parent_path()) fs::create_directories(file.parent_path());
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

/// Files of the folder that a text names in quotes, and what these name in turn.
void add_named(const fs::path& folder, const std::string& text, std::set<fs::path>& named) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& file = entry.path();
    if (text.find('"' + file.filename().string() + '"') == text.npos) continue;
    if (named.insert(file).second && file.extension() == ".toml")
      add_named(folder, meshes::read_text(file), named);
  }
}

void write_start(const Start& start, const CommandLine& line) {
  const fs::path file = line.out.empty() ? fs::path(start.name() + ".toml") : line.out;
  const std::string there = std::string(in_the_repository) + start.file.filename().string();
  NewFiles files(line);
  files.add(file, replaced(start.text, there, file.string()));
  std::set<fs::path> named;
  add_named(start.file.parent_path(), start.text, named);
  for (const fs::path& each : named)
    files.add(file.parent_path() / each.filename(), meshes::read_text(each));
  files.write();
  if (line.quiet) return;
  const bool launched = std::getenv("FINGERTIP_LAUNCHER") != nullptr;
  for (const std::string& command : start.commands)
    fmt::print("next: {}\n", replaced(replaced(command, there, file.string()), launcher,
                                      launched ? std::string(launcher) : "fingertip"));
}

/// A file has an extension; what has none was meant to be a start.
void check_name(const std::string& name, const std::vector<Start>& starts) {
  if (starts.empty() || name.empty() || fs::path(name).has_extension()) return;
  std::vector<std::string> names;
  for (const Start& start : starts) names.push_back(start.name());
  throw ConfigError({"", "",
                     "there is no such start; the nearest one is " + nearest_word(name, names),
                     fmt::format("choose one of {}, or write every key into a file: init {}.toml",
                                 fmt::join(names, ", "), name),
                     "init " + name});
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
  check_name(argument, starts);
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
