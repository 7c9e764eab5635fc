#include "studies/control/messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "studies/control/c_structs.h"

using namespace fingertip;
using lattice::ControllerFailed;
using lattice::Wrench;
using meshes::Vector3;
using nlohmann::json;

namespace {

/// Numbers that no short decimal text can hold.
lattice::Measurement awkward() {
  lattice::Measurement m;
  m.time = 1.0 / 3.0;
  m.pose.position = {0.1, -1e-300, 2.0 / 3.0};
  m.pose.orientation = Eigen::AngleAxisd(0.1, Vector3(1, 2, 3).normalized());
  m.twist = {{1e-17, 4.0 / 7.0, -1.0 / 9.0}, {0.3, 0.2, 0.1}};
  m.wrench = {{5e-324, 1.0 / 11.0, -13.0 / 17.0}, {1.7976931348623157e308, 0.0, -0.0}};
  m.contact = {7, 1.0 / 70.0, {{0.7, 0.8, 0.9}, {1.1, 1.2, 1.3}}};
  return m;
}

void expect_refused(const std::string& line, const std::string& part) {
  try {
    studies::parse_command(line);
    ADD_FAILURE() << "accepted " << line.substr(0, 200);
  } catch (const ControllerFailed& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace

TEST(Messages, NumbersArriveToTheLastBit) {
  const lattice::Measurement m = awkward();
  lattice::Target way;
  way.pose = m.pose;
  way.acceleration.velocity = {1.0 / 19.0, 0.0, 1e-5};
  lattice::ControlTask task;
  task.path = [&](double) { return way; };
  const json line = json::parse(studies::measurement_line(m, task, 42));
  EXPECT_EQ(line["message"], "measurement");
  EXPECT_EQ(line["cycle"], 42);
  EXPECT_EQ(line["time"].get<double>(), m.time);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = Eigen::Index(i);
    EXPECT_EQ(line["position"][i].get<double>(), m.pose.position[axis]);
    EXPECT_EQ(line["velocity"][i].get<double>(), m.twist.velocity[axis]);
    EXPECT_EQ(line["angular_velocity"][i].get<double>(), m.twist.angular_velocity[axis]);
    EXPECT_EQ(line["force"][i].get<double>(), m.wrench.force[axis]);
    EXPECT_EQ(line["torque"][i].get<double>(), m.wrench.torque[axis]);
    EXPECT_EQ(line["contact"]["force"][i].get<double>(), m.contact->on_tip.force[axis]);
    EXPECT_EQ(line["set_point"]["acceleration"][i].get<double>(), way.acceleration.velocity[axis]);
  }
  EXPECT_EQ(line["orientation"][0].get<double>(), m.pose.orientation.w());
  EXPECT_EQ(line["orientation"][3].get<double>(), m.pose.orientation.z());
  EXPECT_EQ(line["contact"]["touching"], 7);
}

TEST(Messages, ASkinIsToldAndFelt) {
  lattice::ControlTask task;
  task.taxels = {{{1e-3, 2e-3, 9.8e-3}, {0.1, 0.2, 0.97}, 1e-6},
                 {{0.0, 0.0, 10e-3}, Vector3::UnitZ(), 2e-6}};
  lattice::Measurement m = awkward();
  m.taxels = {{1.0 / 3.0, -20.0, 0.1}, {100.0, 1.0, 2.0}};
  const json hello = json::parse(studies::hello_line(task, 5.0, false));
  EXPECT_EQ(hello["task"]["taxels"][0]["normal"], json({0.1, 0.2, 0.97}));
  EXPECT_EQ(hello["task"]["taxels"][1]["area"].get<double>(), 2e-6);
  const json line = json::parse(studies::measurement_line(m, task, 0));
  EXPECT_EQ(line["taxels"], json({{1.0 / 3.0, -20.0, 0.1}, {100.0, 1.0, 2.0}}));
  const fingertip_task c_task = studies::c_task(task);
  ASSERT_EQ(c_task.taxel_count, 2u);
  EXPECT_EQ(c_task.taxels[0].place[2], 9.8e-3);
  EXPECT_EQ(c_task.taxels[0].normal[1], 0.2);
  EXPECT_EQ(c_task.taxels[1].area, 2e-6);
  const fingertip_measurement c = studies::c_measurement(m, task);
  ASSERT_EQ(c.taxel_count, 2u);
  EXPECT_EQ(c.taxels[0].normal_stress, 1.0 / 3.0);
  EXPECT_EQ(c.taxels[0].shear_u, -20.0);
  EXPECT_EQ(c.taxels[1].shear_v, 2.0);
}

TEST(Messages, WithoutTactileSensorAndWayThereAreNone) {
  lattice::Measurement m = awkward();
  m.contact.reset();
  const json line = json::parse(studies::measurement_line(m, {}, 0));
  EXPECT_FALSE(line.contains("contact"));
  EXPECT_FALSE(line.contains("set_point"));
  EXPECT_FALSE(line.contains("taxels"));
  EXPECT_EQ(studies::c_measurement(m, {}).taxel_count, 0u);
}

TEST(Messages, HelloTellsTheTask) {
  lattice::ControlTask task;
  task.inertia(0, 5) = 1.0 / 3.0;
  const json hello = json::parse(studies::hello_line(task, 2.5, true));
  EXPECT_EQ(hello["protocol"], "fingertip-control");
  EXPECT_EQ(hello["version"], 1);
  EXPECT_EQ(hello["resumed"], true);
  EXPECT_EQ(hello["timeout"], 2.5);
  EXPECT_EQ(hello["task"]["inertia"][0][5].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(hello["task"]["normal"][2], -1.0);
  EXPECT_EQ(hello["task"]["period"], task.period);
}

TEST(Messages, CommandsAreRead) {
  const auto wrench = std::get<Wrench>(studies::parse_command(R"({"wrench":[1,2,3,4,5.5,-6e-1]})"));
  EXPECT_EQ(wrench.force, Vector3(1, 2, 3));
  EXPECT_EQ(wrench.torque, Vector3(4, 5.5, -0.6));
  const auto target = std::get<lattice::Target>(studies::parse_command(
      R"({"target":{"position":[0,0,1],"orientation":[0,1,0,0],"angular_acceleration":[7,8,9]}})"));
  EXPECT_EQ(target.pose.position, Vector3(0, 0, 1));
  EXPECT_EQ(target.pose.orientation.x(), 1.0);
  EXPECT_EQ(target.acceleration.angular_velocity, Vector3(7, 8, 9));
  EXPECT_EQ(target.twist.velocity, Vector3(0, 0, 0));
}

TEST(Messages, WhatIsNoCommandIsRefusedWithTheReason) {
  expect_refused("", "not JSON");
  expect_refused("GET / HTTP/1.1", "not JSON");
  expect_refused(R"({"wrench":[NaN,0,0,0,0,0]})", "NaN");
  expect_refused(R"({"wrench":[1e999,0,0,0,0,0]})", "not JSON");
  expect_refused(std::string("\x00\xff\x1b[31m", 7), "?");
  expect_refused("[1,2,3]", "no JSON object");
  expect_refused("{}", "exactly one");
  expect_refused(R"({"wrench":[1,2,3]})", "6 numbers");
  expect_refused(R"({"wrench":[1,2,3,4,5,"6"]})", "6 numbers");
  expect_refused(R"({"wrench":[true,2,3,4,5,6]})", "6 numbers");
  expect_refused(R"({"wrnch":[1,2,3,4,5,6]})", "unknown field");
  expect_refused(R"({"wrench":[1,2,3,4,5,6],"target":{"position":[0,0,0]}})", "exactly one");
  expect_refused(R"({"target":[1,2,3]})", "position");
  expect_refused(R"({"target":{}})", "position");
  expect_refused(R"({"target":{"position":[0,0]}})", "3 numbers");
  expect_refused(R"({"target":{"position":[0,0,0],"orientation":[2,0,0,0]}})", "length one");
  expect_refused(R"({"target":{"position":[0,0,0],"speed":1}})", "unknown field");
  expect_refused(std::string(60000, '['), "not JSON");
}

TEST(Messages, OnlyThisVersionIsGreeted) {
  EXPECT_NO_THROW(studies::check_hello(R"({"protocol":"fingertip-control","version":1})"));
  EXPECT_NO_THROW(studies::check_hello(R"({"protocol":"fingertip-control","version":1,"by":"x"})"));
  for (const char* line :
       {R"({"protocol":"fingertip-control","version":2})", R"({"protocol":"other","version":1})",
        R"({"version":1})", R"({"protocol":"fingertip-control"})", "{}", "hello",
        R"({"protocol":"fingertip-control","version":"1"})"}) {
    EXPECT_THROW(studies::check_hello(line), ControllerFailed) << line;
  }
}
