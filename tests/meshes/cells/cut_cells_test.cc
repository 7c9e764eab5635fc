#include "meshes/cells/cut_cells.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "tests/expectations.h"

using namespace fingertip::meshes;

namespace {

using std::numbers::pi;

Eigen::Matrix3d rotation(double angle, const Vector3& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

struct Case {
  const char* what;
  Geometry geometry;
  double spacing;
  Vector3 offset = Vector3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double accuracy = 1e-8;  ///< of the tip's volume

  CubicGrid grid() const { return covering_grid(geometry, spacing, offset, 1, axes); }
};

std::vector<Case> cases() {
  const Geometry tip, shell{.sleeve_length = 0.0};
  const Geometry thin{.rod_radius = 0.008, .sleeve_length = 0.004};
  const Geometry thick{.rod_radius = 0.001};
  const Vector3 shift(0.3, -0.2, 0.7), skew(1.0, 2.0, 3.0);
  return {{"R/12", tip, 0.01 / 12},
          {"R/12 as typed, slivers at the end", tip, 0.000833333},
          {"R/9 shifted", tip, 0.01 / 9, shift},
          {"R/9 skew", tip, 0.01 / 9, shift, rotation(0.6, skew)},
          {"about the axis", tip, 0.01 / 8, Vector3::Zero(), rotation(pi / 4, Vector3::UnitZ())},
          {"upside down", tip, 0.01 / 8, shift, rotation(pi, Vector3::UnitX())},
          {"barely turned", tip, 0.01 / 8, Vector3::Zero(), rotation(3e-7, skew)},
          {"coarsest", tip, 0.0025, Vector3::Zero(), rotation(1.1, skew)},
          {"no sleeve", shell, 0.01 / 8},
          {"no sleeve, skew", shell, 0.01 / 8, shift, rotation(2.0, skew)},
          {"thin layer", thin, 0.001, shift},
          {"thin layer, skew", thin, 0.001, shift, rotation(0.6, skew)},
          {"cells wider than the rod", thick, 0.0045},
          {"cells wider than the rod, skew", thick, 0.0045, shift, rotation(0.6, skew)},
          // Faces that the rod almost touches from inside: the hardest integrands.
          {"as wide as the rod, near tangency",
           {.rod_radius = 0.00275},
           0.003625,
           {-0.0545, 0.062, 0.0},
           Eigen::Matrix3d::Identity(),
           1e-6}};
}

TEST(CutCells, VolumesAddUpToTheTips) {
  for (const Case& c : cases()) {
    double sum = 0.0;
    for (const CutCell& cell : cut_cells(c.geometry, c.grid(), 0.0)) sum += cell.fraction();
    EXPECT_NEAR(sum * std::pow(c.spacing, 3) / c.geometry.tip_volume(), 1.0, c.accuracy) << c.what;
  }
}

/// Height of the tip's centre of volume: hemispheres pi/4 (R⁴ - r⁴), sleeve -pi/2 (R² - r²) L².
double centroid(const Geometry& geometry) {
  const double big = geometry.tip_radius, small = geometry.rod_radius;
  return (pi / 4 * (std::pow(big, 4) - std::pow(small, 4)) -
          pi / 2 * (big * big - small * small) * std::pow(geometry.sleeve_length, 2)) /
         geometry.tip_volume();
}

TEST(CutCells, FirstMomentsGiveTheCentroid) {
  for (const Case& c : cases()) {
    const CubicGrid grid = c.grid();
    Vector3 sum = Vector3::Zero();
    for (const CutCell& cell : cut_cells(c.geometry, grid, 0.0)) {
      const auto& m = cell.moments;
      sum += m[0] * grid.position(cell.index[0], cell.index[1], cell.index[2]) +
             grid.spacing * grid.axes * Vector3(m[1], m[2], m[4]);
    }
    sum *= std::pow(c.spacing, 3) / c.geometry.tip_volume();
    const Vector3 expected(0.0, 0.0, centroid(c.geometry));
    EXPECT_LT((sum - expected).norm(), c.accuracy * c.geometry.tip_radius) << c.what;
  }
}

TEST(CutCells, MixedMomentsGiveTheProductsOfInertia) {
  // ∫ x y, ∫ y z, ∫ z x over the tip in the grid's directions, with ∫ w wᵀ diagonal in the tip's.
  for (const Case& c : cases()) {
    const CubicGrid grid = c.grid();
    Vector3 sum = Vector3::Zero();
    for (const CutCell& cell : cut_cells(c.geometry, grid, 0.0)) {
      const auto& m = cell.moments;
      const Vector3 at =
          grid.origin / grid.spacing + Vector3(cell.index[0], cell.index[1], cell.index[2]);
      const Vector3 first(m[1], m[2], m[4]), second(m[3], m[6], m[5]);
      for (int d = 0; d < 3; ++d) {
        const int e = (d + 1) % 3;
        sum[d] += at[d] * at[e] * m[0] + at[d] * first[e] + at[e] * first[d] + second[d];
      }
    }
    sum *= std::pow(grid.spacing, 5);
    const auto power = [](double x, int n) { return std::pow(x, n); };
    const double big = c.geometry.tip_radius, small = c.geometry.rod_radius,
                 length = c.geometry.sleeve_length;
    const double dome = 2 * pi / 15 * (power(big, 5) - power(small, 5));
    const double across = dome + pi / 4 * (power(big, 4) - power(small, 4)) * length;
    const double along = dome + pi / 3 * (power(big, 2) - power(small, 2)) * power(length, 3);
    const Eigen::Matrix3d tensor =
        grid.axes.transpose() * Vector3(across, across, along).asDiagonal() * grid.axes;
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(sum[d] / along, tensor(d, (d + 1) % 3) / along, 2.0 * c.accuracy)
          << c.what << " " << d;
    }
  }
}

/// Moments of a cell from the membership alone of `count` points, nothing of the method tested. The
/// points are multiples of (1/g, 1/g², 1/g³) modulo 1 with g⁴ = g + 1: more even than random ones
/// and, unlike those of a grid, never aligned with a plane or a cylinder.
std::array<double, 8> sampled_moments(const Geometry& geometry, const CubicGrid& grid,
                                      const CutCell& cell, int count) {
  const double g = 1.2207440846057596;
  const Vector3 step(1.0 / g, 1.0 / (g * g), 1.0 / (g * g * g));
  const Vector3 corner = grid.position(cell.index[0], cell.index[1], cell.index[2]);
  std::array<double, 8> sum{};
  Vector3 local = Vector3::Constant(0.5);
  for (int n = 0; n < count; ++n) {
    local += step;
    local -= local.array().floor().matrix();
    if (!geometry.contains(corner + grid.spacing * grid.axes * local)) continue;
    for (unsigned m = 0; m < 8; ++m) {
      sum[m] += (m & 1 ? local.x() : 1.0) * (m & 2 ? local.y() : 1.0) * (m & 4 ? local.z() : 1.0);
    }
  }
  for (double& value : sum) value /= count;
  return sum;
}

TEST(CutCells, AgreeWithSamplingByMembership) {
  std::mt19937 random(5);
  for (const Case& c : cases()) {
    const CubicGrid grid = c.grid();
    std::vector<CutCell> partial;
    for (const CutCell& cell : cut_cells(c.geometry, grid, 1e-6)) {
      if (cell.fraction() < 1.0) partial.push_back(cell);
    }
    std::shuffle(partial.begin(), partial.end(), random);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto sampled = sampled_moments(c.geometry, grid, partial[i], 2000000);
      for (std::size_t m = 0; m < 8; ++m) {
        EXPECT_NEAR(partial[i].moments[m], sampled[m], 1e-4) << c.what << " moment " << m;
      }
    }
  }
}

