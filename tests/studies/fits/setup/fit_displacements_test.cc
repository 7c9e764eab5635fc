#include "studies/fits/setup/fit_displacements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>

#include "calibration/files/fit_file.h"
#include "lattice/press/static_press.h"
#include "meshes/press/markers.h"
#include "studies/files/json_entry.h"
#include "studies/files/read_fields.h"
#include "studies/fits/runs/calibration_stages.h"
#include "studies/jobs/cache.h"
#include "studies/presses/press_setup.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

constexpr double true_ratio = 0.46, true_modulus = 60e3;  // [1], [Pa]

/// A coarse network that sticks, pressed to 0.6 and 1.2 mm: forces of all depths, and displacements
/// of points that a camera sees, with noise.
class FitDisplacements : public testing::Test {
 protected:
  static std::vector<std::string> finger() {
    return {"lattice.model=network", "lattice.spacing=tip_radius/5", "press.contact=stick"};
  }

  static const lattice::StaticOutcome& pressed() {
    static const lattice::StaticOutcome outcome = [] {
      std::vector<std::string> sets = finger();
      for (const char* set :
           {"rubber.youngs_modulus=60 kPa", "rubber.poissons_ratio=0.46", "press.mode=static",
            "press.samples=[\"0.3 mm\", \"0.6 mm\", \"0.9 mm\", \"1.2 mm\"]", "sensor.markers=grid",
            "sensor.marker_pitch=3.4 mm"})
        sets.emplace_back(set);
      return lattice::run_static_press(press_setup(load_config({{}, sets, {}})));
    }();
    return outcome;
  }

  FitDisplacements() {
    std::ofstream forces(folder_ / "force.csv"), dots(folder_ / "dots.csv");
    std::mt19937 generator(3);
    std::normal_distribution<double> noise;
    forces << "indentation [mm];force [N]\n";
    for (const meshes::PressSample& sample : pressed().response.samples())
      forces << 1e3 * sample.indentation << ';'
             << sample.normal_force * (1.0 + 2e-3 * noise(generator)) << '\n';
    dots << titles;
    for (const meshes::MarkerRow& row : pressed().markers) {
      const double depth = 1e3 * row.indentation;
      if (std::abs(depth - 0.6) > 1e-9 && std::abs(depth - 1.2) > 1e-9) continue;
      dots << depth;
      for (int axis = 0; axis < 3; ++axis) dots << ',' << 1e3 * row.place(axis);
      for (int axis = 0; axis < 3; ++axis)
        dots << ',' << 1e3 * row.displacement(axis) + 0.01 * noise(generator);
      dots << '\n';
    }
  }

  LoadedConfig loaded(const std::vector<std::string>& files,
                      const std::vector<std::string>& further = {}) const {
    std::string data;
    for (const std::string& file : files)
      data += (data.empty() ? "\"" : ", \"") + (folder_ / file).string() + '"';
    std::vector<std::string> sets = finger();
    sets.insert(sets.end(), {"calibration.problem=experiment", "calibration.data=[" + data + "]",
                             "calibration.candidates=[]"});
    sets.insert(sets.end(), further.begin(), further.end());
    return load_config({{}, sets, {}});
  }

  calibration::FitFile calibrated(const LoadedConfig& config) const {
    const fs::path run = folder_ / "run";
    CalibrationStages stages(config, "", CalibrationStages::Failed::refused);
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    for (auto jobs = stages.next(run); !jobs.empty(); jobs = stages.next(run))
      for (const PlannedJob& planned : jobs) {
        const fs::path place = run / planned.name;
        fs::create_directories(place);
        planned.job.run(place, context);
        mark(planned.job, place, finished, 0.0);
      }
    return struct_of<calibration::FitFile>(read_entry(run / "calibration.json"));
  }

