/// The runs test against all orders of signs, counted one by one.
#include "calibration/statistics/residual_structure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using Eigen::VectorXd;
using fingertip::calibration::residual_structure;

namespace {

VectorXd as_residuals(const std::vector<int>& signs) {
  VectorXd residuals(Eigen::Index(signs.size()));
  for (std::size_t i = 0; i < signs.size(); ++i) residuals(Eigen::Index(i)) = 0.1 * signs[i];
  return residuals;
}

int runs_of(const std::vector<int>& signs) {
  int runs = 1;
  for (std::size_t i = 1; i < signs.size(); ++i) runs += signs[i] != signs[i - 1];
  return runs;
}

}  // namespace

TEST(ResidualStructure, ProbabilityIsThatOfAllOrdersCounted) {
  for (const auto& [positive, negative] : {std::pair{4, 4}, {7, 2}, {1, 5}, {6, 5}, {1, 1}}) {
    std::vector<int> signs(std::size_t(negative), -1);
    signs.insert(signs.end(), std::size_t(positive), 1);
    std::vector<int> orders_with(signs.size() + 1, 0);
    int orders = 0;
    do {
      ++orders_with[std::size_t(runs_of(signs))];
      ++orders;
    } while (std::ranges::next_permutation(signs).found);
    std::mt19937 generator(5);
    for (int trial = 0; trial < 20; ++trial) {
      std::ranges::shuffle(signs, generator);
      const auto found = residual_structure(as_residuals(signs));
      ASSERT_EQ(found.runs, runs_of(signs));
      int fewer = 0;
      for (int runs = 0; runs <= found.runs; ++runs) fewer += orders_with[std::size_t(runs)];
      EXPECT_NEAR(found.probability, double(fewer) / orders, 1e-12)
          << positive << " " << negative << " " << found.runs;
    }
  }
}

/// 12 points, six of each sign, three stretches: 2, 10 and more of C(12, 6) = 924 orders.
TEST(ResidualStructure, SaysItInWords) {
  const auto found = residual_structure(as_residuals({1, 1, 1, -1, -1, -1, -1, -1, -1, 1, 1, 1}));
  EXPECT_EQ(found.runs, 3);
  EXPECT_NEAR(found.probability, 12.0 / 924.0, 1e-12);
  EXPECT_EQ(found.statement,
            "the residuals change sign 2 times in 12 points; chance would do so, or less often, "
            "in 1.3 % of cases: the model misses something");
  const auto noise = residual_structure(as_residuals({1, -1, 1, 1, -1, 1, -1, -1}));
  EXPECT_NE(noise.statement.find("no sign of something missed"), std::string::npos);
}

TEST(ResidualStructure, OneSignZerosAndFewPoints) {
  EXPECT_NEAR(residual_structure(as_residuals({1, 1, 1, 1, 1, 1})).probability, 1.0 / 32.0, 1e-15);
  const auto zeros = residual_structure(as_residuals({0, 1, 0, 1, -1, 0}));
  EXPECT_EQ(zeros.runs, 2);
  EXPECT_NEAR(zeros.probability, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(residual_structure(as_residuals({1})).probability, 1.0);
  EXPECT_EQ(residual_structure(VectorXd()).runs, 0);
}

/// Wald and Wolfowitz: mean 1 + 2 p m/n, variance 2 p m (2 p m - n)/(n² (n - 1)), normal for many.
TEST(ResidualStructure, ManyPointsMeetTheNormalLimit) {
  std::vector<int> signs(600);
  for (std::size_t i = 0; i < signs.size(); ++i) signs[i] = (i / 2) % 2 == 0 ? 1 : -1;
  for (std::size_t i = 0; i < 60; ++i) signs[i] = i < 30 ? 1 : -1;
  const double runs = runs_of(signs), n = 600.0;
  const double p = double(std::ranges::count(signs, 1)), m = n - p;
  const double mean = 1.0 + 2.0 * p * m / n;
  const double deviation = std::sqrt(2.0 * p * m * (2.0 * p * m - n) / (n * n * (n - 1.0)));
  const double normal = 0.5 * std::erfc(-(runs + 0.5 - mean) / deviation / std::sqrt(2.0));
  const auto found = residual_structure(as_residuals(signs));
  EXPECT_GT(normal, 1e-4);
  EXPECT_NEAR(found.probability / normal, 1.0, 0.05);
}
