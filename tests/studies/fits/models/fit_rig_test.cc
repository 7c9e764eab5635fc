/// What the forces of a machine's travel tell before a fit, and which rigs files share.
#include "studies/fits/models/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "meshes/base/errors.h"
#include "studies/fits/models/fit_input.h"
#include "studies/fits/models/travel.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::Curve;
using calibration::MaterialParameter;

namespace {

/// Hertz behind a rig: F = 1000 N/m^1.5 · 1000 delta^1.5, touched at `touch`, so many before it.
Curve hertz(double touch, double compliance, const std::string& name = "press") {
  Curve curve;
  curve.name = name;
  curve.is_travel = true;
  for (int i = -5; i <= 40; ++i) {
    const double delta = 1e-4 * i, force = i > 0 ? 1e5 * std::pow(delta, 1.5) : 0.0;
    curve.x.push_back(touch + delta + compliance * force);
    curve.y.push_back(force);
  }
  return curve;
}

CalibrationSettings with(const RigSettings& rig) {
  CalibrationSettings settings;
  settings.rig = rig;
  return settings;
}

}  // namespace

TEST(FitRig, ForcesTellTheTouchOfAHertzianPress) {
  const Travel rigid = travel_of(hertz(0.28e-3, 0.0), {});
  EXPECT_NEAR(rigid.touch, 0.28e-3, 1e-9);
  EXPECT_NEAR(rigid.reach, 4e-3, 1e-9);
  // A known compliance is taken off; an unknown one, of a tenth of the travel here, hardly matters.
  RigSettings known;
  known.compliance = {false, 2e-5, 0.0, true};
  EXPECT_NEAR(travel_of(hertz(0.28e-3, 2e-5), with(known)).touch, 0.28e-3, 1e-9);
  EXPECT_NEAR(travel_of(hertz(0.28e-3, 2e-5), {}).touch, 0.28e-3, 0.1e-3);
}

TEST(FitRig, GivenTouchesAndPriorsGoBeforeWhatForcesTell) {
  RigSettings rig;
  rig.touch_offset = {false, 0.1e-3, 0.0};
  EXPECT_EQ(travel_of(hertz(0.28e-3, 0.0), with(rig)).touch, 0.1e-3);
  rig.touch_offset = {true, 0.2e-3, 0.01e-3};
  FitInput input;
  input.curves = {hertz(0.28e-3, 0.0)};
  input.curves[0].travel = travel_of(input.curves[0], with(rig));
  free_rigs(input);
  ASSERT_EQ(input.options.free.size(), 3U);  // compliance and zero behind it
  const calibration::FreeParameter& free = input.options.free[0];
  EXPECT_EQ(free.start, 0.2e-3);
  ASSERT_TRUE(free.prior);
  EXPECT_EQ(free.prior->deviation, 0.01e-3);
  EXPECT_LT(free.lower, 0.15e-3);
}

TEST(FitRig, FilesHaveTheirTouchAndMachinesTheirCompliance) {
  RigSettings rig;
  rig.compliance = rig.force_offset = {.fitted = true, .given = true};
  CalibrationSettings first = with(rig), second = first;
  second.machine = "B";
  FitInput input;
  input.options.free = {{.parameter = MaterialParameter::modulus, .start = 1e5}};
  for (const char* name : {"a", "b", "c"}) input.curves.push_back(hertz(1e-3, 1e-5, name));
  for (const std::size_t i : {0, 1, 2})
    input.curves[i].travel = travel_of(input.curves[i], i == 1 ? second : first);
  free_rigs(input);
  std::vector<std::string> labels;
  for (const auto& free : input.options.free) labels.push_back(calibration::label(free));
  EXPECT_EQ(labels,
            (std::vector<std::string>{"modulus", "touch_offset (a)", "compliance",
                                      "force_offset (a)", "touch_offset (b)", "compliance (B)",
                                      "force_offset (b)", "touch_offset (c)", "force_offset (c)"}));
  EXPECT_EQ(input.curves[0].travel->rig.compliance.place,
            input.curves[2].travel->rig.compliance.place);
  EXPECT_NE(input.curves[0].travel->rig.compliance.place,
            input.curves[1].travel->rig.compliance.place);
  EXPECT_EQ(material_parameters(input), 1U);
  EXPECT_EQ(rig_values(input).size(), 8U);  // two per file, two machines
}

