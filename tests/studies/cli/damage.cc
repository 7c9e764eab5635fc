#include "tests/studies/cli/damage.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A whole number below `end`; the standard's distributions differ between libraries.
std::size_t below(std::size_t end, std::mt19937& random) {
  return end == 0 ? 0 : std::size_t(random()) % end;
}

template <typename List>
auto& one_of(List& list, std::mt19937& random) {
  return list[below(std::size(list), random)];
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& item : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(item.path(), folder).generic_string();
    const bool output = name.starts_with("figures/") || name.ends_with(".html");
    if (item.is_regular_file() && !output) files.push_back(item.path());
  }
  std::ranges::sort(files);
  return files;
}

const char* const senseless[] = {"inf",   "-inf", "nan", "1e999", "-1e300", "1e120",   "",
                                 "seven", "-1",   "0",   "1e9",   "0x10",   "\xff\xfe"};

/// Replaces one number of the text.
std::string with_senseless_number(const std::string& text, std::string& how, std::mt19937& random) {
  std::vector<std::pair<std::size_t, std::size_t>> numbers;
  const std::string digits = "0123456789+-.eE";
  for (std::size_t at = text.find_first_of("0123456789"); at != text.npos;) {
    const std::size_t end = std::min(text.find_first_not_of(digits, at), text.size());
    numbers.emplace_back(at, end - at);
    at = text.find_first_of("0123456789", end);
  }
  if (numbers.empty()) return text + "?";
  const auto [at, length] = one_of(numbers, random);
  const std::string by = one_of(senseless, random);
  how = "number '" + text.substr(at, length) + "' at " + std::to_string(at) + " -> '" + by + "'";
  return text.substr(0, at) + by + text.substr(at + length);
}

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, by);) parts.push_back(part);
  return parts;
}

std::string joined(const std::vector<std::string>& parts, char by) {
  std::string text;
  for (const std::string& part : parts)
    text += (&part == parts.data() ? "" : std::string(1, by)) + part;
  return text;
}

/// A table of another shape.
std::string reshaped(const std::string& text, std::string& how, std::mt19937& random) {
  std::vector<std::string> lines = split(text, '\n');
  if (lines.empty()) return "a,b\n";
  const std::size_t line = below(lines.size(), random);
  switch (below(4, random)) {
    case 0: {
      const std::size_t column = below(split(lines.front(), ',').size(), random);
      how = "without column " + std::to_string(column);
      for (std::string& row : lines) {
        std::vector<std::string> cells = split(row, ',');
        if (column < cells.size()) cells.erase(cells.begin() + std::ptrdiff_t(column));
        row = joined(cells, ',');
      }
      break;
    }
    case 1:
      how = "line " + std::to_string(line) + " twice";
      lines.insert(lines.begin() + std::ptrdiff_t(line), std::string(lines[line]));
      break;
    case 2:
      how = "without line " + std::to_string(line);
      lines.erase(lines.begin() + std::ptrdiff_t(line));
      break;
    default: how = "header alone"; lines.resize(1);
  }
  return joined(lines, '\n') + "\n";
}

/// All values of a JSON text below its root.
void collect(json& value, std::vector<json*>& values) {
  for (json& element : value) {
    values.push_back(&element);
    if (element.is_structured()) collect(element, values);
  }
}

std::string retyped(const std::string& text, std::string& how, std::mt19937& random) {
  json content = json::parse(text, nullptr, false);
  if (!content.is_object() || content.empty()) return "[]";
  std::vector<json*> values{&content};
  collect(content, values);
  json& value = *one_of(values, random);
  const json others[] = {nullptr,
                         true,
                         "text",
                         -1,
                         1e59,
                         1e300,
                         json::array(),
                         json::object(),
                         json::array({"text", nullptr}),
                         {{"a", {1, 2}}},
                         ""};
  const json& other = one_of(others, random);
  how = "'" + value.dump().substr(0, 30) + "' -> '" + other.dump() + "'";
  value = json(other);
  return content.dump(2);
}

std::string flipped(std::string text, std::string& how, std::mt19937& random) {
  const std::size_t at = below(text.size(), random);
  how = "byte " + std::to_string(at) + " flipped";
  if (!text.empty()) text[at] = char(text[at] ^ char(1U << below(8, random)));
  return text;
}

}  // namespace

std::string damage_something(const fs::path& folder, std::mt19937& random) {
  const std::vector<fs::path> files = files_in(folder);
  const fs::path file = one_of(files, random);
  const std::string name = fs::relative(file, folder).generic_string(), text = read_text(file);
  const bool is_json = file.extension() == ".json", is_table = file.extension() == ".csv";
  std::string how;
  switch (below(10, random)) {
    case 0: fs::remove(file); return name + ": gone";
    case 1:
      fs::remove(file);
      fs::create_directory(file);
      return name + ": a folder";
    case 2:
      fs::remove(file);
      fs::create_symlink("nowhere", file);
      return name + ": a dead link";
    case 3: write_text(file, ""); return name + ": empty";
    case 4: {
      const std::size_t kept = below(text.size(), random);
      write_text(file, text.substr(0, kept));
      return name + ": cut after " + std::to_string(kept) + " bytes";
    }
    case 5: write_text(file, flipped(text, how, random)); break;
    case 6:
    case 7:
      write_text(file, is_table  ? reshaped(text, how, random)
                       : is_json ? retyped(text, how, random)
                                 : flipped(text, how, random));
      break;
    default: write_text(file, with_senseless_number(text, how, random));
  }
  return name + ": " + how;
}
