// Figures of a report in a real browser: values under the pointer, series switched off.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chromium.h"
#include "meshes/files.h"
#include "studies/files/process.h"
#include "studies/report/document.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
namespace reporting = studies::reporting;

namespace {

/// Two panels, the second one logarithmic, with two curves each; points are drawn.
reporting::Figure two_panels() {
  reporting::Figure figure;
  figure.name = "two";
  figure.columns = 2;
  for (const int log : {0, 10}) {
    reporting::Panel panel;
    panel.x_label = "indentation [mm]";
    panel.y_label = "force [mN]";
    panel.log_x = panel.log_y = log;
    for (const double factor : {1.0, 0.5}) {
      reporting::Series series;
      series.label = factor == 1.0 ? "lattice" : "</script> continuum";
      series.x = {1.0, 2.0, 3.0, 4.0};
      for (const double x : series.x) series.y.push_back(factor * x * x);
      if (factor == 1.0) series.error = {0.1, 0.1, 0.1, 0.1};
      series.style.point = 7;
      panel.series.push_back(series);
    }
    figure.panels.push_back(panel);
  }
  return figure;
}

/// Points at the i-th point, from 1, of a curve as gnuplot drew it; then presses a button.
constexpr const char* script = R"(<script>
const told = [];
const tell = (what) => told.push(what);
for (const [curve, i] of [['1a', 3], ['3a', 2], ['3b', 4]]) {
  const box = document.querySelectorAll(`#two_plot_${curve} use`)[i - 1].getBoundingClientRect();
  document.querySelector('svg').dispatchEvent(new PointerEvent('pointermove',
    { clientX: box.x + box.width / 2, clientY: box.y + box.height / 2 }));
  tell(document.querySelector('.values').textContent);
}
document.querySelector('svg').dispatchEvent(new PointerEvent('pointerleave'));
tell(document.querySelector('.values').hidden);
const shown = () => ['1a', '2a', '3a', '1b', '2b', '3b'].map(
  (curve) => document.getElementById('two_plot_' + curve).style.display === 'none' ? '-' : curve);
for (let i = 0; i < 2; ++i) {
  document.querySelector('.switches button').click();
  tell(document.querySelector('.switches button').ariaPressed + ' ' + shown().join(' '));
}
document.body.replaceChildren(JSON.stringify(told).replaceAll('<', ' '));
document.title = 'told';
</script></body>)";

/// What the script on the page was told.
nlohmann::json answers_of(const std::filesystem::path& folder) {
  std::string html = read_text(folder / "report.html");
  html.replace(html.rfind("</body>"), 7, script);
  fingertip::meshes::write_atomically(folder / "asked.html",
                                      [&](std::ostream& out) { out << html; });
  const int code = studies::run_process(
      {{browser::chromium_program().string(), "--headless", "--no-sandbox", "--disable-gpu",
        "--user-data-dir=" + (folder / "profile").string(), "--window-size=1000,900", "--dump-dom",
        "file://" + (folder / "asked.html").string()},
       {}},
      folder / "dump.txt");
  EXPECT_EQ(code, 0);
  const std::string dump = read_text(folder / "dump.txt");
  EXPECT_NE(dump.find("<title>told</title>"), std::string::npos) << dump.substr(0, 2000);
  const auto from = dump.rfind("<body>") + 6, to = dump.rfind("</body>");
  return nlohmann::json::parse(dump.substr(from, to - from), nullptr, false);
}

}  // namespace

TEST(ReportPage, ThePointerTellsValuesAndButtonsSwitchSeriesOff) {
  if (browser::chromium_program().empty())
    GTEST_SKIP() << "Chromium is not installed (./fingertip test installs it)";
  const TemporaryFolder folder;
  reporting::Page page;
  page.title = "A page";
  page.chapters.push_back(
      {"only", "Only chapter", {reporting::FigureBlock{two_panels(), "Two panels", "Caption."}}});
  reporting::publish(page, folder.path(), "report.html");
  const nlohmann::json told = answers_of(folder.path());
  ASSERT_EQ(told.size(), 6U) << told;
  EXPECT_EQ(told[0], "lattice\nindentation [mm]: 3\nforce [mN]: 9");
  // Error bars are an item of the plot, too; the second panel is logarithmic.
  EXPECT_EQ(told[1], " /script&gt; continuum\nindentation [mm]: 2\nforce [mN]: 2");
  EXPECT_EQ(told[2], " /script&gt; continuum\nindentation [mm]: 4\nforce [mN]: 8");
  EXPECT_EQ(told[3], true);
  EXPECT_EQ(told[4], "false - - 3a - - 3b");
  EXPECT_EQ(told[5], "true 1a 2a 3a 1b 2b 3b");
}
