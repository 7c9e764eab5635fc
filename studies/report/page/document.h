/// A page as data: chapters made of paragraphs, tables and figures, and its rendering to HTML.
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "studies/report/figure/figure.h"
#include "studies/report/figure/format.h"

namespace fingertip::studies::report::inline page {

/// Running text, with an optional lead-in in bold.
struct Paragraph {
  std::string lead;
  std::string text;
  bool warning = false;  ///< in a box of its own: what a reader must not miss
};

/// Text shown as it is.
struct Listing {
  std::string title;
  std::string text;
};

struct Cell {
  Cell(std::string cell_text = "", std::string second_line = "", Grade how = Grade::none,
       bool prose = false)
      : text(std::move(cell_text)), note(std::move(second_line)), grade(how), words(prose) {}
  Cell(const char* cell_text) : text(cell_text) {}

  std::string text;
  std::string note;  ///< second, smaller line: the SI value or the deviation
  Grade grade = Grade::none;
  bool words = false;  ///< prose: left-aligned and wrapped

  /// "–" or nothing at all.
  bool is_unknown() const { return text.empty() || text == "–"; }
};

/// Left-aligned and wrapped.
Cell prose(const std::string& text);
/// A relative error, graded: with its sign, or as a magnitude.
Cell error_cell(double error, const std::string& note = "");
Cell magnitude_cell(double error, const std::string& note = "");
/// A value in the unit shown, which the column's head names, with SI below; "–" where unknown.
Cell amount_cell(double value, const ShownUnit& unit);
/// With " ± error", where that is known.
Cell amount_cell(double value, const ShownUnit& unit, double error);
/// A head for each title; what follows a line's end in it is the note.
std::vector<Cell> heads(std::initializer_list<std::string> titles);

/// The first column names the row.
struct Table {
  std::vector<Cell> header;
  bool graded = false;  ///< explain the marks below the table
  std::vector<std::vector<Cell>> rows = {};
  std::string id = {}, caption = {};  ///< those of the template that places it

  /// Leaves out the columns from the `first` on in which nothing is known.
  void drop_unknown(std::size_t first);
  void drop_column(std::size_t column);
};

/// A figure with the sentence that says what to see.
struct FigureBlock {
  Figure figure;
  std::string title;
  std::string caption;
};

using Block = std::variant<Paragraph, Listing, Table, FigureBlock>;

struct Chapter {
  std::string id, title;
  std::vector<Block> blocks;
};

/// Something the page would show if it had been run.
struct NotRun {
  std::string what;
  std::string missing;  ///< the files it would be read from
};

/// A part of a file that could not be read.
struct Damaged {
  std::string place;  ///< file, line or entry
  std::string what;
};

struct Page {
  std::string title, subtitle;
  std::string status;                 ///< one line below the title, may be empty
  std::vector<std::string> rejected;  ///< why the result is not accepted: first, in red
  std::string answer;                 ///< the result in one paragraph, may be empty
  std::vector<Chapter> chapters;      ///< those without blocks are left out
  std::vector<NotRun> not_run;
  std::vector<Damaged> damaged;
};

/// Renders the page and publishes it: `folder`/figures/*, then `folder`/`file_name`. Everything is
/// made in a hidden folder beside them first, so an error leaves the old page untouched.
void publish(const Page& page, const std::filesystem::path& folder, const std::string& file_name);

}  // namespace fingertip::studies::report::inline page
