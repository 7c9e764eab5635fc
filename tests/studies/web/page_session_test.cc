// A page by itself: the same messages as a server's, from settings that went through JSON.
#include "studies/web/page_session.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "lattice/model/formulation.h"
#include "tests/coarse_press.h"
#include "tests/fingers.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

WebPress small_press() {
  WebPress press;
  press.setup = coarse_press();
  press.reference = {{1e-3, 0.03, 1e-4}, {2e-3, 0.1, meshes::unknown}};
  return press;
}

WebPress through_json(const WebPress& press) {
  WebPress read;
  meshes::read_json(nlohmann::json::parse(meshes::json_of(press).dump()), read);
  return read;
}

/// What a session answers when it has nothing more to do.
std::deque<WebMessage> run_to_rest(PageSession& session) {
  session.run(PageSession::Seconds(30.0));
  return session.answers();
}

std::string last_frame(std::deque<WebMessage> answers) {
  return answers.empty() || answers.back().is_text ? "" : answers.back().bytes;
}

nlohmann::json head_of(const std::string& frame) {
  std::uint32_t length = 0;
  std::memcpy(&length, frame.data(), 4);
  return nlohmann::json::parse(frame.substr(4, length));
}

}  // namespace

TEST(WebPress, ComesBackFromJson) {
  WebPress press = small_press();
  lattice::PressSetup& setup = press.setup;
  setup.integrator = lattice::Integrator::mass_scaled;
  setup.time_step = 1e-4;
  setup.rubber.relaxation.branches = {{0.2, 0.1}};
  setup.protocol.samples = {0.1e-3, 1e-3};
  setup.protocol.contact = meshes::ContactMode::coulomb;
  setup.protocol.friction = 1.0 / 3.0;
  for (const bool profile : {false, true}) {
    if (profile) setup.geometry = meshes::Geometry::of_profile(fingers::solid());
    const WebPress read = through_json(press);
    EXPECT_EQ(meshes::json_of(read), meshes::json_of(press));
    EXPECT_EQ(read.setup.time_step, setup.time_step);
    EXPECT_EQ(read.setup.protocol.samples, setup.protocol.samples);
    EXPECT_EQ(read.setup.rubber.relaxation.branches.size(), 1U);
  }
}

TEST(PageSession, SpeaksAsTheServerDoes) {
  PageSession session(through_json(small_press()));
  std::deque<WebMessage> greeting = session.answers();
  ASSERT_EQ(greeting.size(), 1U);
  PacedRig paced(small_press().setup, {true, 1.0, {}});
  LiveScene scene = scene_of(paced.rig());
  scene.reference = {{1e-3, 0.03, 1e-4}, {2e-3, 0.1, meshes::unknown}};
  scene.reference_name = "continuum";
  EXPECT_EQ(greeting.front().bytes, encode_scene(scene));

  for (const char* text : {R"({"type":"step"})", R"({"type":"set","name":"depth","value":0.0005})",
                           R"({"type":"step"})"}) {
    session.take(text);
    paced.obey(std::get<LiveMessage>(parse_message(text)));
  }
  while (!paced.idle()) paced.advance();
  Viewer viewer;
  EXPECT_EQ(last_frame(run_to_rest(session)), viewer.send(paced.frame(), paced.rows()));
}

TEST(PageSession, SendsAFrameOnlyWhenTheLastOneIsAcknowledged) {
  PageSession session(small_press());
  session.answers();
  EXPECT_EQ(run_to_rest(session).size(), 1U);
  session.take(R"({"type":"step"})");
  std::this_thread::sleep_for(2 * PacedRig::frame_interval);
  EXPECT_TRUE(run_to_rest(session).empty());
  session.take(R"({"type":"ack","frame":1})");
  const nlohmann::json frame = head_of(last_frame(run_to_rest(session)));
  EXPECT_EQ(frame.at("number"), 2);
  EXPECT_NEAR(frame.at("time"), 1e-3, 1e-12);
}

TEST(PageSession, AnswersWhatIsNoMessageAndGoesOn) {
  PageSession session(small_press());
  session.answers();
  session.take("nonsense");
  const std::deque<WebMessage> answers = session.answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_TRUE(answers.front().is_text);
  EXPECT_EQ(nlohmann::json::parse(answers.front().bytes).at("type"), "error");
  EXPECT_NE(last_frame(run_to_rest(session)), "");
}

TEST(PageSession, RunsNoFasterThanTheClock) {
  PageSession session(small_press());
  session.take(R"({"type":"set","name":"rate","value":0.05})");
  session.take(R"({"type":"run"})");
  // A period of the controller takes 0.02 s then.
  const auto start = PacedRig::Clock::now();
  while (PacedRig::Clock::now() - start < PageSession::Seconds(0.3))
    std::this_thread::sleep_for(session.run(PageSession::Seconds(0.01)));
  const PageSession::Seconds passed = PacedRig::Clock::now() - start;
  const nlohmann::json first = head_of(last_frame(session.answers()));
  session.take(R"({"type":"ack","frame":1})");
  session.take(R"({"type":"pause"})");
  std::this_thread::sleep_for(PacedRig::frame_interval);
  const nlohmann::json last = head_of(last_frame(run_to_rest(session)));
  EXPECT_EQ(first.at("number"), 1);
  EXPECT_GT(last.at("time"), 0.0);
  EXPECT_LE(last.at("time"), 0.05 * passed.count() + 1.5e-3);
}

TEST(PageSession, GoesOnWithTheWholeAndACoarserLatticeWhenTheHandTakesTheRod) {
  WebPress press = small_press();
  press.setup.lattice.spacing /= 2.4;  // a part of the tip moves in real time, the whole does not
  press.setup.lattice.constants =
      lattice::hookean_constants(press.setup.rubber, press.setup.lattice.spacing);
  press.coarser = {small_press().setup};
  PageSession session(through_json(press));
  session.take(R"({"type":"run"})");
  session.run(PageSession::Seconds(0.2));
  session.answers();
  session.take(R"({"type":"ack","frame":1})");
  session.take(R"({"type":"hold","place":[0.001,0,-0.03]})");
  std::this_thread::sleep_for(2 * PacedRig::frame_interval);
  session.run(PageSession::Seconds(0.2));
  const std::deque<WebMessage> answers = session.answers();
  ASSERT_EQ(answers.size(), 2U);
  ASSERT_TRUE(answers.front().is_text);
  const nlohmann::json scene = nlohmann::json::parse(answers.front().bytes);
  EXPECT_EQ(scene.at("title"), "hookean lattice, R/5, stick contact, coarser to keep up");
  EXPECT_EQ(head_of(answers.back().bytes).at("masses"), scene.at("masses"));
}
