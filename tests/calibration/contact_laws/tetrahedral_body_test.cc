// Bodies of tetrahedra whose forces are known in closed form.

#include "calibration/contact_laws/tetrahedral_body.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

#include "meshes/shape/geometry.h"

using namespace fingertip;
using namespace fingertip::calibration;

namespace {

constexpr double stiff = 1e3;  ///< contact beside which the bodies' millimetres count for nothing

double lambda_of(double nu) {
  return nu / (1.0 + nu) / (1.0 - 2.0 * nu);
}
double mu_of(double nu) {
  return 0.5 / (1.0 + nu);
}

/// An apex over a base that is held.
TetrahedralBody pyramid(double height) {
  TetrahedralBody body;
  body.mesh.vertices = {{0, 0, 0}, {2e-3, 0, 0}, {0.5e-3, 3e-3, 0}, {0.7e-3, 0.9e-3, height}};
  body.mesh.tetrahedra = {{0, 1, 2, 3}};
  body.held = {true, true, true, false};
  return body;
}

/// Cubes of six tetrahedra; the lower side is held.
TetrahedralBody block(int n, double edge) {
  TetrahedralBody body;
  const auto id = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        body.mesh.vertices.emplace_back(i * edge, j * edge, k * edge);
        body.held.push_back(k == 0);
      }
  constexpr std::array<std::array<int, 4>, 6> six = {
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const auto& one : six) {
          std::array<int, 4> corners{};
          for (std::size_t c = 0; c < 4; ++c)
            corners[c] = id(i + (one[c] & 1), j + ((one[c] >> 1) & 1), k + (one[c] >> 2));
          body.mesh.tetrahedra.push_back(corners);
        }
  return body;
}

}  // namespace

TEST(TetrahedralBody, OfOneTetrahedronIsConfinedCompression) {
  // F = diag(1, 1, s), so W = (lambda/2 + mu) E², E = (s² - 1)/2.
  const double height = 1.5e-3;
  const TetrahedralBody body = pyramid(height);
  for (const double nu : {0.0, 0.3, 0.45}) {
    const std::vector<double> depths = {0.1e-3, 0.3e-3, 0.5e-3};
    const std::vector<double> forces = forces_of(body, {nu, stiff}, depths);
    ASSERT_EQ(forces.size(), depths.size());
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const double s = 1.0 - depths[i] / height;
      const double slope = (lambda_of(nu) + 2.0 * mu_of(nu)) * 0.5 * (1.0 - s * s) * s / height;
      EXPECT_NEAR(forces[i] / (body.volume() * slope), 1.0, 1e-5) << nu << ", " << depths[i];
    }
  }
}

TEST(TetrahedralBody, OfABlockWithoutPoissonsRatioIsUniaxialCompression) {
  const int n = 3;
  const double edge = 1e-3;
  const TetrahedralBody body = block(n, edge);
  EXPECT_NEAR(body.volume(), std::pow(n * edge, 3), 1e-18);
  const std::vector<double> depths = {0.1e-3, 0.6e-3, 0.9e-3};
  const std::vector<double> forces = forces_of(body, {0.0, stiff}, depths);
  ASSERT_EQ(forces.size(), depths.size());
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double s = 1.0 - depths[i] / (n * edge);
    EXPECT_NEAR(forces[i] / (std::pow(n * edge, 2) * 0.5 * (1.0 - s * s) * s), 1.0, 1e-5);
  }
}

TEST(TetrahedralBody, GivesWayWhereItsLawHasNoMoreResistance) {
  // s (1 - s²), the force of a column, is largest at s = 1/sqrt(3).
  const std::vector<double> forces = forces_of(block(3, 0.5e-3), {0.3, stiff}, {0.5e-3, 1.2e-3});
  EXPECT_EQ(forces.size(), 1U);
}

TEST(TetrahedralBody, ContactThatGivesWayIsASpringInSeries) {
  const double height = 1.5e-3, k = 1e-3, nu = 0.3, depth = 1e-6;
  const TetrahedralBody body = pyramid(height);
  const double own = body.volume() * (lambda_of(nu) + 2.0 * mu_of(nu)) / (height * height);
  const double force = forces_of(body, {nu, k}, {depth})[0];
  EXPECT_NEAR(force / (depth * own * k / (own + k)), 1.0, 1e-2);
}

TEST(TetrahedralBody, OfTheDomeIsHeldWhereItIsBonded) {
  const meshes::Geometry geometry;
  const TetrahedralBody body = tetrahedral_body(geometry, 2.5e-3);
  const auto shape = meshes::shape_of(geometry);
  EXPECT_NEAR(body.volume() / shape->volume(), 1.0, 0.03);
  EXPECT_NEAR(body.top(), shape->pole(), 0.1e-3);
  std::size_t held = 0;
  for (std::size_t v = 0; v < body.held.size(); ++v) {
    if (!body.held[v]) continue;
    ++held;
    EXPECT_LT(shape->nearest(meshes::ProfileSurface::bond, body.mesh.vertices[v]).distance, 0.2e-3);
  }
  EXPECT_GT(held, 50U);
  // Finer tetrahedra are softer.
  const std::vector<double> depths = {1e-3};
  const double coarse = forces_of(body, {0.45, 0.025}, depths)[0];
  const double fine = forces_of(tetrahedral_body(geometry, 2e-3), {0.45, 0.025}, depths)[0];
  EXPECT_LT(fine, coarse);
}
