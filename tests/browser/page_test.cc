// The live view in a real browser: elements, values, transport, sliders, hand, reload.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "chromium.h"
#include "lattice/control/force_controller.h"
#include "studies/live/server.h"
#include "tests/coarse_press.h"
#include "tests/fingers.h"

using namespace fingertip;

namespace {

/// A reference that the page can draw: a curve and a patch of a surface at two depths.
studies::Reference small_reference() {
  studies::Reference reference;
  for (const double depth : {0.5e-3, 1e-3, 2e-3, 3e-3}) {
    meshes::PressSample sample;
    sample.indentation = depth;
    sample.normal_force = 0.03 * std::pow(depth / 1e-3, 1.7);
    reference.response.append(sample);
  }
  for (const double depth : {1e-3, 3e-3}) {
    studies::SurfaceMesh patch;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * M_PI * i / 24.0;
      patch.rest.push_back(0.01 * meshes::Vector3(std::cos(angle), 0.0, std::sin(angle)));
      patch.displacement.push_back({0.0, 0.0, -depth * std::max(0.0, std::sin(angle))});
      patch.edges.push_back({std::uint32_t(i), std::uint32_t((i + 1) % 24)});
    }
    reference.overlays.push_back({depth, patch});
  }
  return reference;
}

class LivePage : public testing::Test {
 protected:
  virtual lattice::PressSetup press() const {
    lattice::PressSetup setup = coarse_press();
    setup.protocol.depth = 3e-3;
    setup.protocol.markers = {{0.0, 0.0, 9e-3}, {4e-3, 0.0, 6e-3}};
    return setup;
  }
  void SetUp() override {
    if (browser::chromium_program().empty())
      GTEST_SKIP() << "Chromium is not installed (./fingertip test installs it)";
    simulation_ = std::make_unique<studies::Simulation>(
        press(), studies::PaceSettings{true, 1.0, {}}, [this] {
          if (studies::LiveServer* server = listener_) server->frame_ready();
        });
    server_ = std::make_unique<studies::LiveServer>(*simulation_, reference_, 0);
    listener_ = server_.get();
    page_ = std::make_unique<browser::Chromium>(1280, 800);
    page_->open(server_->url());
    ASSERT_TRUE(page_->wait_for(connected));
  }
  void TearDown() override {
    if (!page_) return;
    for (const std::string& complaint : page_->complaints()) ADD_FAILURE() << complaint;
    page_.reset();
    simulation_->stop();
    listener_ = nullptr;
  }

  /// The number that an element shows.
  double shown(const std::string& id) {
    return page_->evaluate("parseFloat(document.getElementById('" + id +
                           "').textContent.replace('\\u2212', '-'))");
  }
  std::string text(const std::string& id) {
    return page_->evaluate("document.getElementById('" + id + "').textContent");
  }
  /// Waits until the page shows the simulation's last frame, both at rest.
  void come_to_rest() {
    std::uint64_t before = 0, now = simulation_->frame()->number;
    do {
      before = now;
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      now = simulation_->frame()->number;
    } while (now != before);
    ASSERT_TRUE(page_->wait_for(fmt::format("document.body.dataset.frame === '{}'", now)));
  }
  void slide(const std::string& id, double share) {
    page_->evaluate(fmt::format(
        "(() => {{ const s = document.getElementById('{}'); s.value = {}; s.dispatchEvent(new "
        "Event('input', {{ bubbles: true }})); }})()",
        id, share));
  }

  static constexpr const char* connected =
      "document.getElementById('status').textContent === 'paused'";
  studies::Reference reference_ = small_reference();
  std::atomic<studies::LiveServer*> listener_ = nullptr;
  std::unique_ptr<studies::Simulation> simulation_;
  std::unique_ptr<studies::LiveServer> server_;
  std::unique_ptr<browser::Chromium> page_;
};

class LiveForcePage : public LivePage {
 protected:
  lattice::PressSetup press() const override {
    lattice::PressSetup setup = coarse_press();
    setup.make_controller = [](const lattice::ControlTask& task) {
      return std::make_unique<lattice::ForceController>(lattice::PidSettings{},
                                                        lattice::ForceSettings{}, task);
    };
    return setup;
  }
};

