#include "studies/report/page/document.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "meshes/base/files.h"
#include "studies/report/figure/drawing.h"
#include "studies/report/figure/format.h"
#include "studies/report/page/rendering.h"
#include "studies/report/page/templates.h"

namespace fingertip::studies::report::inline page {
namespace {

namespace fs = std::filesystem;
WordList cell_words(const std::vector<Cell>& row, bool is_row) {
  WordList cells;
  for (const Cell& cell : row) {
    const bool row_name = is_row && cells.empty();
    cells.push_back({{{"cell_tag", row_name ? "th" : "td"},
                      {"row_name", row_name},
                      {"cell_text", cell.text},
                      {"cell_class", row_name     ? ""
                                     : cell.words ? "words"
                                                  : css_class(cell.grade)},
                      {"cell_mark", mark(cell.grade)},
                      {"cell_note", cell.note}}});
  }
  return cells;
}

/// Turns one block after the other into template data, drawing figures on the way.
struct BlockWords {
  fs::path figures;

  TemplateData operator()(const Paragraph& paragraph) const {
    return of(
        "paragraph",
        {{{"lead", paragraph.lead}, {"text", paragraph.text}, {"warning", paragraph.warning}}});
  }
  TemplateData operator()(const Listing& listing) const {
    return of("listing", {{{"listing_title", listing.title}, {"listing_text", listing.text}}});
  }
  TemplateData operator()(const Table& table) const {
    WordList rows;
    for (const auto& row : table.rows) rows.push_back({{{"cells", cell_words(row, true)}}});
    return of("table", {{{"table_caption", table.caption},
                         {"header", cell_words(table.header, false)},
                         {"rows", std::move(rows)},
                         {"graded", table.graded},
                         {"dense", table.header.size() > 8}}});
  }
  TemplateData operator()(const FigureBlock& block) const {
    const Drawing drawing = draw(block.figure, block.title, figures);
    return of("figure", {{{"svg", drawing.svg},
                          {"points", drawing.points},
                          {"figure_name", block.figure.name},
                          {"figure_title", block.title},
                          {"figure_caption", block.caption}}});
  }

 private:
  static TemplateData of(const std::string& kind, TemplateData own) {
    TemplateData block{
        {{"paragraph", false}, {"listing", false}, {"table", false}, {"figure", false}}};
    block[kind] = WordList{std::move(own)};
    return block;
  }
};

std::string html_of(const Page& page, const fs::path& figures) {
  WordList chapters, missing, damaged, rejected;
  for (const Chapter& chapter : page.chapters) {
    if (chapter.blocks.empty()) continue;
    WordList blocks;
    for (const Block& block : chapter.blocks)
      blocks.push_back(std::visit(BlockWords{figures}, block));
    chapters.push_back({{{"chapter_id", chapter.id},
                         {"chapter_title", chapter.title},
                         {"blocks", std::move(blocks)}}});
  }
  for (const NotRun& item : page.not_run)
    missing.push_back({{{"what", item.what}, {"files", item.missing}}});
  for (const std::string& reason : page.rejected) rejected.push_back({{{"reason", reason}}});
  for (const Damaged& item : page.damaged)
    damaged.push_back({{{"place", item.place}, {"what", item.what}}});
  return rendered(templates().at("report.html.mustache"),
                  {{{"damaged", damaged},
                    {"has_damaged", !damaged.empty()},
                    {"rejected", rejected},
                    {"has_rejected", !rejected.empty()},
                    {"page_title", page.title},
                    {"subtitle", page.subtitle},
                    {"page_status", page.status},
                    {"answer", page.answer},
                    {"chapters", std::move(chapters)},
                    {"not_run", missing},
                    {"has_not_run", !missing.empty()}}},
                  "report.html");
}

/// A folder that disappears with the scope.
class Workplace {
 public:
  explicit Workplace(const fs::path& parent)
      : path_(parent / fmt::format(".report-{}", ::getpid())) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

Cell prose(const std::string& text) {
  return {text, "", Grade::none, true};
}

Cell error_cell(double error, const std::string& note) {
  return {percent(error), note, figure::grade(error)};
}

Cell magnitude_cell(double error, const std::string& note) {
  return {percent_magnitude(error), note, figure::grade(error)};
}

Cell amount_cell(double value, const ShownUnit& unit) {
  return {number(unit(value)), std::isnan(value) ? "" : si_note(value, std::string(unit.si))};
}

Cell amount_cell(double value, const ShownUnit& unit, double error) {
  Cell cell = amount_cell(value, unit);
  if (std::isfinite(error))
    cell.text = number_with_error(unit(value), unit(error)) + " ± " + number(unit(error), 2);
  return cell;
}

std::vector<Cell> heads(std::initializer_list<std::string> titles) {
  std::vector<Cell> row;
  for (const std::string& title : titles) {
    const std::size_t end = std::min(title.find('\n'), title.size());
    row.emplace_back(title.substr(0, end), end < title.size() ? title.substr(end + 1) : "");
  }
  return row;
}

void Table::drop_unknown(std::size_t first) {
  for (std::size_t column = header.size(); column-- > first;) {
    const auto is_unknown = [&](const std::vector<Cell>& row) {
      return column >= row.size() || row[column].is_unknown();
    };
    if (std::ranges::all_of(rows, is_unknown)) drop_column(column);
  }
}

void Table::drop_column(std::size_t column) {
  header.erase(header.begin() + std::ptrdiff_t(column));
  for (std::vector<Cell>& row : rows)
    if (column < row.size()) row.erase(row.begin() + std::ptrdiff_t(column));
}

void publish(const Page& page, const fs::path& folder, const std::string& file_name) {
  const Workplace workplace(folder);
  const fs::path figures = workplace.path() / "figures";
  fs::create_directories(figures);
  const std::string html = html_of(page, figures);
  if (fs::exists(folder / "figures")) {
    fs::rename(folder / "figures", workplace.path() / "replaced");
  }
  fs::rename(figures, folder / "figures");
  meshes::write_atomically(folder / file_name, [&](std::ostream& out) { out << html; });
}

}  // namespace fingertip::studies::report::inline page
