/// Tables as text: lines, cells, numbers, and what is wrong with them.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meshes/base/errors.h"
#include "studies/config/text/trimmed.h"

namespace fingertip::studies::inline measurements {

/// The first ten problems of a file, and how many more there are.
class FileProblems {
 public:
  explicit FileProblems(std::filesystem::path file) : file_(std::move(file)) {}

  /// `line` from 1, 0 for the file as a whole; `column` a title; `value` as it was written.
  void add(std::size_t line, const std::string& column, const std::string& value,
           const std::string& rule, const std::string& remedy);
  /// Throws InvalidInput if there are any.
  void throw_if_any() const;

 private:
  std::filesystem::path file_;
  std::vector<meshes::Violation> problems_;
  std::size_t further_ = 0;
};

/// What a message may show of a file's text: printable and at most 40 characters.
std::string shown(std::string_view text);

/// `bytes` in UTF-8 without byte order mark. Converted are UTF-16 with one, Shift JIS where pairs
/// of bytes are no other's, GB 18030 where all that is no ASCII are pairs of its bytes, and
/// Latin-1, which is what else is no UTF-8; none for text with zero characters or halves of them.
std::optional<std::string> in_utf8(std::string_view bytes);

struct FileText {
  std::string text;    ///< in UTF-8
  std::string sha256;  ///< of the file's bytes
};
/// Throws InvalidInput for what is no readable file and no text.
FileText text_of(const std::filesystem::path& file);

struct Line {
  std::string_view text;
  std::size_t number = 0;  ///< from 1
};

/// The lines of a text that are not blank; they end by LF, CR LF or CR.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}
  std::optional<Line> next();

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// Replaces `cells` by those of `line`, without blanks and double quotes around them; a separator
/// in quotes is part of its cell. The separator ' ' stands for any number of blanks and tabs.
void split(std::string_view line, char separator, std::vector<std::string_view>& cells);

/// The number that the whole cell is, with a decimal point; it may be infinite or NaN.
std::optional<double> number_in(std::string_view cell);

/// How numbers are written.
struct NumberStyle {
  char decimal = '.';
  char thousands = 0;  ///< 0: none; ' ' also for the blanks of typographers
};

/// The simple ones first.
inline constexpr std::array<NumberStyle, 7> number_styles = {
    {{'.', 0}, {',', 0}, {'.', ','}, {',', '.'}, {'.', ' '}, {',', ' '}, {'.', '\''}}};

/// "1.234,5" is 1234.5; none for what is no number in this style.
std::optional<double> number_in(std::string_view cell, NumberStyle style);

}  // namespace fingertip::studies::inline measurements
