/// The key of a fit: whatever its judgement reads of a curve is in it.
#include "studies/fits/models/fit_models.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

using namespace fingertip::studies;

namespace {

/// A file that is accepted and one that is not may hold the same loading.
TEST(FitModels, EverythingOfACurveIsInItsKey) {
  FitInput input;
  fingertip::calibration::Curve curve;
  curve.name = "a";
  curve.x = {1e-4, 2e-4};
  curve.y = {0.1, 0.2};
  input.curves = {curve};
  input.curves[0].kind = CurveKind::creep;
  const std::string before = curve_inputs(input, 0).dump();
  const std::vector<std::pair<const char*, std::function<void(FitCurve&)>>> changes = {
      {"name", [](FitCurve& c) { c.name = "b"; }},
      {"quantities", [](FitCurve& c) { c.y_quantity = "stress [Pa]"; }},
      {"x", [](FitCurve& c) { c.x[1] = 3e-4; }},
      {"y", [](FitCurve& c) { c.y[1] = 0.3; }},
      {"sigma",
       [](FitCurve& c) {
         c.sigma = {0.01, 0.01};
       }},
      {"time",
       [](FitCurve& c) {
         c.time = {0.0, 1.0};
       }},
      {"travel", [](FitCurve& c) { c.is_travel = true; }},
      {"zero", [](FitCurve& c) { c.zero_is_sought = true; }},
      {"in time", [](FitCurve& c) { c.in_time = true; }},
      {"rows", [](FitCurve& c) { c.course.rows = 12; }},
      {"noise", [](FitCurve& c) { c.course.noise = 0.01; }},
      {"rows of a value", [](FitCurve& c) { c.course.rows_per_value = 3.0; }},
      {"loop", [](FitCurve& c) { c.course.loop = -0.1; }},
      {"play", [](FitCurve& c) { c.course.play = 1e-5; }},
      {"hold", [](FitCurve& c) { c.course.hold_time = 10.0; }},
      {"relaxation", [](FitCurve& c) { c.course.relaxation = 0.2; }},
      {"held", [](FitCurve& c) { c.course.held_time = {0.0}, c.course.held_y = {0.2}; }},
      {"way back", [](FitCurve& c) { c.course.back_x = {1e-4}, c.course.back_y = {0.1}; }},
      {"lines",
       [](FitCurve& c) {
         c.rows.rows = {2, 3};
       }},
      {"condition", [](FitCurve& c) { c.condition = "press.contact=stick"; }},
      {"known errors", [](FitCurve& c) { c.known_errors = {{0.02}}; }},
      {"excess", [](FitCurve& c) { c.finite_excess = {0.04}; }}};
  for (const auto& [what, change] : changes) {
    FitInput other = input;
    change(other.curves[0]);
    EXPECT_NE(curve_inputs(other, 0).dump(), before) << what;
  }
}

}  // namespace
