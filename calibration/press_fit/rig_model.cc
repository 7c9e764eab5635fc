#include "calibration/press_fit/rig_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

namespace {

constexpr double depth_step = 0.25;  // of ln delta
constexpr int depth_count = 18;      // from 1.4 % of the deepest on
constexpr Index max_neighbours = 5;

/// Derivatives of Lagrange's polynomials through the nearest points, at the points: slopes = D
/// values.
MatrixXd slope_matrix(const VectorXd& s) {
  const Index count = s.size(), points = std::min(count, max_neighbours);
  MatrixXd slopes = MatrixXd::Zero(count, count);
  for (Index at = 0; at < count; ++at) {
    const Index first = std::clamp<Index>(at - points / 2, 0, count - points);
    for (Index i = first; i < first + points; ++i) {
      // For i = at the sum of 1/(s_at - s_k), else the product without k = at over s_i - s_at.
      double slope = i == at ? 0.0 : 1.0 / (s(i) - s(at));
      for (Index k = first; k < first + points; ++k) {
        if (k == i || k == at) continue;
        if (i == at)
          slope += 1.0 / (s(at) - s(k));
        else
          slope *= (s(at) - s(k)) / (s(i) - s(k));
      }
      slopes(at, i) = slope;
    }
  }
  return slopes;
}

/// F over delta of one evaluation.
class PressCurve {
 public:
  PressCurve(const std::vector<double>& depths, const CurveSlopes& press) {
    Index first = press.value.size();
    while (first > 0 && press.value(first - 1) > 0.0) --first;
    const Index count = press.value.size() - first;
    if (count < 2)
      throw meshes::NotConverged(
          "a press has fewer than two positive forces: refine its lattice, or let the continuum "
          "answer");
    s_.resize(count);
    for (Index i = 0; i < count; ++i) s_(i) = std::log(depths[std::size_t(first + i)]);
    const MatrixXd slope = slope_matrix(s_);
    const VectorXd force = press.value.tail(count);
    value_ = force.array().log();
    slope_ = slope * value_;
    by_parameters_ = force.cwiseInverse().asDiagonal() * press.jacobian.bottomRows(count);
    slope_by_parameters_ = slope * by_parameters_;
  }

  struct Point {
    double force = 0.0, stiffness = 0.0;  ///< F, dF/ddelta
    Eigen::RowVectorXd by_parameters;
  };
  Point at(double delta) const {
    const Weights w = weights(std::log(delta));
    Point point;
    point.force = std::exp(dot(w));
    point.stiffness = point.force / delta *
                      (w.rise_a * value_(w.i) + w.rise_b * value_(w.j) + w.rise_c * slope_(w.i) +
                       w.rise_d * slope_(w.j));
    point.by_parameters =
        point.force * (w.a * by_parameters_.row(w.i) + w.b * by_parameters_.row(w.j) +
                       w.c * slope_by_parameters_.row(w.i) + w.d * slope_by_parameters_.row(w.j));
    return point;
  }

 private:
  /// Of the values and slopes at two depths, and their derivatives by ln delta.
  struct Weights {
    Index i = 0, j = 0;
    double a = 1.0, b = 0.0, c = 0.0, d = 0.0;
    double rise_a = 0.0, rise_b = 0.0, rise_c = 1.0, rise_d = 0.0;
  };
  Weights weights(double s) const {
    Weights w;
    const Index last = s_.size() - 1;
    if (s <= s_(0) || s >= s_(last)) {
      w.i = w.j = s <= s_(0) ? 0 : last;
      w.c = s - s_(w.i);
      return w;
    }
    w.j = Index(std::upper_bound(s_.begin(), s_.end(), s) - s_.begin());
    w.i = w.j - 1;
    const double h = s_(w.j) - s_(w.i), t = (s - s_(w.i)) / h;
    w.a = (1.0 + 2.0 * t) * (1.0 - t) * (1.0 - t);
    w.b = t * t * (3.0 - 2.0 * t);
    w.c = h * t * (1.0 - t) * (1.0 - t);
    w.d = h * t * t * (t - 1.0);
    w.rise_b = 6.0 * t * (1.0 - t) / h;
    w.rise_a = -w.rise_b;
    w.rise_c = (1.0 - t) * (1.0 - 3.0 * t);
    w.rise_d = t * (3.0 * t - 2.0);
    return w;
  }
  double dot(const Weights& w) const {
    return w.a * value_(w.i) + w.b * value_(w.j) + w.c * slope_(w.i) + w.d * slope_(w.j);
  }