/// Pairs of visible texts that overlap, or texts cut off by their box.
constexpr const char* crowded = R"((() => {
  const shown = [...document.querySelectorAll('h1, header p, header button, figcaption, #readings dt, #readings dd, .label, #legend li, fieldset legend, .slider span, .slider output, .check, .buttons button, #notice')]
    .filter((e) => e.offsetParent !== null && e.textContent.trim() !== '');
  const found = [];
  const boxes = shown.map((e) => e.getBoundingClientRect());
  for (let i = 0; i < shown.length; ++i) {
    const e = shown[i], b = boxes[i];
    if (e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0) found.push('cut: ' + e.textContent);
    if (b.right > innerWidth + 1 || b.bottom > innerHeight + 1 || b.left < -1 || b.top < -1) found.push('outside: ' + e.textContent);
    for (let j = i + 1; j < shown.length; ++j) {
      if (e.contains(shown[j]) || shown[j].contains(e)) continue;
      const c = boxes[j];
      if (b.left < c.right - 1 && c.left < b.right - 1 && b.top < c.bottom - 1 && c.top < b.bottom - 1) found.push(e.textContent + ' | ' + shown[j].textContent);
    }
  }
  return found;
})())";

}  // namespace

TEST_F(LivePage, ShowsWhatTheServerSays) {
  EXPECT_EQ(text("title").find("hookean lattice"), 0U);
  EXPECT_EQ(page_->evaluate("location.search"), "");  // the token does not stay in the address
  page_->click("#run");
  ASSERT_TRUE(page_->wait_for("document.getElementById('status').textContent === 'running'"));
  ASSERT_TRUE(
      page_->wait_for("parseFloat(document.getElementById('normal-force').textContent) > "
                      "30.0",
                      60.0));
  EXPECT_TRUE(page_->wait_for("parseFloat(document.getElementById('achieved').textContent) > 0"));
  page_->click("#run");
  ASSERT_TRUE(page_->wait_for(connected));
  come_to_rest();
  const auto frame = simulation_->frame();
  const studies::LiveRow& row = frame->picture.row;
  EXPECT_GT(row.normal_force, 0.0);
  EXPECT_NEAR(shown("indentation"), 1e3 * row.indentation, 0.51e-3);
  EXPECT_NEAR(shown("normal-force"), 1e3 * row.normal_force, 0.51e-1);
  EXPECT_GT(frame->picture.force_error, 0.0);
  EXPECT_NE(text("normal-force").find("\u00b1"), std::string::npos) << text("normal-force");
  EXPECT_NEAR(shown("torque"), 1e6 * frame->picture.measured.wrench.torque.norm(), 0.51e-1);
  EXPECT_NEAR(shown("time"), row.time, 0.51e-3);
  EXPECT_NEAR(shown("touching"), frame->picture.measured.contact->touching, 0.0);
  page_->click("#units");
  ASSERT_TRUE(
      page_->wait_for("document.getElementById('normal-force').textContent.endsWith(' gf')"));
  EXPECT_NEAR(shown("indentation"), 100.0 * row.indentation, 0.51e-4);
  EXPECT_NEAR(shown("normal-force"), row.normal_force / 9.80665e-3, 0.51e-2);
}

TEST_F(LivePage, StepsResetsAndObeysSliders) {
  const double period = simulation_->rig().period();
  for (int i = 1; i <= 3; ++i) {
    page_->click("#step");
    ASSERT_TRUE(page_->wait_for(
        fmt::format("document.getElementById('time').textContent === '{:.3f} s'", i * period)));
  }
  EXPECT_EQ(page_->evaluate("document.getElementById('contact_force').offsetParent"), nullptr);
  slide("depth", 0.8);
  slide("natural_frequency", 0.25);
  page_->click("#free");
  come_to_rest();
  const studies::LiveState& state = simulation_->frame()->state;
  const studies::LiveLimits& limits = simulation_->rig().limits();
  EXPECT_NEAR(state.settings.depth,
              limits.depth.least + 0.8 * (limits.depth.most - limits.depth.least), 1e-9);
  EXPECT_NEAR(state.settings.natural_frequency, 5.0 + 0.25 * 115.0, 1e-6);
  EXPECT_EQ(state.rate, 0.0);
  EXPECT_NEAR(shown("depth-value"), 1e3 * state.settings.depth, 0.51e-3);
  page_->click("#reset");
  ASSERT_TRUE(page_->wait_for("document.getElementById('time').textContent === '0.000 s'"));
  page_->evaluate("document.activeElement.blur()");
  page_->press_key("s");  // by keyboard
  ASSERT_TRUE(page_->wait_for(
      fmt::format("document.getElementById('time').textContent === '{:.3f} s'", period)));
}

