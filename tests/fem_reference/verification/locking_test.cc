#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "fem_reference/verification/verification.h"
#include "tests/temporary_folder.h"

using namespace fingertip::fem_reference;

namespace {

/// Too stiff by, per element, at the one Poisson's ratio of the points.
std::map<std::string, double> by_element(const std::vector<LockingPoint>& points) {
  std::map<std::string, double> errors;
  for (const LockingPoint& point : points) {
    EXPECT_DOUBLE_EQ(point.relative_error, point.value / point.reference - 1.0);
    errors[point.element] = point.relative_error;
  }
  EXPECT_EQ(errors.size(), 5u);
  return errors;
}

/// Linear pointwise elements stiffen without bound, quadratic ones visibly where the rubber is
/// confined; projected quadratic elements stay within 1 %.
void expect_locking(const std::map<std::string, double>& compressible,
                    const std::map<std::string, double>& nearly, double quadratic) {
  EXPECT_GT(nearly.at("Q1 pointwise"), 3.0);
  EXPECT_GT(nearly.at("Q1 pointwise"), 5.0 * compressible.at("Q1 pointwise"));
  EXPECT_GT(nearly.at("Q2 pointwise"), quadratic);
  for (const auto& errors : {compressible, nearly}) {
    EXPECT_LT(std::abs(errors.at("Q2 projected")), 0.01);
    EXPECT_LT(std::abs(errors.at("Q1 projected")), 0.06);
  }
}

TEST(Locking, OfTheCantilever) {
  const auto nearly = by_element(lock_cantilever({0.4999}));
  expect_locking(by_element(lock_cantilever({3.0 / 7.0})), nearly, 0.0);
  EXPECT_LT(std::abs(nearly.at("Q3 pointwise")), 1e-8);  // contains the solution
}

TEST(Locking, OfTheBondedDisc) {
  expect_locking(by_element(lock_disc({0.25})), by_element(lock_disc({0.4999})), 0.03);
}

TEST(Locking, OfThePress) {
  const TemporaryFolder folder;
  expect_locking(by_element(lock_press({3.0 / 7.0}, folder.path())),
                 by_element(lock_press({0.4999}, folder.path())), 0.05);
}

}  // namespace
