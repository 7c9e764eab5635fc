#include "calibration/press_fit/damping_models.h"

#include <algorithm>
#include <boost/math/interpolators/cubic_hermite.hpp>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>

#include "lattice/dynamics/time_step.h"
#include "lattice/model/cut_model.h"
#include "lattice/press/press.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::VectorXd;
using meshes::InvalidInput;
using meshes::to_text;

namespace {

bool is_positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

VectorXd positive(const std::vector<double>& values, const char* key, const char* unit) {
  for (const double value : values)
    if (!is_positive(value))
      throw InvalidInput({key, to_text(value) + " " + unit, "must be finite and positive",
                          "remove the point, or mend it"});
  return VectorXd::Map(values.data(), Index(values.size()));
}

double retardation_time_of(const VectorXd& parameters) {
  if (parameters.size() != 1)
    throw InvalidInput({"parameters", std::to_string(parameters.size()),
                        "tests of damping have one parameter, retardation_time",
                        "fit moduli by other tests"});
  const double tau = parameters(0);
  if (!std::isfinite(tau) || tau < 0.0)
    throw InvalidInput({"rubber.retardation_time", to_text(tau) + " s",
                        "tau must be finite and not negative", "start at a positive time"});
  return tau;
}

}  // namespace

LossFactorModel::LossFactorModel(const std::vector<double>& frequencies)
    : frequencies_(positive(frequencies, "frequency", "Hz")) {}

CurveSlopes LossFactorModel::evaluate(const VectorXd& retardation_time) {
  const double tau = retardation_time_of(retardation_time);
  const VectorXd omega = 2.0 * std::numbers::pi * frequencies_;
  return {tau * omega, omega};
}

CreepModel::CreepModel(const std::vector<double>& times) : times_(positive(times, "time", "s")) {}

CurveSlopes CreepModel::evaluate(const VectorXd& retardation_time) {
  const double tau = retardation_time_of(retardation_time);
  CurveSlopes result{VectorXd::Ones(times_.size()), Eigen::MatrixXd::Zero(times_.size(), 1)};
  for (Index i = 0; tau > 0.0 && i < times_.size(); ++i) {
    const double share = times_(i) / tau;
    result.value(i) = -std::expm1(-share);
    // share/tau alone overflows where the exponential is long zero.
    result.jacobian(i, 0) = share < 700.0 ? -share / tau * std::exp(-share) : 0.0;
  }
  return result;
}

namespace {

/// Of the parabola through each point and its neighbours, at the ends through the three last.
std::vector<double> parabola_slopes(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t m = std::clamp<std::size_t>(i, 1, x.size() - 2);
    const double left = (y[m] - y[m - 1]) / (x[m] - x[m - 1]);
    const double right = (y[m + 1] - y[m]) / (x[m + 1] - x[m]);
    const double bend = (right - left) / (x[m + 1] - x[m - 1]);
    slopes.push_back(left + bend * (2.0 * x[i] - x[m] - x[m - 1]));
  }
  return slopes;
}

}  // namespace

StaticForce interpolated_force(const meshes::PressResponse& response) {
  std::vector<double> x = {0.0}, y = {0.0};
  for (const meshes::PressSample& sample : response.samples()) {
    if (!(sample.indentation > x.back()) || !std::isfinite(sample.indentation) ||
        !std::isfinite(sample.normal_force))
      throw InvalidInput({"indentation", to_text(sample.indentation) + " m",
                          "indentations must be positive and increase, forces be finite",
                          "remove the point"});
    x.push_back(sample.indentation);
    y.push_back(sample.normal_force);
  }
  if (x.size() < 4)
    throw InvalidInput({"static curve", std::to_string(x.size() - 1) + " samples",
                        "a stiffness needs at least three samples", "press to more depths"});
  const double depth = x.back();
  std::vector<double> slopes = parabola_slopes(x, y);
  slopes.front() = 0.0;
  using Cubic = boost::math::interpolators::cubic_hermite<std::vector<double>>;
  const auto cubic = std::make_shared<const Cubic>(std::move(x), std::move(y), std::move(slopes));
  return [cubic, depth](double indentation) -> ForceAndStiffness {
    if (indentation <= 0.0) return {};
    if (!(indentation <= depth))
      throw InvalidInput({"indentation", to_text(indentation) + " m",
                          "the static curve ends at " + to_text(depth) + " m",
                          "press deeper, or end the ramp earlier"});
    return {(*cubic)(indentation), cubic->prime(indentation)};
  };
}

