#include "studies/measurements/curve_text.h"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "meshes/base/text_file.h"
#include "studies/jobs/digest.h"

namespace fingertip::studies::inline measurements {

namespace fs = std::filesystem;
using std::string_view;

namespace {

constexpr std::size_t max_problems = 10;

}  // namespace

void FileProblems::add(std::size_t line, const std::string& column, const std::string& value,
                       const std::string& rule, const std::string& remedy) {
  if (problems_.size() == max_problems) {
    ++further_;
    return;
  }
  const std::string place = file_.string() + (line > 0 ? ":" + std::to_string(line) : "");
  problems_.push_back({column, value, rule, remedy, place});
}

void FileProblems::throw_if_any() const {
  if (problems_.empty()) return;
  std::vector<meshes::Violation> problems = problems_;
  if (further_ > 0)
    problems.push_back({"", "", fmt::format("{} further problems are not shown", further_),
                        "correct these first", file_.string()});
  throw meshes::InvalidInput(std::move(problems));
}

std::string shown(string_view text) {
  constexpr std::size_t most = 40;
  std::string result(text.substr(0, most));
  std::ranges::replace(result, '\t', ' ');
  for (char& c : result)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return result + (text.size() > most ? "..." : "");
}

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Chinese characters of GB 2312 and its supersets stand in pairs of high bytes; two umlauts side
/// by side are rare in Latin-1, and nothing but pairs of them does not occur.
bool is_chinese(string_view bytes) {
  std::size_t run = 0, characters = 0;
  for (const char c : bytes) {
    if (static_cast<unsigned char>(c) >= 0xA1) {
      ++run;
      continue;
    }
    if (run % 2 != 0 || static_cast<unsigned char>(c) >= 0x80) return false;
    characters += std::exchange(run, 0) / 2;
  }
  return run % 2 == 0 && characters + run / 2 >= 2;
}

/// Kana and kanji of Shift JIS: pairs that begin with bytes which are no letters of Latin-1; of
/// Windows' quotes and dashes there the second byte is no such one.
bool is_japanese(string_view bytes) {
  std::size_t pairs = 0;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    const auto first = static_cast<unsigned char>(bytes[i]),
               second = static_cast<unsigned char>(bytes[i + 1]);
    if (first < 0x81 || first > 0x9F) continue;
    if (second >= 0x80) ++pairs;
    ++i;
  }
  return pairs >= 2;
}

/// None where the text breaks the rules of its encoding.
std::optional<std::string> converted(string_view bytes, const char* encoding) {
  const iconv_t converter = iconv_open("UTF-8", encoding);
  if (converter == iconv_t(-1)) return {};
  std::string in(bytes), out(2 * bytes.size(), '\0');
  char *from = in.data(), *to = out.data();
  std::size_t left = in.size(), room = out.size();
  const bool whole = iconv(converter, &from, &left, &to, &room) != std::size_t(-1);
  iconv_close(converter);
  if (!whole) return {};
  out.resize(out.size() - room);
  return out;
}

}  // namespace

std::optional<std::string> in_utf8(string_view bytes) {
  std::optional<std::string> text;
  if (bytes.starts_with("\xFF\xFE"))
    text = converted(bytes.substr(2), "UTF-16LE");
  else if (bytes.starts_with("\xFE\xFF"))
    text = converted(bytes.substr(2), "UTF-16BE");
  else if (bytes.starts_with("\xEF\xBB\xBF"))
    return in_utf8(bytes.substr(3));
  else if (text = converted(bytes, "UTF-8"); !text) {
    if (is_japanese(bytes)) text = converted(bytes, "CP932");
    if (!text && is_chinese(bytes)) text = converted(bytes, "GB18030");
    // Of machines that write the micro sign and umlauts.
    if (!text) text = converted(bytes, "ISO-8859-1");
  }
  if (text && text->find('\0') != text->npos) return {};
  return text;
}

FileText text_of(const fs::path& file) {
  const std::string bytes = meshes::read_text(file);
  std::optional<std::string> text = in_utf8(bytes);
  if (!text)
    throw meshes::InvalidInput({"", "", "is no plain text in UTF-8, UTF-16 or Latin-1",
                                "save it as CSV in UTF-8", file.string()});
  return {std::move(*text), sha256(bytes)};
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
  const bool blanks = separator == ' ';
  const string_view ends = blanks ? string_view(" \t") : string_view(&separator, 1);
  if (blanks) line = trimmed(line);
  for (;;) {
    const auto begin =
        std::min(line.find_first_not_of(separator == '\t' ? " " : " \t"), line.size());
    // What stands in quotes may hold the separator.
    std::size_t from = begin;
    if (begin < line.size() && line[begin] == '"') {
      const auto quote = line.find('"', begin + 1);
      if (quote != line.npos) from = quote + 1;
    }
    const auto end = line.find_first_of(ends, from);
    string_view cell = trimmed(line.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
      cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (end == line.npos) return;
    line.remove_prefix(blanks ? std::min(line.find_first_not_of(ends, end), line.size()) : end + 1);
  }
}

std::optional<double> number_in(string_view cell) {
  if (cell.starts_with('+') && !cell.starts_with("+-")) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size()) return {};
  return value;
}

std::optional<double> number_in(string_view cell, NumberStyle style) {
  constexpr string_view minus = "\xE2\x88\x92";
  constexpr string_view blanks[] = {"\xC2\xA0", "\xE2\x80\xAF"};
  std::string text;
  while (!cell.empty()) {
    std::size_t length = 1;
    char c = cell.front();
    if (cell.starts_with(minus)) c = '-', length = minus.size();
    for (const string_view blank : blanks)
      if (cell.starts_with(blank)) c = ' ', length = blank.size();
    text += c;
    cell.remove_prefix(length);
  }
  std::string result;
  std::size_t groups = 0, since = 0;  // digits since the last separator of thousands
  bool whole = true;
  for (const char c : text) {
    if (whole && style.thousands != 0 && c == style.thousands) {
      const bool first_group = groups++ == 0;
      const bool fits = first_group ? since >= 1 && since <= 3 : since == 3;
      if (!fits || (first_group && result.ends_with('0') && since == 1)) return {};
      since = 0;
    } else if (whole && !is_digit(c) && c != '-' && c != '+') {
      if (c != style.decimal && c != 'e' && c != 'E') return {};
      if (groups > 0 && since != 3) return {};
      whole = false;
      result += c == style.decimal ? '.' : c;
    } else if (c == ',') {
      return {};
    } else {
      since += is_digit(c) ? 1 : 0;
      result += c;
    }
  }
  if (whole && groups > 0 && since != 3) return {};
  return number_in(result);
}

}  // namespace fingertip::studies::inline measurements