  VectorXd s_, value_, slope_;  ///< ln delta, ln F, its derivative
  MatrixXd by_parameters_, slope_by_parameters_;
};

/// F(delta) at the end of a step from `before`.
class StepForce {
 public:
  StepForce(const PressCurve& press, const RelaxingForce::Step& step, double before)
      : press_(press), step_(step), before_(before) {}

  struct Point {
    double force = 0.0, stiffness = 0.0;
    PressCurve::Point end, middle;  ///< after long times; `middle` of a rubber that relaxes
  };
  Point at(double delta) const {
    Point point;
    point.end = press_.at(delta);
    point.force = step_.end * point.end.force + step_.rest;
    point.stiffness = step_.end * point.end.stiffness;
    if (step_.middle == 0.0) return point;
    point.middle = press_.at(0.5 * (before_ + delta));
    point.force += step_.middle * point.middle.force;
    point.stiffness += 0.5 * step_.middle * point.middle.stiffness;
    return point;
  }

 private:
  const PressCurve& press_;
  const RelaxingForce::Step& step_;
  double before_;
};

/// delta + c F(delta) = travel > 0: Newton's method, kept in a bracket.
double indentation_at(const StepForce& press, double compliance, double travel) {
  double low = 0.0, high = travel;
  const auto excess = [&](double delta) {
    return delta + compliance * press.at(delta).force - travel;
  };
  for (int doublings = 0; excess(high) < 0.0; ++doublings, high *= 1.25)
    if (doublings == 10)
      throw meshes::NotConverged("a rig of negative compliance, " + meshes::to_text(compliance) +
                                 " m/N, takes back more than the press gives");
  double delta = high;
  for (int i = 0; i < 200; ++i) {
    const StepForce::Point point = press.at(delta);
    const double value = delta + compliance * point.force - travel;
    (value > 0.0 ? high : low) = delta;
    const double next = delta - value / (1.0 + compliance * point.stiffness);
    const double chosen = next > low && next < high ? next : 0.5 * (low + high);
    if (std::abs(chosen - delta) <= 1e-15 * travel) return chosen;
    delta = chosen;
  }
  return delta;
}

}  // namespace

std::vector<double> depths_for_rig(double deepest) {
  std::vector<double> depths;
  for (int i = depth_count - 1; i >= 0; --i) depths.push_back(deepest * std::exp(-depth_step * i));
  return depths;
}