TEST(CutCells, SubdividedCellsAddUpToTheWhole) {
  // Halving the spacing moves every edge, face and direction of integration; nothing may change.
  const Geometry geometry;
  const Eigen::Matrix3d axes = rotation(0.9, {2.0, -1.0, 0.5});
  CubicGrid coarse = covering_grid(geometry, 0.0025, Vector3(0.1, 0.2, 0.3), 1, axes),
            fine = coarse;
  fine.spacing *= 0.5;
  for (int& size : fine.size) size = 2 * size - 1;
  std::map<std::size_t, std::array<double, 8>> sums;
  for (const CutCell& cell : cut_cells(geometry, fine, 0.0)) {
    const auto [i, j, k] = cell.index;
    auto& sum = sums[coarse.index(i / 2, j / 2, k / 2)];
    const auto& m = cell.moments;
    const double x = i % 2, y = j % 2, z = k % 2;
    const double first[] = {m[1] + x * m[0], m[2] + y * m[0], m[4] + z * m[0]};
    sum[0] += m[0] / 8;
    sum[1] += first[0] / 16;
    sum[2] += first[1] / 16;
    sum[4] += first[2] / 16;
    sum[3] += (m[3] + x * m[2] + y * m[1] + x * y * m[0]) / 32;
  }
  const auto cells = cut_cells(geometry, coarse, 0.0);
  ASSERT_EQ(sums.size(), cells.size());
  for (const CutCell& cell : cells) {
    const auto& sum = sums.at(coarse.index(cell.index[0], cell.index[1], cell.index[2]));
    for (const std::size_t m : {0, 1, 2, 3, 4}) ASSERT_NEAR(cell.moments[m], sum[m], 1e-7);
  }
}