TEST_F(LivePage, SpacePausesWhateverHasTheFocus) {
  const std::string running = "document.getElementById('status').textContent === 'running'";
  for (const char* focus : {"#run", "#reset", "#theme", "#free", "#depth"}) {
    page_->evaluate(fmt::format("document.querySelector('{}').focus()", focus));
    page_->press_key(" ");
    EXPECT_TRUE(page_->wait_for(running)) << focus;
    page_->press_key(" ");
    EXPECT_TRUE(page_->wait_for(connected)) << focus;
  }
  EXPECT_EQ(page_->evaluate("document.getElementById('free').checked"), false);
  page_->evaluate("document.getElementById('free').focus()");
  page_->press_key("Enter");
  EXPECT_TRUE(page_->wait_for("document.getElementById('free').checked"));
}

TEST_F(LivePage, SaysHowMuchSlowerThanRealTimeItIs) {
  EXPECT_EQ(page_->evaluate("Controls.pace(0.037)"), "0.037, 27 times slower than real time");
  EXPECT_EQ(page_->evaluate("Controls.pace(0.5)"), "0.50, 2 times slower than real time");
  EXPECT_EQ(page_->evaluate("Controls.pace(1)"), "1.0");
}

TEST_F(LivePage, PlotsShowEveryTick) {
  // What a plot writes, with its box; the last tick lies close to the right end.
  const nlohmann::json written = page_->evaluate(R"((() => {
    const canvas = document.getElementById('plot-force'), pen = canvas.getContext('2d');
    const plot = new Plot(canvas, { x: () => 'indentation [cm]', y: () => 'force [gf]' }, [{ colour: '--accent' }]);
    plot.series[0].points = [[0, 0], [0.21, 30]];
    const texts = [], write = pen.fillText;
    pen.fillText = (text, x, y) => {
      const size = pen.measureText(text), left = x - size.actualBoundingBoxLeft, right = x + size.actualBoundingBoxRight;
      const box = [left, y - size.actualBoundingBoxAscent, right, y + size.actualBoundingBoxDescent];
      const over = texts.some((t) => t.box[0] < box[2] && box[0] < t.box[2] && t.box[1] < box[3] && box[1] < t.box[3]);
      const out = left < -1 || right > canvas.clientWidth + 1 || box[3] > canvas.clientHeight + 1;
      texts.push({ text, box, bad: over || out });
    };
    plot.draw();
    pen.fillText = write;
    return [texts.map((t) => t.text), texts.filter((t) => t.bad).map((t) => t.text)];
  })())");
  for (const char* text : {"0.0", "0.1", "0.2", "indentation [cm]", "force [gf]"})
    EXPECT_EQ(std::ranges::count(written[0], text), 1) << text << " in " << written[0];
  EXPECT_TRUE(written[1].empty()) << written[1];
}

TEST_F(LiveForcePage, SetsTheContactForce) {
  EXPECT_TRUE(page_->wait_for("document.getElementById('contact_force').offsetParent !== null"));
  slide("contact_force", 0.5);
  page_->click("#step");
  ASSERT_TRUE(page_->wait_for(
      "document.getElementById('contact_force-value').textContent.endsWith(' mN')"));
  come_to_rest();
  const studies::Span span = *simulation_->rig().limits().contact_force;
  EXPECT_NEAR(simulation_->frame()->state.settings.contact_force, 0.5 * (span.least + span.most),
              1e-9);
  EXPECT_EQ(page_->evaluate(crowded), nlohmann::json::array());
}

