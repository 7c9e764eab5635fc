#include "lattice/press/loop_stability.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

namespace fingertip::lattice::inline press {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// The loop in the hand's own measure: its inertia is 1 in all motions, and time passes in units of
/// 1/omega. Without that, the units of a wrench beside those of a way spoil the eigenvalues.
struct Loop {
  Matrix6 inertia = Matrix6::Zero();  ///< of the rubber
  Eigen::VectorXd squares;
  MatrixXd shares;
  double damping, period, latency, filter, compensation;
};

Loop measured_by_hand(const Matrix6& hand, const HeldVibrations& rubber, double retardation_time,
                      const PidSettings& servo, double latency) {
  const double omega = 2.0 * std::numbers::pi * servo.natural_frequency;
  const Eigen::LLT<Matrix6> root(hand);
  const Matrix6 half = root.matrixL().solve(rubber.inertia);
  return {root.matrixL().solve(half.transpose()),
          rubber.squares / (omega * omega),
          root.matrixL().solve(rubber.shares),
          retardation_time * omega,
          servo.period * omega,
          latency * omega,
          1.0 - std::exp(-servo.derivative_filter * omega * servo.period),
          servo.bond_compensation};
}

/// d/dt (x, q, x', q') = A (x, q, x', q', W): hand and rubber under a wrench W at the endpoint.
MatrixXd equations_of_motion(const Loop& loop) {
  const Index modes = loop.squares.size(), d = 6 + modes;
  MatrixXd mass = MatrixXd::Identity(d, d);
  mass.topLeftCorner<6, 6>() += loop.inertia;
  mass.topRightCorner(6, modes) = loop.shares;
  mass.bottomLeftCorner(modes, 6) = loop.shares.transpose();
  const MatrixXd inverse = mass.inverse();
  const MatrixXd pull = inverse.rightCols(modes) * loop.squares.asDiagonal();
  MatrixXd matrix = MatrixXd::Zero(2 * d + 6, 2 * d + 6);
  matrix.block(0, d, d, d).setIdentity();
  matrix.block(d, 6, d, modes) = -pull;
  matrix.block(d, d + 6, d, modes) = -loop.damping * pull;
  matrix.block(d, 2 * d, d, 6) = inverse.leftCols<6>();
  return matrix;
}

/// What one period makes of motion, wrenches on their way (oldest last), filtered derivative and
/// integral (pid.cc).
MatrixXd one_period(const Loop& loop) {
  const MatrixXd equations = equations_of_motion(loop);
  const Index motion = equations.rows() - 6, velocity = motion / 2;
  const double whole = std::floor(loop.latency / loop.period + 1e-9);
  const double rest = std::max(0.0, loop.latency - whole * loop.period);
  const Index wrenches = 6 * (Index(whole) + 1), slope_at = motion + wrenches,
              oldest = slope_at - 6, sum_at = slope_at + 6, size = sum_at + 6;

  // The tip's wrench on the hand, just before the command: x'' - W.
  MatrixXd bond = MatrixXd::Zero(6, size);
  bond.leftCols(motion) = equations.block(velocity, 0, 6, motion);
  bond.middleCols<6>(oldest) = equations.block(velocity, motion, 6, 6) - Matrix6::Identity();
  MatrixXd slope = MatrixXd::Zero(6, size), sum = slope;
  slope.middleCols<6>(slope_at) = (1.0 - loop.filter) * Matrix6::Identity();
  slope.middleCols<6>(velocity) = -loop.filter * Matrix6::Identity();
  sum.middleCols<6>(sum_at).setIdentity();
  MatrixXd command = sum + 3.0 * slope - loop.compensation * bond;
  command.leftCols<6>() -= 3.0 * Matrix6::Identity();
  sum.leftCols<6>() = -loop.period * Matrix6::Identity();

  // Commands that act or will, the newest first.
  MatrixXd queue(wrenches + 6, size);
  queue << command, MatrixXd::Identity(size, size).middleRows(motion, wrenches);
  MatrixXd moved = MatrixXd::Identity(motion, size);
  const auto move = [&](double duration, Index wrench) {
    const MatrixXd flow = (equations * duration).exp();
    moved = flow.topLeftCorner(motion, motion) * moved +
            flow.topRightCorner(motion, 6) * queue.middleRows<6>(wrench);
  };
  if (rest > 0.0) move(rest, wrenches);
  move(loop.period - rest, wrenches - 6);

  MatrixXd after(size, size);
  after << moved, queue.topRows(wrenches), slope, sum;
  return after;
}

LoopMotion fastest(const MatrixXd& period_map, double period) {
  std::complex<double> largest = 0.0;
  for (const std::complex<double>& factor : period_map.eigenvalues())
    if (std::abs(factor) > std::abs(largest)) largest = factor;
  return {std::log(std::abs(largest)) / period,
          std::abs(std::arg(largest)) / (2.0 * std::numbers::pi * period)};
}

}  // namespace

double harmless_ratio(const PidSettings& servo, double latency, double retardation_time) {
  const double omega = 2.0 * std::numbers::pi * servo.natural_frequency;
  // 8/9 and 4 for a pure delay; the derivative's filter takes some of either.
  const double rigid = 0.7 / (omega * (servo.period + latency));
  const double swinging = 3.5 * retardation_time / (0.5 * servo.period + latency);
  return std::min(rigid, swinging);
}

LoopMotion loop_motion(const Matrix6& hand, const HeldVibrations& rubber, double retardation_time,
                       const PidSettings& servo, double latency) {
  return fastest(one_period(measured_by_hand(hand, rubber, retardation_time, servo, latency)),
                 servo.period);
}

}  // namespace fingertip::lattice::inline press
