#include <gtest/gtest.h>

#include "fem_reference/verification/verification.h"
#include "tests/temporary_folder.h"

using namespace fingertip::fem_reference;

namespace {

using enum Volumetric;

void expect_passed(const std::vector<Check>& checks, std::size_t count) {
  EXPECT_EQ(checks.size(), count);
  for (const Check& check : checks) {
    EXPECT_TRUE(check.passed) << check.name << ", " << check.quantity << ": " << check.value
                              << ", expected " << check.expected << " by " << check.source;
    EXPECT_EQ(check.passed, check.relative_error <= check.tolerance);
  }
}

class Elements : public testing::TestWithParam<ElementType> {};

TEST_P(Elements, PassThePatchTest) {
  expect_passed(check_patch(GetParam()), 6);
}

TEST_P(Elements, HaveSixRigidModes) {
  expect_passed(check_rigid_modes(GetParam()), 12);
}

INSTANTIATE_TEST_SUITE_P(All, Elements,
                         testing::Values(ElementType{1, pointwise}, ElementType{1, mean_dilatation},
                                         ElementType{2, pointwise}, ElementType{2, mean_dilatation},
                                         ElementType{3, pointwise},
                                         ElementType{3, mean_dilatation}),
                         [](const auto& instance) {
                           return "Q" + std::to_string(instance.param.degree) +
                                  std::string(name(instance.param.volumetric));
                         });

TEST(Fields, AreThoseInClosedForm) {
  for (int degree = 1; degree <= 3; ++degree)
    expect_passed(check_fields({degree, mean_dilatation}, 4), 6);
}

/// The dilatation of a displacement element oscillates about the true one; multiplied by lambda
/// that spoils the stress, unless it is projected.
TEST(Fields, OfStressGainFromTheProjection) {
  const std::vector<Check> raw = check_fields({2, pointwise}, 4);
  const std::vector<Check> projection = check_fields({2, mean_dilatation}, 4);
  ASSERT_EQ(raw.size(), 6u);
  for (std::size_t i : {1, 3}) {  // sphere and cylinder
    ASSERT_EQ(raw[i].quantity, "L2 error of the stress");
    EXPECT_LT(projection[i].value, 0.25 * raw[i].value) << raw[i].name;
  }
}

TEST(BondedDisc, HasTheStiffnessOfRitz) {
  for (const double thickness : {0.005, 0.01})
    for (const double nu : {3.0 / 7.0, 0.25})
      for (const Meshed meshed : {Meshed::solid, Meshed::meridian})
        expect_passed(check_disc(thickness, nu, {2, mean_dilatation}, 2, meshed), 2);
}

/// Displacement elements are too stiff, and the less so the finer the mesh at the edge.
TEST(BondedDisc, OfPointwiseElementsFallsTowardRitz) {
  double last = 1e300;
  for (int refinements = 0; refinements < 3; ++refinements) {
    const Check energy = check_disc(0.005, 3.0 / 7.0, {2, pointwise}, refinements).front();
    EXPECT_GT(energy.value, energy.expected);
    EXPECT_LT(energy.value, last);
    last = energy.value;
  }
}

TEST(Press, BalancesAndMirrors) {
  const TemporaryFolder folder;
  expect_passed(check_press(folder.path()), 5);
}

}  // namespace
