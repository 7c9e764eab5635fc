// Figures of a report in a real browser: values under the pointer, series switched off, shapes
// turned.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "chromium.h"
#include "meshes/base/files.h"
#include "studies/files/process.h"
#include "studies/report/figure/modulus_surfaces.h"
#include "studies/report/page/document.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
namespace report = studies::report;

namespace {

/// Two panels, the second one logarithmic, with two curves each; points are drawn.
report::Figure two_panels() {
  report::Figure figure;
  figure.name = "two";
  figure.columns = 2;
  for (const int log : {0, 10}) {
    report::Panel panel;
    panel.x_label = "indentation [mm]";
    panel.y_label = "force [mN]";
    panel.log_x = panel.log_y = log;
    for (const double factor : {1.0, 0.5}) {
      report::Series series;
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
constexpr const char* pointing_script = R"(<script>
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

/// Takes hold of the first of two shapes. Printing is tried by changing "print" and "screen" round.
constexpr const char* turning_script = R"(<script>
const told = [];
const tell = (what) => told.push(what);
const seen = (selector) => [...document.querySelectorAll(selector)].filter(
  (element) => element.getClientRects().length);
const state = () => tell([seen('polygon').length, seen('g.turning').length,
  seen('text').filter((text) => text.textContent === 'cubic').length]);
const drawings = () => [...document.querySelectorAll('g.turning')].map((shape) => shape.innerHTML);
const handle = document.querySelector('.handle');
const pointer = (type, x, y) => handle.dispatchEvent(
  new PointerEvent(type, { clientX: x, clientY: y, pointerId: 1 }));
const key = (name) => handle.dispatchEvent(new KeyboardEvent('keydown', { key: name }));
const changeMedia = () => [...document.styleSheets[0].cssRules].filter((rule) => rule.media)
  .forEach(({ media }) => {
    if (['print', 'screen'].includes(media.mediaText))
      media.mediaText = media.mediaText === 'print' ? 'screen' : 'print';
  });
tell(handle.getAttribute('aria-label'));
tell(document.querySelector('.switches').textContent);
state();
pointer('pointerdown', 200, 200);
pointer('pointermove', 260, 220);
state();
pointer('pointerup', 260, 220);
const dragged = drawings();
pointer('pointermove', 300, 220);
tell(JSON.stringify(dragged) === JSON.stringify(drawings()));
key('ArrowLeft');
state();
tell(drawings().map((drawing, i) => drawing !== dragged[i]));
changeMedia();
state();
changeMedia();
key('Home');
state();
key('ArrowUp');
state();
handle.dispatchEvent(new MouseEvent('dblclick'));
state();
tell(drawings().join().includes('NaN'));
document.body.replaceChildren(JSON.stringify(told).replaceAll('<', ' '));
document.title = 'told';
</script></body>)";

/// What the script on the page was told.
nlohmann::json answers_of(const std::filesystem::path& folder, const char* script) {
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
  report::Page page;
  page.title = "A page";
  page.chapters.push_back(
      {"only", "Only chapter", {report::FigureBlock{two_panels(), "Two panels", "Caption."}}});
  report::publish(page, folder.path(), "report.html");
  const nlohmann::json told = answers_of(folder.path(), pointing_script);
  ASSERT_EQ(told.size(), 6U) << told;
  EXPECT_EQ(told[0], "lattice\nindentation [mm]: 3\nforce [mN]: 9");
  // Error bars are an item of the plot, too; the second panel is logarithmic.
  EXPECT_EQ(told[1], " /script&gt; continuum\nindentation [mm]: 2\nforce [mN]: 2");
  EXPECT_EQ(told[2], " /script&gt; continuum\nindentation [mm]: 4\nforce [mN]: 8");
  EXPECT_EQ(told[3], true);
  EXPECT_EQ(told[4], "false - - 3a - - 3b");
  EXPECT_EQ(told[5], "true 1a 2a 3a 1b 2b 3b");
}

TEST(ReportPage, ShapesTurnTogetherAndTurnBack) {
  if (browser::chromium_program().empty())
    GTEST_SKIP() << "Chromium is not installed (./fingertip test installs it)";
  const TemporaryFolder folder;
  report::Page page;
  page.title = "A page";
  const report::Figure figure = report::modulus_surface_figure(
      "moduli", {{"cubic", report::cubic_material(4e3, 0.3, 3e3)},
                 {"</script> ball", report::cubic_material(4e3, 0.3, 4e3 / 2.6)}});
  page.chapters.push_back(
      {"only", "Only chapter", {report::FigureBlock{figure, "Moduli", "Caption."}}});
  report::publish(page, folder.path(), "report.html");
  const nlohmann::json told = answers_of(folder.path(), turning_script);
  ASSERT_EQ(told.size(), 12U) << told;
  EXPECT_EQ(
      told[0],
      "Moduli, cubic: a surface in space. Drag it or press the arrow keys to turn it; Home or "
      "a double click brings back the printed view.");
  EXPECT_EQ(told[1], "Drag to turn; a double click turns back.");
  // Two surfaces of 20 x 40 facets and the colour scale, which stays, as do the titles.
  const int scale = told[2][0].get<int>() - 1600;
  EXPECT_GT(scale, 0);
  const nlohmann::json printed = {scale + 1600, 0, 1}, turned = {scale, 2, 1};
  EXPECT_EQ(told[2], printed) << "at first";
  EXPECT_EQ(told[3], turned) << "dragged";
  EXPECT_EQ(told[4], true) << "the pointer was let go";
  EXPECT_EQ(told[5], turned) << "after an arrow key";
  EXPECT_EQ(told[6], nlohmann::json({true, true})) << "both shapes changed";
  EXPECT_EQ(told[7], printed) << "in print";
  EXPECT_EQ(told[8], printed) << "after Home";
  EXPECT_EQ(told[9], turned) << "after another arrow key";
  EXPECT_EQ(told[10], printed) << "after a double click";
  EXPECT_EQ(told[11], false) << "a drawing has numbers alone";
}
