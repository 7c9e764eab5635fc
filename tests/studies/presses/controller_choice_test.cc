#include "studies/presses/controller_choice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "calibration/surrogate/surrogate.h"
#include "lattice/control/adaptive_pid.h"
#include "lattice/control/hybrid_controller.h"
#include "studies/presses/press_job.h"
#include "tests/studies/configured.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace lattice = fingertip::lattice;
namespace calibration = fingertip::calibration;

namespace {

std::unique_ptr<lattice::Controller> made_by(const lattice::PressSetup& setup) {
  lattice::ControlTask task;
  task.path = [](double) { return lattice::Target{}; };
  return setup.make_controller(task);
}

calibration::Surrogate hertz(double factor) {
  std::vector<calibration::SurrogateSample> samples;
  for (int i = 1; i <= 12; ++i) {
    const double depth = 2.5e-4 * i;
    samples.push_back({depth, factor * 1300.0 * std::pow(depth, 1.5), 0.0});
  }
  return calibration::fit_surrogate(samples);
}

}  // namespace

TEST(ControllerChoice, ThePidNeedsNoMaker) {
  const auto setup = setup_of({});
  EXPECT_FALSE(setup.make_controller);
  EXPECT_EQ(setup.controller_identity, "");
  EXPECT_TRUE(setup.follows_path);
  EXPECT_FALSE(setup.duration.has_value());
}

TEST(ControllerChoice, MakesWhatTheTypeSays) {
  const auto adaptive = setup_of({"controller.type=adaptive"});
  EXPECT_NE(dynamic_cast<lattice::AdaptivePid*>(made_by(adaptive).get()), nullptr);
  EXPECT_TRUE(adaptive.follows_path);
  const auto force = setup_of({"controller.type=force", "controller.force=20 gf"});
  EXPECT_NE(dynamic_cast<lattice::ForceController*>(made_by(force).get()), nullptr);
  EXPECT_FALSE(force.follows_path);
  const auto hybrid = setup_of({"controller.type=hybrid"});
  EXPECT_NE(dynamic_cast<lattice::HybridController*>(made_by(hybrid).get()), nullptr);
  EXPECT_FALSE(hybrid.follows_path);
  EXPECT_FALSE(setup_of({"controller.type=hybrid", "press.mode=quasi-static"}).make_controller);
}

TEST(ControllerChoice, ForceControlEndsInTime) {
  // Rise 30 ms, 0.35 cm at 1 cm/s, ten time constants of 5 Hz.
  const auto setup = setup_of({"controller.type=hybrid"});
  EXPECT_NEAR(setup.duration.value(), 0.015 + 0.35 + 10.0 / (2.0 * 3.14159265 * 5.0), 1e-6);
  EXPECT_EQ(setup_of({"controller.type=hybrid", "press.duration=2 s"}).duration.value(), 2.0);
}

TEST(ControllerChoice, JobsDependOnTheControllerAndOnNothingThatItIgnores) {
  const auto key = [](std::vector<std::string> sets) {
    return press_job(setup_of(std::move(sets))).key();
  };
  EXPECT_EQ(key({}), key({"controller.force=20 gf"}));
  EXPECT_EQ(key({}), key({"controller.memory=20 ms"}));
  EXPECT_NE(key({}), key({"controller.setpoint_weight=0.5"}));
  const auto adaptive = [&](const char* further) {
    return key({"controller.type=adaptive", further});
  };
  EXPECT_NE(key({}), adaptive("run.threads=1"));
  EXPECT_EQ(adaptive("run.threads=1"), adaptive("controller.force=20 gf"));
  EXPECT_NE(adaptive("run.threads=1"), adaptive("controller.memory=20 ms"));
  EXPECT_NE(adaptive("run.threads=1"), adaptive("controller.adaptation=false"));
  EXPECT_NE(key({"controller.type=force"}), key({"controller.type=hybrid"}));
  EXPECT_NE(key({"controller.type=force"}),
            key({"controller.type=force", "controller.force=20 gf"}));
}

TEST(ControllerChoice, TheScheduleIsReadAndCounts) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "surrogate.json";
  const std::vector<std::string> sets{"controller.type=adaptive",
                                      "controller.schedule=" + file.string()};
  EXPECT_TRUE(says(press_refusal(sets), "surrogate.json"));
  calibration::write_surrogate_json(hertz(1.0), file);
  const std::string before = press_job(setup_of(sets)).key();
  calibration::write_surrogate_json(hertz(1.1), file);
  EXPECT_NE(press_job(setup_of(sets)).key(), before);
}

TEST(ControllerChoice, BrokenRulesNameTheKeyAndItsPlace) {
  for (const char* broken : {"controller.force_bandwidth=20 Hz", "controller.release_force=0.05 N",
                             "controller.force=0.005 N"})
    EXPECT_TRUE(says(press_refusal({"controller.type=hybrid", broken}), ": controller."));
}
