#include "fem_reference/contact/anderson_mixing.h"

#include <gtest/gtest.h>

#include <cmath>

using fingertip::fem_reference::AndersonMixing;

namespace {

/// Linear maps of n unknowns stand still after n + 1 steps, also those that run away by themselves.
TEST(AndersonMixing, FindsTheFixedPointOfALinearMap) {
  const Eigen::Vector3d slope(0.99, -3.0, 5.0), shift(1.0, 2.0, -3.0);
  AndersonMixing mixing;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(3);
  const auto image = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    return slope.cwiseProduct(at) + shift;
  };
  for (int i = 0; i < 5; ++i) x = mixing.next(x, image(x));
  const Eigen::Vector3d exact = shift.array() / (1.0 - slope.array());
  EXPECT_NEAR((x - exact).norm(), 0.0, 1e-9 * exact.norm());
}

TEST(AndersonMixing, IsFasterOnACurvedMapAndForgetsWhatItIsTold) {
  AndersonMixing mixing;
  const auto image = [](const Eigen::VectorXd& x) -> Eigen::VectorXd { return x.array().cos(); };
  const auto left_after = [&](int steps) {
    Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1.0);
    for (int i = 0; i < steps; ++i) x = mixing.next(x, image(x));
    return std::abs(x[0] - 0.7390851332151607);
  };
  EXPECT_LT(left_after(6), 1e-9) << "plain steps leave two thirds each";
  mixing.forget();
  EXPECT_NEAR(mixing.next(Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(3.0, 4.0))[1], 4.0, 0.0);
}

}  // namespace
