#include "calibration/material_tests/relaxing_test.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/material/relaxation_branches.h"

namespace fingertip::calibration::inline material_tests {

namespace {

/// Of ln l in a step; the parabola errs by its fourth power.
constexpr double longest_step = 0.02;

}  // namespace

std::array<double, 2> stress_parts(TestKind kind, const std::array<double, 3>& kirchhoff,
                                   double deformation) {
  if (kind == TestKind::simple_shear) {
    const double shear = (kirchhoff[0] - kirchhoff[2]) / std::hypot(2.0, deformation);
    const double across =
        0.5 * (kirchhoff[0] + kirchhoff[2] - 2.0 * kirchhoff[1] - deformation * shear);
    return {shear - deformation * across, across};
  }
  const std::size_t free = kind == TestKind::uniaxial ? 1 : 2;
  return {(kirchhoff[0] - kirchhoff[free]) / (deformation * deformation), 0.0};
}

std::array<double, 2> part_weights(TestKind kind, StressMeasure measure, double deformation) {
  if (kind == TestKind::simple_shear) return {1.0, deformation};
  return {measure == StressMeasure::cauchy ? deformation * deformation : deformation, 0.0};
}

RelaxingTest::RelaxingTest(const MaterialTest& test) : count_(test.deformation.size()) {
  if (test.kind == TestKind::volumetric) return;
  std::vector<std::size_t> points(count_);
  std::iota(points.begin(), points.end(), std::size_t(0));
  if (test.course != TestCourse::slow) {
    follow(test.path, test.kind, test.time, points);
    return;
  }
  if (!test.rate) return;
  const double rest = rest_of(test.kind);
  // From rest towards larger deformations, then towards smaller ones.
  const auto split = std::ranges::lower_bound(test.deformation, rest) - test.deformation.begin();
  for (const bool up : {true, false}) {
    std::vector<std::size_t> side(up ? points.begin() + split : points.begin(),
                                  up ? points.end() : points.begin() + split);
    if (side.empty()) continue;
    if (!up) std::ranges::reverse(side);
    std::vector<double> times;
    for (const std::size_t p : side)
      times.push_back(std::abs(test.deformation[p] - rest) / *test.rate);
    follow({{0.0, times.back()}, {rest, test.deformation[side.back()]}}, test.kind, times, side);
  }
}

std::size_t RelaxingTest::state(double deformation) {
  if (states_.empty() || states_.back() != deformation) states_.push_back(deformation);
  return states_.size() - 1;
}

void RelaxingTest::go_to(TestKind kind, double deformation, double duration, std::size_t point) {
  const double from = states_.back();
  const double stretched = kind == TestKind::simple_shear ? 0.5 * std::abs(deformation - from)
                                                          : std::abs(std::log(deformation / from));
  const int parts = duration > 0.0 ? std::max(1, int(std::ceil(stretched / longest_step))) : 1;
  for (int i = 0; i < parts; ++i) {
    const auto between = [&](double part) {
      return from + (i + part) / parts * (deformation - from);
    };
    const std::size_t start = states_.size() - 1;
    const std::size_t middle = duration > 0.0 ? state(between(0.5)) : start;
    const std::size_t end = state(i + 1 == parts ? deformation : between(1.0));
    steps_.push_back({duration / parts, start, middle, end, fresh_});
    points_.push_back(i + 1 == parts ? point : none);
    fresh_ = false;
  }
}

void RelaxingTest::follow(const StrainPath& path, TestKind kind, const std::vector<double>& times,
                          const std::vector<std::size_t>& points) {
  fresh_ = true;
  states_.push_back(rest_of(kind));
  double time = path.time.front();
  std::size_t next = 0;
  for (std::size_t i = 0; i < path.time.size(); ++i) {
    for (; next < times.size() && times[next] < path.time[i]; ++next) {
      go_to(kind, path.at(times[next]), times[next] - time, points[next]);
      time = times[next];
    }
    // A stress at the time of a sudden change is that after it.
    const bool sudden = i + 1 < path.time.size() && path.time[i + 1] == path.time[i];
    const bool read = !sudden && next < times.size() && times[next] == path.time[i];
    go_to(kind, path.deformation[i], path.time[i] - time, read ? points[next++] : none);
    time = path.time[i];
  }
}

PartTable RelaxingTest::now(const PartTable& equilibrium) const {
  PartTable result(Eigen::Index(count_), equilibrium.cols());
  for (std::size_t i = 0; i < steps_.size(); ++i)
    if (points_[i] != none)
      result.row(Eigen::Index(points_[i])) = equilibrium.row(Eigen::Index(steps_[i].end));
  return result;
}

RelaxingTest::Branch RelaxingTest::branch(const PartTable& equilibrium, double tau) const {
  const Eigen::Index columns = equilibrium.cols();
  Branch result{PartTable(Eigen::Index(count_), columns), PartTable(Eigen::Index(count_), columns)};
  Eigen::RowVectorXd held(columns), slope(columns), change(columns), bent(columns);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.fresh) {
      held.setZero();
      slope.setZero();
    }
    const PronyMoments m(step.duration, tau);
    const auto start = equilibrium.row(Eigen::Index(step.start)),
               middle = equilibrium.row(Eigen::Index(step.middle)),
               end = equilibrium.row(Eigen::Index(step.end));
    change = end - start;
    bent = 4.0 * (change - 2.0 * (middle - start));
    slope = m.decay * slope +
            (m.decay_slope * held + m.gain_slope * change + m.bend_slope * bent) / tau;
    held = m.decay * held + m.gain * change + m.bend * bent;
    if (points_[i] == none) continue;
    result.held.row(Eigen::Index(points_[i])) = held;
    result.by_time.row(Eigen::Index(points_[i])) = slope;
  }
  return result;
}

}  // namespace fingertip::calibration::inline material_tests
