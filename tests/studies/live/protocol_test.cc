#include "studies/live/protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

using namespace fingertip;
using namespace fingertip::studies;

namespace {

template <class Message>
Message parsed(const std::string& text) {
  const auto result = parse_message(text);
  EXPECT_TRUE(std::holds_alternative<LiveMessage>(result)) << text;
  return std::get<Message>(std::get<LiveMessage>(result));
}

bool refused(const std::string& text) {
  return std::holds_alternative<std::string>(parse_message(text));
}

LiveFrame small_frame() {
  LiveFrame frame;
  frame.number = 7;
  frame.epoch = 2;
  frame.status = LiveStatus::running;
  frame.picture.row = {0.5, 1e-3, 0.25, 0.01, 0.011, 2e-4};
  frame.picture.finger.boundary = {{0.1, 0.2, 0.3}, {-0.1, -0.2, -0.3}};
  frame.picture.finger.held = {0, 1};
  meshes::ContactPoint point{.place = {0.4, 0.5, 0.6}, .area = 4e-6, .normal_traction = 700.0};
  point.shear = {3.0, -4.0, 0.0};
  point.state = meshes::ContactState::slip;
  frame.picture.finger.contact = {point};
  frame.picture.markers = {{0.7, 0.8, 0.9}};
  return frame;
}

}  // namespace

TEST(Protocol, TakesEveryMessage) {
  EXPECT_EQ(parsed<Transport>(R"({"type":"run"})"), Transport::run);
  EXPECT_EQ(parsed<Transport>(R"({"type":"pause"})"), Transport::pause);
  EXPECT_EQ(parsed<Transport>(R"({"type":"step"})"), Transport::step);
  EXPECT_EQ(parsed<Transport>(R"({"type":"reset"})"), Transport::reset);
  EXPECT_EQ(parsed<Acknowledge>(R"({"type":"ack","frame":12})").number, 12u);
  const auto change = parsed<Adjust>(R"({"type":"set","name":"depth","value":-0.001})");
  EXPECT_EQ(change.name, "depth");
  EXPECT_EQ(change.value, -0.001);
  EXPECT_EQ(parsed<HandHolds>(R"({"type":"hold","place":[1,2.5,-3e-2]})").place,
            meshes::Vector3(1.0, 2.5, -0.03));
  parsed<HandLetsGo>(R"({"type":"release"})");
}

TEST(Protocol, RefusesWhatItDoesNotKnow) {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "null",
                           "7",
                           "\"run\"",
                           "{}",
                           R"({"type":7})",
                           R"({"type":"fly"})",
                           R"({"type":"ack"})",
                           R"({"type":"ack","frame":-1})",
                           R"({"type":"ack","frame":1.5})",
                           R"({"type":"set"})",
                           R"({"type":"set","name":"depth"})",
                           R"({"type":"set","name":"depth","value":"1"})",
                           R"({"type":"set","name":"depth","value":1e99})",
                           R"({"type":"set","name":"mass","value":1})",
                           R"({"type":"set","name":3,"value":1})",
                           R"({"type":"hold"})",
                           R"({"type":"hold","place":[1,2]})",
                           R"({"type":"hold","place":[1,2,null]})",
                           R"({"type":"hold","place":[1,2,1e300]})",
                           R"({"type":"hold","place":[1,2,3,4]})",
                           R"({"type":"run"} trailing)",
                           "\xff\xfe{}"})
    EXPECT_TRUE(refused(text)) << text;
  EXPECT_TRUE(refused(std::string(longest_message + 1, ' ')));
  EXPECT_TRUE(refused(std::string(longest_message, '[')));
}

