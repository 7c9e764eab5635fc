#include "studies/run/curve_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>

namespace fingertip::studies {

namespace fs = std::filesystem;
using std::string_view;

namespace {

constexpr std::size_t most_problems = 10;

}  // namespace

void FileProblems::add(std::size_t line, const std::string& column, const std::string& value,
                       const std::string& rule, const std::string& remedy) {
  if (problems_.size() == most_problems) {
    ++further_;
    return;
  }
  const std::string place = file_.string() + (line > 0 ? ":" + std::to_string(line) : "");
  problems_.push_back({place, column, value, rule, remedy});
}

void FileProblems::throw_if_any() const {
  if (problems_.empty()) return;
  std::vector<Problem> problems = problems_;
  if (further_ > 0)
    problems.push_back({file_.string(), "", "",
                        fmt::format("{} further problems are not shown", further_),
                        "correct these first"});
  throw ConfigError(std::move(problems));
}

std::string shown(string_view text) {
  constexpr std::size_t most = 40;
  std::string result(text.substr(0, most));
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return result + (text.size() > most ? "..." : "");
}

std::string text_of(const fs::path& file, FileProblems& problems) {
  std::string text;
  std::error_code none;
  std::ifstream in(file, std::ios::binary);
  if (!fs::is_regular_file(file, none) || !in) {
    problems.add(0, "", "",
                 fs::is_directory(file, none) ? "is a folder" : "the file cannot be read",
                 "give the path of an existing, readable CSV file");
  } else {
    text.resize(fs::file_size(file));
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(in.gcount()));
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF") ||
        text.find('\0') != text.npos)
      problems.add(0, "", "", "is no plain text in UTF-8", "save it as CSV in UTF-8");
  }
  problems.throw_if_any();
  return text;
}

std::optional<Line> Lines::next() {
  while (!rest_.empty()) {
    const auto end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    const string_view line = rest_.substr(0, end);
    const bool both = rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(std::min(rest_.size(), end + (both ? 2 : 1)));
    ++number_;
    if (!trimmed(line).empty()) return Line{line, number_};
  }
  return {};
}

void split(string_view line, char separator, std::vector<string_view>& cells) {
  cells.clear();
  for (;;) {
    const auto end = line.find(separator);
    string_view cell = trimmed(line.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
      cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (end == line.npos) return;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number_in(string_view cell) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) return {};
  return value;
}

}  // namespace fingertip::studies
