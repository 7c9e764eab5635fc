/// Tables as text: lines, cells, numbers, and what is wrong with them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/config/loader.h"
#include "studies/config/trimmed.h"

namespace fingertip::studies {

/// The first ten problems of a file, and how many more there are.
class FileProblems {
 public:
  explicit FileProblems(std::filesystem::path file) : file_(std::move(file)) {}

  /// `line` from 1, 0 for the file as a whole; `column` a title; `value` as it was written.
  void add(std::size_t line, const std::string& column, const std::string& value,
           const std::string& rule, const std::string& remedy);
  /// Throws ConfigError if there are any.
  void throw_if_any() const;

 private:
  std::filesystem::path file_;
  std::vector<Problem> problems_;
  std::size_t further_ = 0;
};

/// What a message may show of a file's text: printable and at most 40 characters.
std::string shown(std::string_view text);

/// A file's text in UTF-8 without byte order mark: UTF-16 with one and Latin-1, which is what is
/// no UTF-8, are converted. Throws ConfigError, by `problems`, for what is no readable file and for
/// text with zero characters or halves of them.
std::string text_of(const std::filesystem::path& file, FileProblems& problems);

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

}  // namespace fingertip::studies
