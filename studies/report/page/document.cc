#include "studies/report/page/document.h"

#include <fmt/format.h>
#include <unistd.h>

#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "meshes/base/files.h"
#include "studies/report/figure/drawing.h"
#include "studies/report/page/templates.h"

namespace fingertip::studies::report::inline page {
namespace {

namespace fs = std::filesystem;
using Data = kainjow::mustache::data;
using List = kainjow::mustache::list;

Data cell_data(const Cell& cell, bool row_name) {
  Data result;
  result.set("cell_tag", row_name ? "th" : "td");
  result.set("row_name", row_name);
  result.set("cell_text", cell.text);
  const std::string style = cell.words ? "words" : css_class(cell.grade);
  result.set("cell_class", style);
  result.set("styled", !style.empty() && !row_name);
  result.set("cell_mark", mark(cell.grade));
  result.set("has_mark", cell.grade != Grade::none);
  result.set("cell_note", cell.note);
  result.set("has_note", !cell.note.empty());
  return result;
}

Data row_data(const std::vector<Cell>& row) {
  Data cells{List()};
  for (std::size_t i = 0; i < row.size(); ++i) cells << cell_data(row[i], i == 0);
  Data result;
  result.set("cells", cells);
  return result;
}

/// Turns one block after the other into template data, drawing figures on the way.
class BlockData {
 public:
  explicit BlockData(fs::path figures) : figures_(std::move(figures)) {}

  Data operator()(const Paragraph& paragraph) const {
    Data inner;
    inner.set("lead", paragraph.lead);
    inner.set("has_lead", !paragraph.lead.empty());
    inner.set("text", paragraph.text);
    inner.set("warning", paragraph.warning);
    return Data("paragraph", inner);
  }

  Data operator()(const Listing& listing) const {
    Data inner;
    inner.set("listing_title", listing.title);
    inner.set("listing_text", listing.text);
    return Data("listing", inner);
  }

  Data operator()(const Table& table) const {
    Data header{List()}, rows{List()};
    for (const Cell& cell : table.header) header << cell_data(cell, false);
    for (const auto& row : table.rows) rows << row_data(row);
    Data inner;
    inner.set("table_caption", table.caption);
    inner.set("header", header);
    inner.set("rows", rows);
    inner.set("graded", table.graded);
    inner.set("dense", table.header.size() > 8);
    return Data("table", inner);
  }

  Data operator()(const FigureBlock& block) const {
    Data inner;
    const Drawing drawing = draw(block.figure, block.title, figures_);
    inner.set("svg", drawing.svg);
    inner.set("points", drawing.points);
    inner.set("has_points", !drawing.points.empty());
    inner.set("figure_name", block.figure.name);
    inner.set("figure_title", block.title);
    inner.set("figure_caption", block.caption);
    return Data("figure", inner);
  }

 private:
  fs::path figures_;
};

std::string render(const Page& page, const fs::path& figures) {
  Data chapters{List()}, missing{List()}, damaged{List()}, rejected{List()};
  for (const Chapter& chapter : page.chapters) {
    if (chapter.blocks.empty()) continue;
    Data blocks{List()};
    for (const Block& block : chapter.blocks) blocks << std::visit(BlockData(figures), block);
    Data entry;
    entry.set("chapter_id", chapter.id);
    entry.set("chapter_title", chapter.title);
    entry.set("blocks", blocks);
    chapters << entry;
  }
  for (const NotRun& item : page.not_run) {
    Data entry;
    entry.set("what", item.what);
    entry.set("files", item.missing);
    missing << entry;
  }
  for (const std::string& reason : page.rejected) rejected << Data("reason", reason);
  for (const Damaged& item : page.damaged) {
    Data entry;
    entry.set("place", item.place);
    entry.set("what", item.what);
    damaged << entry;
  }
  Data root;
  root.set("damaged", damaged);
  root.set("has_damaged", !page.damaged.empty());
  root.set("rejected", rejected);
  root.set("has_rejected", !page.rejected.empty());
  root.set("page_title", page.title);
  root.set("subtitle", page.subtitle);
  root.set("page_status", page.status);
  root.set("has_status", !page.status.empty());
  root.set("answer", page.answer);
  root.set("has_answer", !page.answer.empty());
  root.set("chapters", chapters);
  root.set("not_run", missing);
  root.set("has_not_run", !page.not_run.empty());
  kainjow::mustache::mustache view{std::string(templates().at("report.html.mustache"))};
  if (!view.is_valid()) throw std::runtime_error("report template: " + view.error_message());
  return view.render(root);
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

void publish(const Page& page, const fs::path& folder, const std::string& file_name) {
  const Workplace workplace(folder);
  const fs::path figures = workplace.path() / "figures";
  fs::create_directories(figures);
  const std::string html = render(page, figures);
  if (fs::exists(folder / "figures")) {
    fs::rename(folder / "figures", workplace.path() / "replaced");
  }
  fs::rename(figures, folder / "figures");
  meshes::write_atomically(folder / file_name, [&](std::ostream& out) { out << html; });
}

}  // namespace fingertip::studies::report::inline page
