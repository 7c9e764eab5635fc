// Pages on paper, by headless Chromium.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "studies/report/chapters/continuum/continuum_chapters.h"
#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/document.h"
#include "studies/report/report_parts.h"
#include "tests/temporary_folder.h"

namespace {

using namespace fingertip::studies::report;

/// Prints `page` and counts the sheets; 0 where Chromium does not print.
std::ptrdiff_t sheets(const Page& page) {
  const TemporaryFolder folder;
  publish(page, folder.path(), "page.html");
  const std::string command =
      "chromium --headless --no-sandbox --disable-gpu --no-pdf-header-footer --user-data-dir='" +
      (folder / "browser").string() + "' --print-to-pdf='" + (folder / "page.pdf").string() +
      "' 'file://" + (folder / "page.html").string() + "' > '" + (folder / "log").string() +
      "' 2>&1";
  if (std::system(command.c_str()) != 0) return 0;
  const std::string pdf = read_text(folder / "page.pdf");
  const std::regex sheet(R"(/Type\s*/Page\b)");
  return std::distance(std::sregex_iterator(pdf.begin(), pdf.end(), sheet), {});
}

FigureBlock figure(const std::string& name, int height) {
  Panel panel;
  panel.x_label = "x";
  panel.y_label = "y";
  panel.series.push_back({"line", "", {}, {0.0, 1.0}, {0.0, 1.0}});
  return {{name, 760, height, 1, {panel}}, "A line", "From one corner to the other."};
}

}  // namespace

/// How many tables of `page` have to be scrolled sideways in a window `width` pixels wide; -1 where
/// Chromium does not tell.
int cut_tables(const Page& page, int width) {
  const TemporaryFolder folder;
  publish(page, folder.path(), "page.html");
  std::string html = read_text(folder / "page.html");
  html +=
      "<script>document.title = 'cut=' + [...document.querySelectorAll('.wide')]"
      ".filter((w) => w.scrollWidth > w.clientWidth).length + '.';</script>";
  write_text(folder / "measured.html", html);
  const std::string command =
      "chromium --headless --no-sandbox --disable-gpu --window-size=" + std::to_string(width) +
      ",900 --user-data-dir='" + (folder / "browser").string() + "' --dump-dom 'file://" +
      (folder / "measured.html").string() + "' > '" + (folder / "dom").string() + "' 2> /dev/null";
  if (std::system(command.c_str()) != 0) return -1;
  const std::string dom = read_text(folder / "dom");
  std::smatch told;
  return std::regex_search(dom, told, std::regex("<title>cut=([0-9]+)\\.")) ? std::stoi(told.str(1))
                                                                            : -1;
}

/// A figure higher than a sheet used to be moved to the next one, and cut there all the same.
TEST(PrintedPage, HighFiguresLeaveNoSheetEmpty) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no chromium";
  Page page;
  page.title = "A page";
  page.answer = "A sentence.";
  page.chapters.push_back({"one", "One", {Paragraph{"", "TemplateData."}, figure("high", 1300)}});
  page.chapters.push_back({"two", "Two", {Paragraph{"", "TemplateData."}, figure("low", 200)}});
  // The words, the high figure, the second chapter.
  EXPECT_LE(sheets(page), 3);
  EXPECT_GE(sheets(page), 2);
}

/// Its last columns used to be cut on a laptop.
TEST(WidePage, VerdictFitsALaptop) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no chromium";
  RunData run;
  run.target = {3922.66, 1372.931, 0.4286, 9152.9};
  std::vector<fingertip::meshes::PressSample> samples;
  for (int i = 1; i <= 10; ++i) {
    run.depths.push_back(3e-4 * i);
    fingertip::meshes::PressSample sample;
    sample.indentation = run.depths.back();
    sample.normal_force = 0.216 / 10.0 * i;
    samples.push_back(sample);
  }
  run.reference = fingertip::meshes::PressResponse(samples);
  for (const char* name : {"published", "central", "hookean"}) {
    ModelData model;
    model.name = name;
    model.status = "not converged";
    model.moduli = {8816.0, 12208.0, 14013.0, 5792.0, 0.3167, 8023.4};
    model.force_error.assign(10, -0.757);
    model.l2_error = 0.123;
    model.real_time_factor = 0.0123;
    run.models.push_back(model);
  }
  Page page;
  page.title = "A page";
  page.chapters.push_back(verdict_chapter(run));
  for (const int width : {1000, 1200}) EXPECT_EQ(cut_tables(page, width), 0) << width;
}
