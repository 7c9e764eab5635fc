// Pages on paper, by headless Chromium.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>

#include "studies/report/document.h"
#include "tests/temporary_folder.h"

namespace {

using namespace fingertip::studies::reporting;

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
  panel.series.push_back({"line", "", {0.0, 1.0}, {0.0, 1.0}, {}, {}});
  return {{name, 760, height, 1, {panel}}, "A line", "From one corner to the other."};
}

}  // namespace

/// A figure higher than a sheet used to be moved to the next one, and cut there all the same.
TEST(PrintedPage, HighFiguresLeaveNoSheetEmpty) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no chromium";
  Page page;
  page.title = "A page";
  page.answer = "A sentence.";
  page.chapters.push_back({"one", "One", {Paragraph{"", "Words."}, figure("high", 1300)}});
  page.chapters.push_back({"two", "Two", {Paragraph{"", "Words."}, figure("low", 200)}});
  // The words, the high figure, the second chapter.
  EXPECT_LE(sheets(page), 3);
  EXPECT_GE(sheets(page), 2);
}