RigModel::RigModel(ForwardModel& press, std::vector<double> depths, Index press_parameters, Rig rig,
                   std::vector<double> position, std::vector<double> time, Index parameters,
                   std::vector<FitBranch> branches)
    : press_(&press),
      depths_(std::move(depths)),
      press_parameters_(press_parameters),
      rig_(rig),
      position_(std::move(position)),
      time_(std::move(time)),
      parameters_(parameters),
      branches_(std::move(branches)) {
  std::vector<meshes::Violation> found;
  const bool rising = std::ranges::is_sorted(depths_, std::less_equal<>()) && depths_.size() > 1;
  if (!rising || !(depths_.front() > 0.0))
    found.push_back({"depths", std::to_string(depths_.size()),
                     "a press behind a rig is known at two or more depths, positive and increasing",
                     "take depths_for_rig"});
  if (!time_.empty() && time_.size() != position_.size())
    found.push_back({"time", std::to_string(time_.size()),
                     "there must be a time per position, or none", "complete the list"});
  if (!branches_.empty() && (time_.empty() || !std::ranges::is_sorted(time_, std::less_equal<>())))
    found.push_back({"time", std::to_string(time_.size()),
                     "of a rubber that relaxes every position has its time, and times increase",
                     "give them, or no branches"});
  if (branches_.empty() && !rig_.drift.place && rig_.drift.value == 0.0) time_.clear();
  std::vector<FitQuantity> all;
  for (const auto member : rig_members) all.push_back(rig_.*member);
  for (const FitBranch& branch : branches_) all.insert(all.end(), {branch.share, branch.time});
  for (const FitQuantity& each : all)
    if (each.place && (*each.place < press_parameters_ || *each.place >= parameters_))
      found.push_back({"place", std::to_string(*each.place),
                       "what is of the rig or fades stands behind the press's parameters",
                       "change it"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

RigModel::Duration RigModel::loaded_since(std::size_t i, double offset) const {
  if (branches_.empty() || position_.size() < 2) return {};
  const double travel = position_[i] - offset;
  // Of the first position the step behind it tells the speed.
  const std::size_t from = i > 0 ? i - 1 : 0;
  const double way = position_[from + 1] - position_[from], span = time_[from + 1] - time_[from];
  const bool touches = i == 0 || position_[i - 1] <= offset;
  if (!touches) return {span, 0.0};
  if (!(way > 0.0)) return {};
  return {travel * span / way, -span / way};
}

CurveSlopes RigModel::evaluate(const VectorXd& parameters) {
  const PressCurve press(depths_, press_->evaluate(VectorXd(parameters.head(press_parameters_))));
  const double offset = rig_.touch_offset.in(parameters),
               compliance = rig_.compliance.in(parameters), zero = rig_.force_offset.in(parameters),
               drift = rig_.drift.in(parameters);
  const Index count = Index(position_.size());
  CurveSlopes result{VectorXd(count), MatrixXd::Zero(count, parameters_)};
  indentation_ = VectorXd::Zero(count);
  RelaxingForce relaxing(branches_, parameters);
  const RowVectorXd none = RowVectorXd::Zero(parameters_);
  double before = 0.0;  // delta of the position before, and its derivatives
  RowVectorXd before_slopes = none;
  for (Index i = 0; i < count; ++i) {
    const double t = time_.empty() ? 0.0 : time_[std::size_t(i)];
    result.value(i) = zero + drift * t;
    if (rig_.force_offset.place) result.jacobian(i, *rig_.force_offset.place) = 1.0;
    if (rig_.drift.place) result.jacobian(i, *rig_.drift.place) = t;
    const double travel = position_[std::size_t(i)] - offset;
    if (!(travel > 0.0)) {
      relaxing.reset();
      before = 0.0, before_slopes = none;
      continue;
    }
    const Duration duration = loaded_since(std::size_t(i), offset);
    const RelaxingForce::Step step = relaxing.step(duration.value);
    const StepForce force(press, step, before);
    const double delta = indentation_at(force, compliance, travel);
    const StepForce::Point point = force.at(delta);
    const double denominator = 1.0 + compliance * point.stiffness;
    if (!(denominator > 0.0))
      throw meshes::NotConverged("a rig of negative compliance, " + meshes::to_text(compliance) +
                                 " m/N, takes back more than the press gives");
    indentation_(i) = delta;
    result.value(i) += point.force;
    // dF = explicit + F' ddelta, ddelta = -dx0 - F dc - c dF.
    const auto value_of = [&](const PressCurve::Point& own) {
      RelaxingForce::Value value{own.force, none};
      if (own.by_parameters.size() > 0) value.slopes.head(press_parameters_) = own.by_parameters;
      return value;
    };
    RelaxingForce::Value end = value_of(point.end), middle = value_of(point.middle);
    middle.slopes += 0.5 * point.middle.stiffness * before_slopes;
    RowVectorXd duration_slopes = none, travel_slopes = none;
    if (rig_.touch_offset.place) {
      duration_slopes(*rig_.touch_offset.place) = duration.by_offset;
      travel_slopes(*rig_.touch_offset.place) = -1.0;
    }
    if (rig_.compliance.place) travel_slopes(*rig_.compliance.place) = -point.force;
    const RowVectorXd slopes =
        (relaxing.slopes(step, middle, end, duration_slopes) + point.stiffness * travel_slopes) /
        denominator;
    result.jacobian.row(i) += slopes;
    if (relaxing.empty()) continue;
    before_slopes = travel_slopes - compliance * slopes;
    end.slopes += point.end.stiffness * before_slopes;
    middle.slopes += 0.5 * point.middle.stiffness * before_slopes;
    relaxing.go_on(step, middle, end, duration_slopes);
    before = delta;
  }
  return result;
}

}  // namespace fingertip::calibration::inline press_fit