  std::string refusal(const LoadedConfig& config) const {
    try {
      split_data(config);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  static constexpr const char* titles =
      "indentation [mm],x [mm],y [mm],z [mm],displacement_x [mm],displacement_y [mm],"
      "displacement_z [mm]\n";
  const TemporaryFolder folder_;
};

}  // namespace

TEST_F(FitDisplacements, AloneTheyTellPoissonsRatioAndNoStiffness) {
  const calibration::FitFile fit = calibrated(loaded({"dots.csv"}));
  ASSERT_EQ(fit.parameters.size(), 1u);
  EXPECT_EQ(fit.parameters[0].name, "poissons_ratio");
  EXPECT_LT(fit.parameters[0].lower, true_ratio);
  EXPECT_GT(fit.parameters[0].upper, true_ratio);
  EXPECT_LT(fit.parameters[0].upper - fit.parameters[0].lower, 0.06);
  EXPECT_TRUE(fit.failed.empty());
  EXPECT_FALSE(fs::exists(folder_ / "run" / "material.toml"));
  for (const char* const file : {"displacements.json", "displacements.csv", "distances.json"})
    EXPECT_TRUE(fs::exists(folder_ / "run" / file)) << file;
}

/// The forces alone would leave the ratio to its usual range, and E with it.
TEST_F(FitDisplacements, BesideForcesTheyTellTheRatioAtWhichForcesTellE) {
  const calibration::FitFile fit = calibrated(loaded({"force.csv", "dots.csv"}));
  ASSERT_TRUE(fit.displacements);
  EXPECT_NEAR(fit.rubber.poissons_ratio, fit.displacements->poissons_ratio, 1e-12);
  ASSERT_EQ(fit.parameters.size(), 1u);
  EXPECT_EQ(fit.parameters[0].name, "modulus");
  EXPECT_LT(fit.parameters[0].lower, true_modulus);
  EXPECT_GT(fit.parameters[0].upper, true_modulus);
  EXPECT_TRUE(says(fit.statement, {"Displacements: Poisson's ratio", "Forces, at that ratio"}));
  ASSERT_FALSE(fit.sensitivities.empty());
  EXPECT_EQ(fit.sensitivities[0].name, "poissons_ratio");
  EXPECT_TRUE(fit.sensitivities[0].counts);
  // A uniform range of the interval's deviation.
  const calibration::DisplacementFitFile& ratio = *fit.displacements;
  EXPECT_NEAR(fit.sensitivities[0].step, (ratio.upper - ratio.lower) / 3.92, 2e-5);
  EXPECT_TRUE(fs::exists(folder_ / "run" / "material.toml"));
}

TEST_F(FitDisplacements, TheRatioIsTheirsWhateverModuliTheRubberIsGivenBy) {
  calibration::DisplacementFitFile found;
  found.poissons_ratio = 0.47;
  found.lower = 0.46;
  found.upper = 0.475;
  const std::string e = "rubber.youngs_modulus=50 kPa", g = "rubber.shear_modulus=18 kPa";
  for (const std::vector<std::string>& rubber : std::vector<std::vector<std::string>>{
           {},
           {e},
           {g},
           {"rubber.shore_hardness=30"},
           {e, "rubber.bulk_modulus=10 MPa"},
           {e, g},
           {"rubber.law=yeoh", "rubber.yeoh=[\"9 kPa\"]", "rubber.poissons_ratio=0.4"}}) {
    const LoadedConfig before = loaded({"force.csv"}, rubber), after = with_ratio(before, found);
    EXPECT_NEAR(after.config.press.rubber.poissons_ratio(), 0.47, 1e-12);
    EXPECT_EQ(after.config.press.lattice.spacing, before.config.press.lattice.spacing);
  }
}

TEST_F(FitDisplacements, ParametersAreAskedOfTheDataThatTellThem) {
  const SplitData split = split_data(loaded(
      {"force.csv", "dots.csv"},
      {"calibration.parameters=[\"youngs_modulus\", \"poissons_ratio\", \"slip\", \"bond\"]"}));
  ASSERT_TRUE(split.displacements);
  EXPECT_TRUE(split.has_forces);
  EXPECT_TRUE(split.displacements->freed.slip);
  EXPECT_FALSE(split.displacements->freed.compression);
  EXPECT_EQ(split.forces.config.calibration.parameters,
            (std::vector<std::string>{"modulus", "bond"}));
  EXPECT_EQ(split.forces.config.calibration.data.size(), 1u);
  EXPECT_FALSE(split_data(loaded({"force.csv"})).displacements);
  EXPECT_EQ(split_data(loaded({"dots.csv"}, {"calibration.frame=held"})).displacements->frame,
            calibration::FrameMotion::held);
}

TEST_F(FitDisplacements, WhatTheyCannotTellIsRefused) {
  EXPECT_TRUE(says(refusal(loaded({"dots.csv"}, {"calibration.parameters=[\"modulus\"]"})),
                   {"calibration.parameters", "Poisson's ratio alone"}));
  EXPECT_TRUE(says(refusal(loaded({"force.csv"}, {"calibration.parameters=[\"poissons_ratio\"]"})),
                   {"is told by measured displacements", "add a file of displacements"}));
  EXPECT_TRUE(says(refusal(loaded({"dots.csv"}, {"calibration.poisson_range=[0.4, 0.45]"})),
                   {"calibration.poisson_range", "leave it out"}));
  EXPECT_TRUE(says(refusal(loaded({"dots.csv", "dots.csv"})),
                   {"a second file of displacements", "two fingers one by one"}));
  EXPECT_TRUE(
      says(refusal(loaded({"dots.csv"}, {"press.lateral=0.2 mm", "press.lateral_path=after"})),
           {"press.lateral_path", "has none"}));
  std::ofstream(folder_ / "outside.csv") << titles << "1,0,0,90,0,0,0\n";
  EXPECT_TRUE(says(refusal(loaded({"outside.csv"})), {"outside"}));
  std::ofstream(folder_ / "few.csv") << titles << "1,0,0,9,0,0,0\n";
  EXPECT_TRUE(says(refusal(loaded({"few.csv"})), {"few: displacements", "at least 8 points"}));
}