TEST(Protocol, FramesAreLaidOutAsTheReadmeSays) {
  const std::string bytes = encode_frame(small_frame(), {small_frame().picture.row});
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  ASSERT_EQ(length % 4, 0u);
  const auto json = nlohmann::json::parse(bytes.substr(4, length));
  EXPECT_EQ(json.at("number"), 7);
  EXPECT_EQ(json.at("status"), "running");
  EXPECT_EQ(json.at("masses"), 2);
  EXPECT_EQ(json.at("rows"), 1);
  EXPECT_EQ(json.at("normal_force"), 0.25);
  EXPECT_FALSE(json.contains("hand"));
  EXPECT_EQ(json.at("contact"), 1);
  EXPECT_EQ(json.at("markers"), 1);
  ASSERT_EQ(bytes.size(), 4 + length + 2 * 12 + 24 + 4 + 28 + 12);
  std::vector<float> numbers(12);
  std::memcpy(numbers.data(), bytes.data() + 4 + length, 48);
  EXPECT_EQ(numbers[2], 0.3f);
  EXPECT_EQ(numbers[6], 0.5f);
  EXPECT_EQ(numbers[8], 0.25f);
  EXPECT_EQ(bytes[4 + length + 49], 1);
  std::vector<float> contact(7);
  std::memcpy(contact.data(), bytes.data() + bytes.size() - 40, 28);
  EXPECT_EQ(contact, (std::vector<float>{0.4f, 0.5f, 0.6f, 2e-3f, 700.0f, 5.0f, 1.0f}));
  std::vector<float> marker(3);
  std::memcpy(marker.data(), bytes.data() + bytes.size() - 12, 12);
  EXPECT_EQ(marker, (std::vector<float>{0.7f, 0.8f, 0.9f}));
}

TEST(Protocol, TellsTheLimitsOfAContactForceWhereOneIsHeld) {
  LiveScene scene;
  const auto limits = [&] { return nlohmann::json::parse(encode_scene(scene)).at("limits"); };
  EXPECT_FALSE(limits().contains("contact_force"));
  scene.limits.contact_force = Span{0.02, 0.3};
  EXPECT_EQ(limits().at("contact_force"), nlohmann::json({0.02, 0.3}));
}

TEST(Protocol, TellsTheSkinAndWhatItFeels) {
  LiveScene scene;
  const auto told = [&] { return nlohmann::json::parse(encode_scene(scene)).at("taxels"); };
  EXPECT_TRUE(told().empty());
  scene.taxels = {{{1e-3, -2e-3, 9e-3}, meshes::Vector3::UnitZ(), 3.141592653589793e-6}};
  EXPECT_EQ(told().at(0).at(1), -2e-3);
  EXPECT_NEAR(told().at(0).at(2).get<double>(), 2e-3, 1e-12);
  LiveFrame frame = small_frame();
  frame.picture.measured.taxels = {{300.0, -20.0, 4.0}};
  const std::string bytes = encode_frame(frame, {});
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  EXPECT_EQ(nlohmann::json::parse(bytes.substr(4, length)).at("taxels"),
            nlohmann::json({{300.0, -20.0, 4.0}}));
}

TEST(Protocol, NumbersThatAreNoneBecomeNull) {
  LiveFrame frame = small_frame();
  frame.picture.row.normal_force = std::nan("");
  frame.failure = "\xff";
  const std::string bytes = encode_frame(frame, {});
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), 4);
  const auto json = nlohmann::json::parse(bytes.substr(4, length));
  EXPECT_TRUE(json.at("normal_force").is_null());
}

TEST(Protocol, TellsTheErrorOfTheForceWhereTheContactIsKnown) {
  LiveFrame frame = small_frame();
  const auto json = [&] {
    const std::string bytes = encode_frame(frame, {});
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data(), 4);
    return nlohmann::json::parse(bytes.substr(4, length));
  };
  EXPECT_FALSE(json().contains("force_error"));
  frame.picture.measured.contact.emplace();
  EXPECT_TRUE(json().at("force_error").is_null());
  frame.picture.force_error = 0.01;
  EXPECT_EQ(json().at("force_error"), 0.01);
}
