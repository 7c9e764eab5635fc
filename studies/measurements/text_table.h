/// Tables in the text files of machines: where they begin and end, how cells and numbers stand.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline measurements {

/// What is known of a file's layout; the rest is found.
struct TableLayout {
  std::optional<char> separator;      ///< comma, semicolon or tab; ' ' is any number of blanks
  std::optional<bool> decimal_comma;  ///< 1,5 for 1.5
  std::size_t skip = 0;               ///< lines at the beginning, whatever they hold
  bool has_names = true;              ///< false: columns are numbered only

  bool operator==(const TableLayout&) const = default;
};

/// A title of the header.
struct TableTitle {
  std::string written;              ///< "Normal force (mN)"
  std::string name;                 ///< "normal_force"
  std::optional<std::string> unit;  ///< in brackets, parentheses, after a slash or in a row below
};

struct TextTable {
  std::vector<TableTitle> titles;   ///< where columns are numbered, of the lines above the numbers
  std::size_t header_line = 0;      ///< 0: none
  std::vector<std::size_t> needed;  ///< columns, as chosen
  char separator = ',';
  NumberStyle style;                           ///< of the needed columns
  std::vector<std::vector<std::string>> rows;  ///< as long as `titles`
  std::vector<std::size_t> lines;              ///< of every row

  /// A time of day counts in seconds. None for a cell that is no number.
  std::optional<double> number(std::size_t row, std::size_t column) const;
};

struct TextTables {
  std::vector<TextTable> tables;   ///< of the same columns, one below the other
  std::vector<Line> comments;      ///< lines that start with #
  std::vector<std::string> notes;  ///< what was found and what was passed over
};

/// The columns that are needed, or none where these titles, in that line, do not have them all.
using ChooseColumns =
    std::function<std::vector<std::size_t>(const std::vector<TableTitle>&, std::size_t line)>;

/// The tables of `text`. A table begins below the first line whose cells `choose` takes as titles,
/// or, with numbered columns, at the first line with numbers in all columns that it takes; a row of
/// units may come first. It ends at the next such header, with numbered columns at two lines of
/// words. Lines of words (a first cell of three letters or more where the first row has a number)
/// above, between and below rows are statistics or remarks: passed over and told, as are lines
/// below the last row that cannot be rows: they stand apart or have a gap where a row has a value.
/// Cells may stand in double quotes; empty ones at the end of a row do not count. The style of
/// numbers is that in which most cells of the needed columns are some (a point where several are as
/// good). Adds rows of another length to `problems`. Keeps no reference to `choose`; `comments`
/// refer to `text`.
TextTables tables_in(std::string_view text, const TableLayout& layout, const ChooseColumns& choose,
                     FileProblems& problems);

/// Chooses by names of the header or numbers, "#3"; keeps what the line that comes closest lacks.
/// A name is that of a title as written, or without unit, in small letters, with _ for blanks.
class DescribedColumns {
 public:
  explicit DescribedColumns(std::vector<std::string> columns);
  /// In the order of the columns.
  std::vector<std::size_t> operator()(const std::vector<TableTitle>& titles, std::size_t line);
  bool all_numbered() const;
  /// Says what is missing, in which line, where no line has all columns.
  void refuse(FileProblems& problems, const std::string& remedy) const;

 private:
  std::vector<std::string> columns_;
  std::size_t most_ = 0, line_ = 1;
  std::string missing_, titles_;
  bool twice_ = false;
};

/// SI over a unit, "mm" or "%"; none for what is no unit of `si`, "1" without dimension.
std::optional<double> unit_size(std::string_view unit, const std::string& si);

/// "Normal force [mN]" in its parts: the unit is what stands in the last brackets, or behind a
/// slash, " in " or a comma.
TableTitle title_of(std::string_view cell);

/// A time as a number of seconds, as h:min:s or min:s, or as a date and a time of day [s].
std::optional<double> time_in(std::string_view cell);

}  // namespace fingertip::studies::inline measurements
