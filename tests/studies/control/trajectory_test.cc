// One control law through every interface: the same trajectory.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "lattice/model/cut_model.h"
#include "lattice/press/press.h"
#include "studies/control/c_structs.h"
#include "studies/control/examples/shared_object/pid_law.h"
#include "studies/control/shared_object_controller.h"
#include "studies/control/socket_controller.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using namespace fingertip;

namespace {

/// The law of the examples as a subclass.
class PidLaw final : public lattice::Controller {
 public:
  explicit PidLaw(const lattice::ControlTask& task) : task_(task) {
    const fingertip_task order = studies::c_task(task);
    EXPECT_EQ(pid_start(&pid_, &order), 1);
  }
  lattice::Command command(const lattice::Measurement& measurement) override {
    const fingertip_measurement seen = studies::c_measurement(measurement, task_);
    fingertip_command answer = studies::empty_c_command();
    answer.kind = FINGERTIP_COMMAND_WRENCH;
    pid_follow(&pid_, &seen, &answer.wrench);
    return studies::command_of(answer);
  }
  void reset() override { pid_reset(&pid_); }

 private:
  lattice::ControlTask task_;
  pid_law pid_{};
};

lattice::PressSetup press_with(const lattice::ControllerFactory& factory) {
  lattice::PressSetup setup;
  setup.lattice.spacing = setup.geometry.tip_radius / 6.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.depth = 0.4e-3;
  setup.protocol.samples = {0.4e-3};
  setup.make_controller = factory;
  setup.threads = 1;
  setup.symmetry = false;  // as under controllers of others
  return setup;
}

lattice::PressOutcome press(const lattice::ControllerFactory& factory) {
  return lattice::run_press(press_with(factory));
}

/// What the force on the rod changes by when the rod's centre is elsewhere by one unit in the last
/// place: the stiffness of the bond times that [N]. Two laws that are equal but for round-off meet
/// no closer.
double resolution_of_force() {
  const lattice::PressSetup setup = press_with({});
  const lattice::LatticeModel model =
      lattice::build_tip(setup.geometry, setup.rubber, setup.lattice);
  double stiffness = 0.0;
  for (const lattice::EmbeddedPoint& tie : model.bond) stiffness += tie.stiffness;
  const double centre = lattice::rod_body(setup.geometry, setup.rod).centre.norm();
  return stiffness * std::numeric_limits<double>::epsilon() * centre;
}

/// Largest difference of any entry of the trace, relative to the largest value of that entry;
/// `resolution` of the forces on the rod [N].
double largest_difference(const lattice::PressOutcome& a, const lattice::PressOutcome& b,
                          double resolution = 0.0) {
  EXPECT_EQ(a.trace.size(), b.trace.size());
  if (a.trace.size() != b.trace.size()) return 1.0;
  double largest = 0.0;
  for (const auto entry :
       {&lattice::TraceRow::time, &lattice::TraceRow::indentation, &lattice::TraceRow::speed,
        &lattice::TraceRow::normal_force, &lattice::TraceRow::command_force,
        &lattice::TraceRow::plane_force, &lattice::TraceRow::elastic_energy}) {
    double scale = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < a.trace.size(); ++i) {
      scale = std::max(scale, std::abs(a.trace[i].*entry));
      difference = std::max(difference, std::abs(a.trace[i].*entry - b.trace[i].*entry));
    }
    const bool on_rod =
        entry == &lattice::TraceRow::normal_force || entry == &lattice::TraceRow::command_force;
    largest = std::max(largest, (difference - (on_rod ? resolution : 0.0)) / scale);
  }
  return largest;
}

class Interfaces : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    subclass_ = new lattice::PressOutcome(
        press([](const auto& task) { return std::make_unique<PidLaw>(task); }));
  }
  static void TearDownTestSuite() { delete subclass_; }

  static lattice::PressOutcome* subclass_;
  TemporaryFolder place_;
};
lattice::PressOutcome* Interfaces::subclass_ = nullptr;

}  // namespace

TEST_F(Interfaces, TheExampleIsTheBuiltInPid) {
  EXPECT_GT(subclass_->trace.back().normal_force, 0.005);  // it presses
  EXPECT_LT(largest_difference(*subclass_, press({}), resolution_of_force()), 1e-12);
  EXPECT_LT(resolution_of_force(), 1e-10 * subclass_->trace.back().normal_force);
}

TEST_F(Interfaces, ASharedObjectBuiltOutOfTreeGivesTheSameTrajectory) {
  const std::string build = (place_ / "build").string();
  const std::string cmake = FINGERTIP_CMAKE, folder = FINGERTIP_CONTROL_FOLDER;
  const std::string log = " >> " + (place_ / "log").string() + " 2>&1";
  const std::string configure =
      cmake + " -S " + folder + "/examples/shared_object -B " + build +
      " -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER=" + FINGERTIP_C_COMPILER + log;
  ASSERT_EQ(std::system(configure.c_str()), 0) << read_text(place_ / "log");
  ASSERT_EQ(std::system((cmake + " --build " + build + log).c_str()), 0)
      << read_text(place_ / "log");
  const fs::path object = place_ / "build/libpid.so";
  const lattice::PressOutcome outcome = press([&](const lattice::ControlTask& task) {
    return std::make_unique<studies::SharedObjectController>(object, task);
  });
  EXPECT_LT(largest_difference(*subclass_, outcome), 1e-12);
}

TEST_F(Interfaces, AnotherProcessGivesTheSameTrajectory) {
  for (const std::string& address :
       {"unix:" + (place_ / "socket").string(), std::string("tcp:127.0.0.1:0")}) {
    pid_t client = -1;
    const lattice::PressOutcome outcome = press([&](const lattice::ControlTask& task) {
      studies::SocketSettings settings;
      settings.address = studies::LocalAddress::parse(address);
      auto controller = std::make_unique<studies::SocketController>(settings, task);
      const std::string place = controller->address().text();
      client = ::fork();
      if (client == 0) {
        ::execl(FINGERTIP_CLIENT, FINGERTIP_CLIENT, place.c_str(), nullptr);
        ::_exit(127);
      }
      return controller;
    });
    EXPECT_LT(largest_difference(*subclass_, outcome), 1e-12);
    int status = -1;
    ::waitpid(client, &status, 0);
    EXPECT_EQ(status, 0) << "the client's exit status";
  }
}
