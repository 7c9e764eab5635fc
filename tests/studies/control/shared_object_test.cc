#include <gtest/gtest.h>

#include <cstdlib>

#include "studies/control/shared_object_controller.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using namespace fingertip;
using lattice::ControllerFailed;
using meshes::Vector3;

namespace {

/// A controller in C whose parts a test can leave out or spoil.
struct Source {
  std::string abi = "uint32_t fingertip_controller_abi(void) { return FINGERTIP_CONTROLLER_ABI; }";
  std::string create =
      "int32_t fingertip_controller_create(const fingertip_task* task, void** self) {"
      " *self = calls; return task->size == sizeof *task && task->period > 0.0 ? 0 : 1; }";
  std::string command =
      "int32_t fingertip_controller_command(void* self, const fingertip_measurement* m,"
      " fingertip_command* command) { int* n = self; ++*n; command->kind = 1;"
      " command->wrench.force[2] = *n; command->wrench.torque[0] = m->time; return 0; }";
  std::string reset =
      "int32_t fingertip_controller_reset(void* self) { *(int*)self = 0; return 0; }";
  std::string destroy = "void fingertip_controller_destroy(void* self) { (void)self; }";

  std::string text() const {
    return "#include <fingertip_controller.h>\n#include <math.h>\nstatic int calls[1];\n" + abi +
           "\n" + create + "\n" + command + "\n" + reset + "\n" + destroy + "\n";
  }
};

class SharedObject : public testing::Test {
 protected:
  /// Compiles `source` as any user would, without the project's build.
  fs::path build(const Source& source) {
    const fs::path code = place_ / ("controller" + std::to_string(++built_) + ".c");
    const fs::path object = fs::path(code).replace_extension(".so");
    write_text(code, source.text());
    const std::string command = std::string(FINGERTIP_C_COMPILER) +
                                " -std=c99 -Wall -Wextra -Wpedantic -Werror -shared -fPIC -I" +
                                FINGERTIP_CONTROL_FOLDER + " -o " + object.string() + " " +
                                code.string();
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    return object;
  }
  /// Loading `object` and asking it for a command fails, and the reason holds `part`.
  void expect_failure(const fs::path& object, const std::string& part) {
    try {
      studies::SharedObjectController controller(object, task_);
      controller.command({});
      ADD_FAILURE() << "did not fail: " << part;
    } catch (const ControllerFailed& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("controller"), std::string::npos) << error.what();
    }
  }

  TemporaryFolder place_;
  lattice::ControlTask task_;
  int built_ = 0;
};

}  // namespace

TEST_F(SharedObject, CommandsAndResets) {
  studies::SharedObjectController controller(build({}), task_);
  lattice::Measurement m;
  m.time = 0.25;
  EXPECT_EQ(std::get<lattice::Wrench>(controller.command(m)).force, Vector3(0, 0, 1));
  const auto second = std::get<lattice::Wrench>(controller.command(m));
  EXPECT_EQ(second.force, Vector3(0, 0, 2));
  EXPECT_EQ(second.torque, Vector3(0.25, 0, 0));
  controller.reset();
  EXPECT_EQ(std::get<lattice::Wrench>(controller.command(m)).force, Vector3(0, 0, 1));
}

TEST_F(SharedObject, MayCommandATarget) {
  Source source;
  source.command =
      "int32_t fingertip_controller_command(void* self, const fingertip_measurement* m,"
      " fingertip_command* command) { (void)self; command->kind = FINGERTIP_COMMAND_TARGET;"
      " command->target = m->set_point; return m->has_set_point ? 0 : 1; }";
  task_.path = [](double time) {
    lattice::Target target;
    target.pose.position = {0.0, 0.0, time};
    target.pose.orientation = Eigen::AngleAxisd(0.5, Vector3::UnitX());
    target.acceleration.angular_velocity = {1, 2, 3};
    return target;
  };
  studies::SharedObjectController controller(build(source), task_);
  lattice::Measurement m;
  m.time = 0.125;
  const auto target = std::get<lattice::Target>(controller.command(m));
  EXPECT_EQ(target.pose.position, Vector3(0.0, 0.0, 0.125));
  EXPECT_EQ(target.pose.orientation.coeffs(), task_.path(0.0).pose.orientation.coeffs());
  EXPECT_EQ(target.acceleration.angular_velocity, Vector3(1, 2, 3));
}

TEST_F(SharedObject, WhatCannotBeLoadedIsRefused) {
  expect_failure(place_ / "nowhere.so", "no such file");
  write_text(place_ / "text.so", "no ELF header");
  expect_failure(place_ / "text.so", "cannot be loaded");
  Source old;
  old.abi = "uint32_t fingertip_controller_abi(void) { return 0; }";
  expect_failure(build(old), "version 0");
  Source nameless;
  nameless.abi.clear();
  expect_failure(build(nameless), "fingertip_controller_abi");
  Source incomplete;
  incomplete.reset.clear();
  expect_failure(build(incomplete), "fingertip_controller_reset");
}

TEST_F(SharedObject, WhatItAnswersWrongEndsTheRun) {
  const auto answering = [](const std::string& body) {
    Source source;
    source.command =
        "int32_t fingertip_controller_command(void* self, const fingertip_measurement* m,"
        " fingertip_command* command) { (void)self; (void)m; (void)command; " +
        body + " }";
    return source;
  };
  expect_failure(build(answering("return 7;")), "command() returned 7");
  expect_failure(build(answering("return 0;")), "kind 0");
  expect_failure(build(answering("command->kind = 1; command->wrench.force[1] = NAN; return 0;")),
                 "not finite");
  expect_failure(build(answering("command->kind = 2; return 0;")), "length one");
  Source unwilling;
  unwilling.create =
      "int32_t fingertip_controller_create(const fingertip_task* task, void** self) {"
      " (void)task; *self = calls; return -3; }\n"
      "const char* fingertip_controller_error(void* self) {"
      " return self ? \"wrong\" : \"no licence\"; }";
  expect_failure(build(unwilling), "create() returned -3 (no licence)");
}