TEST(CutCells, AreMirrorImagesOfEachOther) {
  const Geometry geometry;
  const CubicGrid grid = covering_grid(geometry, 0.01 / 9, Vector3(0, 0, 0.4), 1);
  std::map<std::array<int, 3>, std::array<double, 8>> moments;
  const auto cells = cut_cells(geometry, grid, 1e-9);
  for (const CutCell& cell : cells) moments[cell.index] = cell.moments;
  for (const CutCell& cell : cells) {
    const auto [i, j, k] = cell.index;
    const auto& m = cell.moments;
    const auto& mirrored = moments.at({grid.size[0] - 2 - i, j, k});
    const auto& exchanged = moments.at({j, i, k});
    for (const std::size_t y : {0u, 2u, 4u, 6u}) {
      ASSERT_NEAR(mirrored[y], m[y], 1e-9);
      ASSERT_NEAR(mirrored[y + 1], m[y] - m[y + 1], 1e-9);
    }
    const std::size_t partner[] = {0, 2, 1, 3, 4, 6, 5, 7};
    for (std::size_t n = 0; n < 8; ++n) ASSERT_NEAR(exchanged[n], m[partner[n]], 1e-9);
  }
}

TEST(CutCells, FillWholeCellsExactlyAndRunByIncreasingIndex) {
  for (const Case& c : cases()) {
    const CubicGrid grid = c.grid();
    const std::array<double, 8> cube{1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125};
    const double reach = 0.5 * std::numbers::sqrt3 * grid.spacing;
    std::size_t next = 0;
    for (const CutCell& cell : cut_cells(c.geometry, grid, 0.0)) {
      const auto [i, j, k] = cell.index;
      ASSERT_GE(grid.index(i, j, k), next);
      next = grid.index(i, j, k) + 1;
      const Vector3 centre = 0.5 * (grid.position(i, j, k) + grid.position(i + 1, j + 1, k + 1));
      // Beside those far from the boundary, those that it passes by without cutting them.
      if (c.geometry.signed_distance(centre) < -reach || cell.fraction() > 1.0 - 1e-13) {
        ASSERT_EQ(cell.moments, cube);
      }
      for (std::size_t m = 0; m < 8; ++m) {
        ASSERT_GE(cell.moments[m], 0.0);
        ASSERT_LE(cell.moments[m], cube[m] + 1e-12);
      }
    }
  }
}

TEST(CutCells, SliversHaveTheirTrueVolumeAndAreLeftOutOnRequest) {
  // The grid is anchored at the end; shifted by 1e-5 cells, the last layer holds that much rubber.
  const Geometry geometry;
  const double share = 1e-5;
  const CubicGrid grid = covering_grid(geometry, 0.01 / 10, Vector3(0, 0, share), 1);
  const auto in_last_layer = [&](double smallest) {
    const auto cells = cut_cells(geometry, grid, smallest);
    const int lowest = cells.front().index[2];
    std::vector<CutCell> layer;
    for (const CutCell& cell : cells) {
      if (cell.index[2] == lowest) layer.push_back(cell);
    }
    return layer;
  };
  double sum = 0.0;
  for (const CutCell& cell : in_last_layer(0.0)) {
    EXPECT_LE(cell.fraction(), share * (1.0 + 1e-6));
    EXPECT_NEAR(cell.moments[4], cell.fraction(), share * cell.fraction());
    sum += cell.fraction();
  }
  EXPECT_NEAR(sum, share * pi * (100.0 - 25.0), share * 1e-5);
  // Without them the last layer is one of prisms over the annulus.
  sum = 0.0;
  for (const CutCell& cell : in_last_layer(2 * share)) sum += cell.fraction();
  EXPECT_NEAR(sum, pi * (100.0 - 25.0), 1e-5);
}

TEST(CutCells, RefuseImpossibleRequests) {
  const Geometry geometry;
  const CubicGrid grid = covering_grid(geometry, 0.0025, Vector3::Zero(), 1);
  for (const double smallest : {-1e-9, 1.0, std::nan("")}) {
    EXPECT_THROW_SAYING(cut_cells(geometry, grid, smallest), InvalidInput, "smallest_fraction")
        << smallest;
  }
  EXPECT_THROW_SAYING(cut_cells({.rod_radius = 0.02}, grid, 0.0), InvalidInput,
                      "geometry.rod_radius");
}

}  // namespace
