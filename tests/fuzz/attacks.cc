#include "attacks.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "tests/temporary_folder.h"

namespace fs = std::filesystem;

namespace attacks {

namespace {

std::vector<std::string> press(const char* mode, const std::vector<std::string>& more) {
  std::vector<std::string> words = {"press"};
  for (const char* set : {mode, "lattice.spacing=tip_radius/4", "press.samples=[\"0.05 cm\"]"})
    words.insert(words.end(), {"--set", set});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Without the columns that tell how long something took.
std::string without_wall_time(const std::string& table) {
  std::istringstream lines(table);
  std::vector<bool> kept;
  std::string text;
  for (std::string line; std::getline(lines, line); text += '\n') {
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      const bool time = cell.find("wall") != cell.npos || cell.find("real_time") != cell.npos;
      if (column == kept.size()) kept.push_back(!time);
      if (kept[column]) text += cell + ',';
    }
  }
  return text;
}

}  // namespace

bool told(int code) {
  return code == 0 || code == 2 || code == 3 || code == 4 || code == 130;
}

ProgramResult shell(const fs::path& folder, const std::string& script) {
  const std::string head = std::string("fingertip() { '") + FINGERTIP_PROGRAM + "' \"$@\"; }\n";
  return run_program(folder, {"-c", head + script}, "/bin/bash");
}

std::vector<std::string> static_press(const std::vector<std::string>& more) {
  return press("press.mode=static", more);
}

std::vector<std::string> moving_press(const std::vector<std::string>& more) {
  return press("press.mode=pid", more);
}

std::string quoted(const std::vector<std::string>& words) {
  std::string text = "fingertip";
  for (const std::string& word : words) {
    text += " '";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

std::map<std::string, std::string> results_in(const fs::path& run) {
  std::map<std::string, std::string> results;
  if (!fs::is_directory(run)) return results;
  for (const auto& item : fs::recursive_directory_iterator(run)) {
    const fs::path& path = item.path();
    const std::string name = fs::relative(path, run).generic_string();
    if (path.extension() == ".csv") results[name] = without_wall_time(read_text(path));
    if (path.filename() != "material.toml") continue;
    std::string text = read_text(path);
    const auto date = text.find("\ndate");
    if (date != text.npos) text.erase(date, text.find('\n', date + 1) - date);
    results[name] = text;
  }
  return results;
}

std::vector<std::string> leftovers(const fs::path& folder) {
  std::vector<std::string> found;
  if (!fs::is_directory(folder)) return found;
  for (const auto& item : fs::recursive_directory_iterator(folder)) {
    const std::string name = item.path().filename().string();
    if (name.find(".part") != name.npos || name == ".replaced" || name == ".fetched")
      found.push_back(item.path().string());
  }
  return found;
}

int wanted_kills() {
  const char* const text = std::getenv("FINGERTIP_FUZZ_KILLS");
  return text == nullptr ? FINGERTIP_KILLS : std::atoi(text);
}

}  // namespace attacks