/// A finger of triangles with a skin.
class LiveSolidPage : public LivePage {
 protected:
  lattice::PressSetup press() const override {
    lattice::PressSetup setup = LivePage::press();
    setup.geometry = fingers::solid_dome(32, 24);
    setup.lattice.spacing = setup.geometry.tip_radius / 8;  // four cells through its wall
    // As hard to turn as the rubber about the wrist: a lighter hand begins to sway when it holds.
    setup.rod.density *= 12.0;
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
    setup.hardware.skin.taxels = meshes::taxel_rings(*meshes::shape_of(setup.geometry), 3, 6, 1e-3);
    return setup;
  }
};

TEST_F(LiveSolidPage, IsPressedAndPulledAsAnyFinger) {
  page_->click("#run");
  ASSERT_TRUE(page_->wait_for(
      "parseFloat(document.getElementById('normal-force').textContent) > 10.0", 60.0));
  page_->click("#run");
  ASSERT_TRUE(page_->wait_for(connected));
  come_to_rest();
  EXPECT_GT(shown("touching"), 0.0);
  EXPECT_NEAR(shown("indentation"), 1e3 * simulation_->frame()->picture.row.indentation, 0.51e-3);
  double most = 0.0;
  for (const auto& taxel : simulation_->frame()->picture.measured.taxels)
    most = std::max(most, taxel.normal_stress);
  EXPECT_GT(most, 0.0);
  EXPECT_NEAR(page_
                  ->evaluate("parseFloat(document.getElementById('skin-most').textContent.match("
                             "/[0-9.]+/)[0])")
                  .get<double>(),
              1e-3 * most, 1e-3);
  // What touches is painted: here all of it sticks.
  EXPECT_EQ(page_->evaluate("fingertipPage.scene.pressed.geometry.attributes.position.count"),
            simulation_->frame()->picture.finger.contact.size());
  EXPECT_EQ(page_->evaluate("document.getElementById('pressure-legend').hidden"), false);
  EXPECT_EQ(page_->evaluate("document.getElementById('slip-legend').hidden"), true);
  page_->click("#controller");  // off: the rod is free
  page_->drag("#handle", 60.0, 0.0);
  ASSERT_TRUE(page_->wait_for("'held' in document.getElementById('handle').dataset"));
  if (const char* folder = std::getenv("FINGERTIP_SCREENSHOTS"))
    page_->screenshot(std::filesystem::path(folder) / "solid.png");
}

TEST_F(LivePage, TheHandPullsTheRodAndFeelsIt) {
  page_->click("#controller");  // off: the rod is free
  // Taken while the simulation waits: a rod that falls may leave the handle's place between asking
  // for it and pressing the button there.
  page_->drag("#handle", 60.0, 0.0);
  ASSERT_TRUE(page_->wait_for("'held' in document.getElementById('handle').dataset"));
  // The largest force shown: the spring may have relaxed before anybody asks.
  page_->evaluate(R"((() => {
    const shown = document.getElementById('hand-force');
    window.felt = 0;
    new MutationObserver(() => { felt = Math.max(felt, parseFloat(shown.textContent) || 0); })
      .observe(shown, { childList: true, characterData: true, subtree: true });
  })())");
  page_->press_key(" ");
  ASSERT_TRUE(page_->wait_for("document.getElementById('status').textContent === 'running'"));
  ASSERT_TRUE(page_->wait_for("felt > 0"));
  // The rod follows the hand and the spring relaxes.
  ASSERT_TRUE(
      page_->wait_for("parseFloat(document.getElementById('hand-force').textContent) < 0.5", 60.0));
  const meshes::Vector3 start(0.0, 0.0, -0.03);
  const auto held = simulation_->frame();
  EXPECT_GT((held->picture.finger.endpoint - start).norm(), 1e-3);
  page_->release_mouse();
  ASSERT_TRUE(page_->wait_for("document.getElementById('hand-force').textContent === '–'"));
}

/// However long the finger has rested, on an axis from zero to the depth.
TEST_F(LivePage, ShowsTheWholePressFromZeroToItsDepth) {
  EXPECT_EQ(page_->evaluate("fingertipPage.forcePlot.range(0)"), nlohmann::json({0, 3}));
  const nlohmann::json kept = page_->evaluate(R"((() => {
    const rows = [];
    for (let i = 0; i < 100000; ++i) rows.push([1e-3 * i, Math.min(3e-3, 1e-5 * i), 0.2 * Math.min(1, i / 300) ** 1.5]);
    const some = Page.thinned(rows, 2000);
    return [some.length, some.filter((row) => row[1] < 3e-3).length, some[0][0], some[some.length - 1][0]];
  })())");
  EXPECT_LE(kept[0], 2001);
  EXPECT_GT(kept[1], 200);
  EXPECT_EQ(kept[2], 0.0);
  EXPECT_NEAR(kept[3].get<double>(), 99.999, 1e-9);
}

