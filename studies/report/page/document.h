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
  std::string text;
  std::string note;  ///< second, smaller line: the SI value or the deviation
  Grade grade = Grade::none;
  bool words = false;  ///< prose: left-aligned and wrapped
};

inline Cell plain(const std::string& text, const std::string& note = "") {
  return {text, note, Grade::none};
}

/// The first column names the row.
struct Table {
  std::string caption;
  std::vector<Cell> header;
  std::vector<std::vector<Cell>> rows;
  bool graded = false;  ///< explain the marks below the table
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
