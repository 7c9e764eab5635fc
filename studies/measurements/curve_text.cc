#include "studies/measurements/curve_text.h"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <utility>

namespace fingertip::studies::inline measurements {

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

namespace {

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put = [&](std::uint32_t byte) { text += char(static_cast<unsigned char>(byte)); };
  const auto tail = [&](unsigned shift) { put(0x80 | ((code >> shift) & 0x3F)); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6)), tail(0);
  } else if (code < 0x10000) {
    put(0xE0 | (code >> 12)), tail(6), tail(0);
  } else {
    put(0xF0 | (code >> 18)), tail(12), tail(6), tail(0);
  }
}

/// None for half a character, and for a zero one.
std::optional<std::string> from_utf16(string_view bytes, bool little) {
  if (bytes.size() % 2 != 0) return {};
  std::string text;
  std::uint32_t high = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    const auto low_byte = static_cast<unsigned char>(bytes[i + (little ? 0 : 1)]),
               high_byte = static_cast<unsigned char>(bytes[i + (little ? 1 : 0)]);
    const std::uint32_t unit = low_byte | std::uint32_t(high_byte) << 8;
    const bool first = unit >= 0xD800 && unit < 0xDC00, second = unit >= 0xDC00 && unit < 0xE000;
    if (unit == 0 || second != (high != 0)) return {};
    if (first) {
      high = unit;
    } else {
      append_utf8(text, second ? 0x10000 + ((high - 0xD800) << 10) + (unit - 0xDC00) : unit);
      high = 0;
    }
  }
  if (high != 0) return {};
  return text;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_utf8(string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    const int tails = lead < 0x80   ? 0
                      : lead < 0xC2 ? -1
                      : lead < 0xE0 ? 1
                      : lead < 0xF0 ? 2
                      : lead < 0xF5 ? 3
                                    : -1;
    if (tails < 0) return false;
    for (int k = 0; k < tails; ++k, ++i)
      if (i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return false;
  }
  return true;
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

/// None where the system does not know the encoding, or the text breaks its rules.
std::optional<std::string> from_chinese(string_view bytes) {
  const iconv_t converter = iconv_open("UTF-8", "GB18030");
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

/// Machines write UTF-16 with a byte order mark, GB 18030 in China, and Latin-1 for the micro sign
/// and umlauts.
std::optional<std::string> in_utf8(string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), true);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), false);
  if (bytes.find('\0') != bytes.npos) return {};
  if (is_utf8(bytes)) return std::string(bytes);
  if (is_chinese(bytes))
    if (auto text = from_chinese(bytes)) return text;
  std::string text;
  for (const char c : bytes) append_utf8(text, static_cast<unsigned char>(c));
  return text;
}

}  // namespace

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
    if (auto decoded = in_utf8(text))
      text = std::move(*decoded);
    else
      problems.add(0, "", "", "is no plain text in UTF-8, UTF-16 or Latin-1",
                   "save it as CSV in UTF-8");
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

std::optional<std::string> plain_number(string_view cell, NumberStyle style) {
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
  if (!number_in(result)) return {};
  return result;
}

}  // namespace fingertip::studies::inline measurements