TEST_F(LivePage, ShowsMarkersAndAContinuumThatComesLater) {
  EXPECT_EQ(page_->evaluate("document.getElementById('marker-legend').hidden"), false);
  EXPECT_NEAR(double(page_->evaluate(
                  "fingertipPage.scene.markers.geometry.attributes.position.array[5]")),
              0.6, 1e-6);
  studies::Reference later = small_reference();
  later.response.append([] {
    meshes::PressSample sample;
    sample.indentation = 5e-3;
    sample.normal_force = 0.5;
    return sample;
  }());
  const auto samples = later.response.samples().size();
  server_->show_continuum(later.response);
  ASSERT_TRUE(page_->wait_for(
      fmt::format("fingertipPage.about.reference.length === {}", samples)));
  EXPECT_TRUE(page_->wait_for("fingertipPage.forcePlot.series[0].label === 'continuum'"));
}

TEST_F(LivePage, ComesBackAfterAReload) {
  page_->click("#run");
  ASSERT_TRUE(page_->wait_for("parseFloat(document.getElementById('time').textContent) > 0.02"));
  page_->reload();
  ASSERT_TRUE(page_->wait_for("document.getElementById('status').textContent === 'running'"));
  // The simulation went on, and the curve is whole: the page has the rows from the start again.
  ASSERT_TRUE(page_->wait_for("fingertipPage.rows.length > 20 && fingertipPage.rows[0][0] < 5e-3"));
}

TEST_F(LivePage, NoTextOverlapsAtTwoSizesInBothThemes) {
  page_->click("#free");
  page_->click("#run");
  ASSERT_TRUE(
      page_->wait_for("parseFloat(document.getElementById('indentation').textContent) > "
                      "0.2",
                      60.0));
  page_->drag("#handle", 30.0, 10.0);
  page_->click("#run");
  const char* folder = std::getenv("FINGERTIP_SCREENSHOTS");  // where to keep the pictures
  for (const char* theme : {"light", "dark"}) {
    page_->evaluate(
        fmt::format("document.documentElement.dataset.theme !== '{}' && "
                    "document.getElementById('theme').click()",
                    theme));
    for (const auto& [width, height] : {std::pair{1280, 800}, std::pair{1600, 1000}}) {
      page_->resize(width, height);
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
      // The longest that the header may have to say.
      page_->evaluate("document.getElementById('achieved').textContent = Controls.pace(0.037)");
      EXPECT_EQ(page_->evaluate(crowded), nlohmann::json::array()) << theme << ' ' << width;
      const nlohmann::json scrolls = page_->evaluate(
          "document.documentElement.scrollHeight > innerHeight || "
          "document.documentElement.scrollWidth > innerWidth");
      EXPECT_EQ(scrolls, false) << theme << ' ' << width;
      if (folder != nullptr)
        page_->screenshot(std::filesystem::path(folder) / fmt::format("{}_{}.png", theme, width));
    }
  }
}

TEST_F(LivePage, TheSceneIsDrawn) {
  // WebGL without a graphics card: some pixels of the canvas are the plane's, the rod's, the tip's.
  const nlohmann::json pixels = page_->evaluate(
      "(() => { const s = fingertipPage.scene; s.draw(); const g = s.renderer.getContext(); const "
      "w "
      "= g.drawingBufferWidth, h = g.drawingBufferHeight; const p = new Uint8Array(4 * w * h); "
      "g.readPixels(0, 0, w, h, g.RGBA, g.UNSIGNED_BYTE, p); let n = 0; for (let i = 3; i < "
      "p.length; i += 4) n += p[i] > 0; return n / (w * h); })()");
  EXPECT_GT(pixels.get<double>(), 0.1);
  EXPECT_LT(pixels.get<double>(), 0.9);
}
