// The folder of `web`, opened as a file in a real browser: it presses as this program does.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "chromium.h"
#include "studies/live/rig.h"
#include "studies/web/web_folder.h"
#include "tests/coarse_press.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

constexpr int periods = 60;  // of a millisecond: to 1 mm

WebPress press_of(double divisor) {
  WebPress press;
  press.setup = coarse_press();
  press.setup.lattice.spacing = press.setup.geometry.tip_radius / divisor;
  press.setup.lattice.constants =
      lattice::hookean_constants(press.setup.rubber, press.setup.lattice.spacing);
  press.reference = {{0.5e-3, 0.01, 1e-3}, {1e-3, 0.035, 1e-3}};
  return press;
}

class WebPage : public testing::Test {
 protected:
  void SetUp() override {
    if (browser::chromium_program().empty() || !std::filesystem::exists(module_file()))
      GTEST_SKIP() << "Chromium or the module is missing (./fingertip web builds it)";
    write_page(folder_.path(), {{"coarse", {{"R/4", press_of(4.0)}, {"R/5", press_of(5.0)}}},
                                {"other", {{"R/6", press_of(6.0)}}}});
    page_ = std::make_unique<browser::Chromium>(1280, 800);
    page_->open("file://" + (folder_.path() / "index.html").string());
    ASSERT_TRUE(page_->wait_for("document.getElementById('status').textContent === 'paused'"));
  }
  void TearDown() override {
    if (!page_) return;
    for (const std::string& complaint : page_->complaints()) ADD_FAILURE() << complaint;
  }
  void choose(const std::string& menu, int option) {
    page_->evaluate("(() => { const menu = document.getElementById('" + menu + "'); menu.value = " +
                    std::to_string(option) + "; menu.dispatchEvent(new Event('change')); })()");
  }
  bool shows(std::size_t masses) {
    return page_->wait_for("fingertipPage.frame.masses === " + std::to_string(masses));
  }

  TemporaryFolder folder_;
  std::unique_ptr<browser::Chromium> page_;
};

}  // namespace

TEST_F(WebPage, PressesAsTheProgramDoes) {
  LiveRig rig(press_of(5.0).setup);
  choose("spacing", 1);
  ASSERT_TRUE(shows(rig.boundary().size()));
  for (int i = 0; i < periods; ++i) rig.advance();
  page_->evaluate("for (let i = 0; i < " + std::to_string(periods) +
                  "; ++i) fingertipPage.send({ type: 'step' })");
  ASSERT_TRUE(page_->wait_for("fingertipPage.frame.time > 0.0595"));
  const double force = page_->evaluate("fingertipPage.frame.normal_force"),
               depth = page_->evaluate("fingertipPage.frame.indentation");
  EXPECT_GT(depth, 0.9e-3);
  EXPECT_NEAR(depth, rig.row().indentation, 1e-9 * rig.row().indentation);
  EXPECT_NEAR(force, rig.row().normal_force, 1e-9 * rig.row().normal_force);
  if (const char* folder = std::getenv("FINGERTIP_SCREENSHOTS"); folder != nullptr)
    page_->screenshot(std::filesystem::path(folder) / "web.png");
}

TEST_F(WebPage, RunsIsDraggedAndChangesItsFinger) {
  page_->click("#run");
  EXPECT_TRUE(page_->wait_for("fingertipPage.frame.normal_force > 0.01", 60.0));
  page_->drag("#handle", 40.0, 0.0);
  EXPECT_TRUE(page_->wait_for("fingertipPage.frame.hand?.force[0] !== undefined"));
  page_->release_mouse();
  EXPECT_EQ(page_->evaluate("fingertipPage.about.reference.length"), 2);
  choose("finger", 1);
  EXPECT_TRUE(shows(LiveRig(press_of(6.0).setup).boundary().size()));
  EXPECT_EQ(page_->evaluate("document.getElementById('spacing').textContent"), "R/6");
  const nlohmann::json scrolls = page_->evaluate(
      "document.documentElement.scrollWidth > innerWidth || "
      "document.querySelector('header').scrollWidth > innerWidth");
  EXPECT_EQ(scrolls, false);
}