TEST(FitRig, ValuesThatNobodyGaveAreTold) {
  const auto given = [](const CalibrationSettings& first, const CalibrationSettings& second,
                        MaterialParameter quantity) {
    FitInput input;
    input.curves = {hertz(0.0, 0.0, "a"), hertz(0.0, 0.0, "b")};
    input.curves[0].travel = travel_of(input.curves[0], first);
    input.curves[1].travel = travel_of(input.curves[1], second);
    std::vector<bool> result;
    for (const calibration::RigValue& each : rig_values(input))
      if (each.quantity == quantity) result.push_back(each.given);
    return result;
  };
  RigSettings rig;
  rig.compliance = rig.force_offset = {false, 0.0, 0.0, true};
  using enum MaterialParameter;
  EXPECT_EQ(given({}, {}, compliance), std::vector{false});
  // Files of one machine share its compliance, each has a zero of its own.
  EXPECT_EQ(given({}, with(rig), compliance), std::vector{true});
  EXPECT_EQ(given({}, with(rig), force_offset), (std::vector{false, true}));
  EXPECT_EQ(given({}, with(rig), touch_offset), (std::vector{false, false}));
}

/// A machine of which nothing is told is unknown within what is usual.
TEST(FitRig, WhatNobodyTellsIsUnknownWithinWhatIsUsual) {
  FitInput input;
  input.curves = {hertz(0.28e-3, 0.0)};
  for (const double x : input.curves[0].x) input.curves[0].time.push_back(2e3 * x);
  input.curves[0].travel = travel_of(input.curves[0], {});
  free_rigs(input);
  ASSERT_EQ(input.options.free.size(), 4U);
  const double force = input.curves[0].travel->force,
               span = input.curves[0].time.back() - input.curves[0].time.front();
  EXPECT_FALSE(input.options.free[0].prior) << "the touch is anywhere";
  EXPECT_EQ(input.options.free[1].prior->deviation, 2e-5);
  EXPECT_EQ(input.options.free[1].lower, 0.0);
  EXPECT_DOUBLE_EQ(input.options.free[2].prior->deviation, 1e-3 * force);
  EXPECT_DOUBLE_EQ(input.options.free[3].prior->deviation, 1e-3 * force / span);
  for (const calibration::RigValue& each : rig_values(input)) EXPECT_FALSE(each.given);
  // Rows before touch tell the zero: what was usual is of no interest.
  input.options.free.clear();
  input.curves[0].zero_is_sought = true;
  input.curves[0].travel = travel_of(input.curves[0], {});
  free_rigs(input);
  EXPECT_FALSE(input.options.free[2].prior);
}

TEST(FitRig, RefusesWhatCannotBe) {
  RigSettings late;
  late.touch_offset = {false, 1.0, 0.0};
  EXPECT_THROW(travel_of(hertz(0.0, 0.0), with(late)), meshes::InvalidInput);
  RigSettings drifting;
  drifting.drift.fitted = true;
  EXPECT_THROW(travel_of(hertz(0.0, 0.0), with(drifting)), meshes::InvalidInput);
  RigSettings one, other;
  one.compliance = {false, 2e-5, 0.0, true};
  other.compliance = {false, 1e-5, 0.0, true};
  FitInput input;
  input.curves = {hertz(0.0, 0.0, "a"), hertz(0.0, 0.0, "b")};
  input.curves[0].travel = travel_of(input.curves[0], with(one));
  input.curves[1].travel = travel_of(input.curves[1], with(other));
  EXPECT_THROW(free_rigs(input), meshes::InvalidInput);
}

TEST(FitRig, OneFileOfAMachineTellsItsCompliance) {
  RigSettings known;
  known.compliance = {true, 5e-5, 1e-6, true};
  FitInput input;
  input.curves = {hertz(0.0, 5e-5, "a"), hertz(0.0, 5e-5, "b")};
  input.curves[0].travel = travel_of(input.curves[0], {});
  input.curves[1].travel = travel_of(input.curves[1], with(known));
  free_rigs(input);
  ASSERT_TRUE(input.curves[0].travel->rig.compliance.place);
  EXPECT_EQ(input.curves[0].travel->rig.compliance.place,
            input.curves[1].travel->rig.compliance.place);
}

TEST(FitRig, ValuesBeforeTouchHaveATinyDepth) {
  FitInput input;
  input.curves = {hertz(0.28e-3, 0.0)};
  RigSettings held;
  held.touch_offset = {false, 0.28e-3, 0.0};
  input.curves[0].travel = travel_of(input.curves[0], with(held));
  const std::vector<double> depths =
      depths_of_values(input.curves[0], calibration::start_of(input.options));
  EXPECT_GT(depths.front(), 0.0);
  EXPECT_LT(depths.front(), input.curves[0].travel->depths.front());
  EXPECT_NEAR(depths.back(), 4e-3, 1e-12);
  std::vector<double> twice = input.curves[0].travel->depths;
  for (double& value : twice) value *= 2.0;
  EXPECT_NEAR(at_values(input.curves[0], calibration::start_of(input.options), twice).back(), 8e-3,
              1e-9);
}