RampModel::RampModel(const std::vector<double>& times, const Ramp& ramp, const StaticForce& force)
    : elastic_(positive(times, "time", "s")), viscous_(elastic_.size()) {
  positive({ramp.speed}, "ramp.speed", "m/s");
  positive({ramp.duration}, "ramp.duration", "s");
  for (Index i = 0; i < elastic_.size(); ++i) {
    const double time = elastic_(i);
    const bool moving = time <= ramp.duration;
    const ForceAndStiffness found = force(ramp.speed * std::min(time, ramp.duration));
    elastic_(i) = found.force;
    viscous_(i) = moving ? ramp.speed * found.stiffness : 0.0;
  }
}

CurveSlopes RampModel::evaluate(const VectorXd& retardation_time) {
  return {elastic_ + retardation_time_of(retardation_time) * viscous_, viscous_};
}

namespace {

/// Forces at the samples; the response holds further depths between them.
VectorXd press(lattice::PressSetup setup, double retardation_time) {
  setup.rubber.retardation_time = retardation_time;
  const auto outcome = lattice::run_press(setup);
  const auto& depths = setup.protocol.samples;
  VectorXd force(Index(depths.size()));
  std::size_t next = 0;
  for (const meshes::PressSample& sample : outcome.response.samples())
    if (next < depths.size() && std::abs(sample.indentation - depths[next]) <= 1e-12 * depths[next])
      force(Index(next++)) = sample.normal_force;
  if (next < depths.size())
    throw meshes::NotConverged("moving press: no force at " + to_text(depths[next]) +
                               " m; press less deep (calibration.depth)");
  return force;
}

/// That a press with this tau takes at rest [s].
double time_step(lattice::PressSetup setup, double retardation_time) {
  setup.rubber.retardation_time = retardation_time;
  const auto model = lattice::build_tip(setup.geometry, setup.rubber, setup.lattice);
  const lattice::StepController steps(model, nullptr, setup.integrator, setup.time_step);
  return steps.divide(setup.controller.period, {});
}

}  // namespace

MovingPressModel::MovingPressModel(lattice::PressSetup setup,
                                   const std::vector<double>& indentations, double relative_step)
    : setup_(std::move(setup)), relative_step_(relative_step) {
  positive(indentations, "indentation", "m");
  if (indentations.empty())
    throw InvalidInput({"indentations", "none", "a press needs depths", "give at least one"});
  if (!(relative_step > 0.0 && relative_step <= 0.5))
    throw InvalidInput({"relative_step", to_text(relative_step),
                        "the step of the difference lies above 0 and is at most 0.5",
                        "give about 0.05"});
  if (setup_.lattice.model == lattice::ModelKind::published)
    throw InvalidInput({"lattice.model", "published",
                        "its dampers follow a rule of their own and do not know tau",
                        "choose central, hookean or network"});
  meshes::PressProtocol& protocol = setup_.protocol;
  protocol.lateral *= indentations.back() / protocol.depth;  // in proportion to the indentation
  protocol.mode = meshes::DriveMode::quasi_static;
  protocol.depth = indentations.back();
  protocol.samples = indentations;
  const auto broken = setup_.violations();
  if (!broken.empty()) throw InvalidInput(broken);
}

CurveSlopes MovingPressModel::evaluate(const VectorXd& retardation_time) {
  const double tau = retardation_time_of(retardation_time);
  const double step = relative_step_ * std::max(tau, smallest_time);
  const double low = std::max(0.0, tau - step), high = tau + step;
  lattice::PressSetup setup = setup_;
  setup.time_step = time_step(setup, std::max(high, setup.rubber.retardation_time));
  const VectorXd below = press(setup, low), above = press(setup, high);
  return {press(setup, tau), (above - below) / (high - low)};
}

}  // namespace fingertip::calibration::inline press_fit
