// Figures of a report in a real browser: values under the pointer, series switched off.
#include <gtest/gtest.h>

#include "chromium.h"
#include "studies/report/document.h"

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
      series.label = factor == 1.0 ? "lattice" : "</script> & continuum";
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

class ReportPage : public testing::Test {
 protected:
  void SetUp() override {
    if (browser::chromium_program().empty())
      GTEST_SKIP() << "Chromium is not installed (./fingertip test installs it)";
    reporting::Page page;
    page.title = "A page";
    page.chapters.push_back(
        {"only", "Only chapter", {reporting::FigureBlock{two_panels(), "Two panels", "Caption."}}});
    reporting::publish(page, folder_.path(), "report.html");
    page_ = std::make_unique<browser::Chromium>(1000, 900);
    page_->open("file://" + (folder_ / "report.html").string());
    ASSERT_TRUE(page_->wait_for("document.querySelectorAll('.switches button').length === 2"));
  }
  void TearDown() override {
    if (!page_) return;
    for (const std::string& complaint : page_->complaints()) ADD_FAILURE() << complaint;
  }
  /// What the page says with the pointer on the i-th point, from 1, of a curve as gnuplot drew it.
  std::string values_at(const std::string& curve, int i) {
    page_->click("#two_plot_" + curve + " use:nth-of-type(" + std::to_string(i) + ")");
    return page_->evaluate("document.querySelector('.values').textContent");
  }
  nlohmann::json display(const std::string& curve) {
    return page_->evaluate("document.getElementById('two_plot_" + curve + "').style.display");
  }

  TemporaryFolder folder_;
  std::unique_ptr<browser::Chromium> page_;
};

}  // namespace

TEST_F(ReportPage, ThePointerTellsValues) {
  EXPECT_EQ(values_at("1a", 3), "lattice\nindentation [mm]: 3\nforce [mN]: 9");
  // Error bars are an item of the plot, too.
  EXPECT_EQ(values_at("3a", 2), "</script> & continuum\nindentation [mm]: 2\nforce [mN]: 2");
  EXPECT_EQ(values_at("3b", 4), "</script> & continuum\nindentation [mm]: 4\nforce [mN]: 8");
  page_->click("h1");
  EXPECT_EQ(page_->evaluate("document.querySelector('.values').hidden"), true);
}

TEST_F(ReportPage, ButtonsSwitchSeriesOffInAllPanels) {
  page_->click(".switches button");
  EXPECT_EQ(page_->evaluate("document.querySelector('.switches button').ariaPressed"), "false");
  for (const char* curve : {"1a", "2a", "1b", "2b"}) EXPECT_EQ(display(curve), "none") << curve;
  for (const char* curve : {"3a", "3b"}) EXPECT_EQ(display(curve), "") << curve;
  page_->click(".switches button");
  EXPECT_EQ(display("1a"), "");
  EXPECT_EQ(display("2b"), "");
}
