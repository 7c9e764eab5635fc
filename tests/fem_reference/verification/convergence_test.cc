// Orders of convergence, degree + 1 in L2 and degree in H1. The meshes are small: what their orders
// still miss is stated with each bound.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "fem_reference/verification/verification.h"

using namespace fingertip::fem_reference;

namespace {

using enum Volumetric;
constexpr double paper_ratio = 3.0 / 7.0;
const std::array<std::vector<int>, 4> divisions{{{}, {8, 16}, {4, 8}, {2, 4}}};

class Orders : public testing::TestWithParam<ElementType> {
 protected:
  const ElementType element = GetParam();
  const std::vector<int>& meshes = divisions[std::size_t(element.degree)];
};

std::string title(const testing::TestParamInfo<ElementType>& instance) {
  return "Q" + std::to_string(instance.param.degree) + std::string(name(instance.param.volumetric));
}

void expect_orders(const ConvergenceStudy& study, double below, double above) {
  EXPECT_GT(study.order_l2, study.expected_l2 - below) << study.problem;
  EXPECT_LT(study.order_l2, study.expected_l2 + above) << study.problem;
  EXPECT_GT(study.order_h1, study.expected_h1 - below) << study.problem;
  EXPECT_LT(study.order_h1, study.expected_h1 + above) << study.problem;
}

TEST_P(Orders, OnAManufacturedSolution) {
  // Quadratic projected elements come down to their order slowly: the projection's part of the
  // error still falls like h^2.5 here (+0.21 at 8 divisions, +0.15 at 16).
  const bool slow = element.degree == 2 && element.volumetric == mean_dilatation;
  for (const bool curved : {true, false})
    expect_orders(study_manufactured({curved, false, paper_ratio}, element, meshes), 0.1,
                  slow ? 0.25 : 0.1);
}

TEST_P(Orders, OfNearlyIncompressibleMaterialSurviveOnlyProjection) {
  const ConvergenceStudy study = study_manufactured({true, true, 0.4999}, element, meshes);
  if (element.volumetric == mean_dilatation) {
    expect_orders(study, 0.1, 0.1);
  } else {
    EXPECT_LT(study.order_l2, study.expected_l2 - 0.5);
    EXPECT_LT(study.order_h1, study.expected_h1 - 0.5);
  }
}

TEST_P(Orders, UnderPressureOnCurvedWalls) {
  expect_orders(study_cylinder(element, paper_ratio, meshes), 0.25, 0.1);
  // The octant's wall gets fewer elements.
  expect_orders(study_sphere(element, paper_ratio,
                             element.degree == 1 ? std::vector{4, 8} : std::vector{2, 4}),
                0.3, 0.15);
}

TEST_P(Orders, OnTheMeridianOfAManufacturedSolution) {
  const bool slow = element.degree == 2 && element.volumetric == mean_dilatation;
  const std::array<std::vector<int>, 4> rings{{{}, {16, 32}, {8, 16}, {4, 8}}};
  // Distorted meshes are not nested: their distortions differ from one to the next.
  for (const bool curved : {true, false})
    expect_orders(study_manufactured_meridian(curved, element, rings[std::size_t(element.degree)]),
                  curved ? 0.1 : 0.15, slow ? 0.25 : 0.1);
}

TEST_P(Orders, UnderPressureOnMeridians) {
  const std::array<std::vector<int>, 4> walls{{{}, {16, 32}, {8, 16}, {4, 8}}};
  const auto& divided = walls[std::size_t(element.degree)];
  expect_orders(study_cylinder(element, paper_ratio, divided, Meshed::meridian), 0.25, 0.15);
  expect_orders(study_sphere(element, paper_ratio, divided, Meshed::meridian), 0.25, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Elements, Orders,
                         testing::Values(ElementType{1, pointwise}, ElementType{1, mean_dilatation},
                                         ElementType{2, pointwise}, ElementType{2, mean_dilatation},
                                         ElementType{3, pointwise},
                                         ElementType{3, mean_dilatation}),
                         title);

/// Cubic elements contain the cantilever's solution, so only lower ones have an order. Bending
/// makes the coarse meshes of linear pointwise elements converge faster at first.
TEST(CantileverOrders, AreNotBelowTheory) {
  for (const ElementType& element : {ElementType{1, pointwise}, ElementType{1, mean_dilatation},
                                     ElementType{2, pointwise}, ElementType{2, mean_dilatation}})
    expect_orders(study_cantilever(element, paper_ratio,
                                   element.degree == 1 ? std::vector{4, 8} : std::vector{2, 4}),
                  0.25, 1.0);
}

}  // namespace
