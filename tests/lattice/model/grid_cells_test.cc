#include "lattice/model/grid_cells.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numeric>

#include "lattice/model/embedded_points.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"

using namespace fingertip;
using meshes::CutCell;
using meshes::Vector3;

namespace {

/// Moments of a cell with rubber in the box from `low` to `high` of its unit cube.
CutCell box_cell(const std::array<int, 3>& index, const Vector3& low, const Vector3& high) {
  CutCell cell{index, {}};
  for (int m = 0; m < 8; ++m) {
    double& moment = cell.moments[std::size_t(m)];
    moment = 1.0;
    for (int d = 0; d < 3; ++d) {
      moment *= (m >> d & 1) != 0 ? 0.5 * (high[d] * high[d] - low[d] * low[d]) : high[d] - low[d];
    }
  }
  return cell;
}

CutCell whole_cell(const std::array<int, 3>& index) {
  return box_cell(index, Vector3::Zero(), Vector3::Ones());
}

meshes::CubicGrid small_grid() {
  meshes::CubicGrid grid;
  grid.spacing = 0.5;
  grid.origin = Vector3(1.0, -1.0, 0.25);
  grid.size = {5, 5, 5};
  return grid;
}

/// Integral of the linear shape function that is 1 at `end` (0 or 1) from low to high.
double one_dimensional(int end, double low, double high) {
  const double rising = 0.5 * (high * high - low * low);
  return end == 1 ? rising : high - low - rising;
}

}  // namespace

TEST(GridCells, SharesAreTheIntegralsOfShapeFunctions) {
  const Vector3 low(0.1, 0.0, 0.35), high(0.8, 0.6, 1.0);
  const auto moments = lattice::corner_moments(box_cell({0, 0, 0}, low, high));
  std::array<std::array<double, 2>, 3> weight{};  // along each coordinate
  for (std::size_t d = 0; d < 3; ++d) {
    for (int end = 0; end < 2; ++end) {
      weight[d][std::size_t(end)] =
          one_dimensional(end, low[Eigen::Index(d)], high[Eigen::Index(d)]);
    }
  }
  for (int c = 0; c < 8; ++c) {
    const double x = weight[0][std::size_t(c & 1)], y = weight[1][std::size_t(c >> 1 & 1)],
                 z = weight[2][std::size_t(c >> 2 & 1)];
    const double lx = high.x() - low.x(), ly = high.y() - low.y(), lz = high.z() - low.z();
    EXPECT_NEAR(moments[std::size_t(c)], x * y * z, 1e-15) << c;
    EXPECT_NEAR(lattice::spring_share(moments, c, {0, 1, 0, lattice::axis}), x * ly * z, 1e-15)
        << c;
    EXPECT_NEAR(lattice::spring_share(moments, c, {1, 0, 1, lattice::face_diagonal}), lx * y * lz,
                1e-15)
        << c;
    EXPECT_NEAR(lattice::spring_share(moments, c, {-1, 1, 1, lattice::body_diagonal}), lx * ly * lz,
                1e-15)
        << c;
  }
}

TEST(GridCells, WholeCellsOwnTheirShareOfEverySpring) {
  const auto moments = lattice::corner_moments(whole_cell({0, 0, 0}));
  for (const lattice::Direction& direction : lattice::half_stencil) {
    EXPECT_EQ(lattice::spring_share(moments, 5, direction),
              lattice::cell_share[std::size_t(direction.family)]);
  }
}

TEST(GridCells, MeanGradientsAreThoseOfTheRubbersPart) {
  const Vector3 low(0.1, 0.0, 0.35), high(0.8, 0.6, 1.0), middle = 0.5 * (low + high);
  const double a = 0.5;
  const auto gradients = lattice::mean_gradients(
      lattice::corner_moments(box_cell({0, 0, 0}, low, high)), a, Eigen::Matrix3d::Identity());
  // The mean over a box of N_j(y) N_k(z) is its value in the middle.
  for (int c = 0; c < 8; ++c) {
    for (int d = 0; d < 3; ++d) {
      double expected = ((c >> d & 1) != 0 ? 1.0 : -1.0) / a;
      for (int e = 0; e < 3; ++e) {
        if (e != d) expected *= (c >> e & 1) != 0 ? middle[e] : 1.0 - middle[e];
      }
      EXPECT_NEAR(gradients(d, c), expected, 1e-14) << c << " " << d;
    }
  }
}

TEST(GridCells, SliversWithInexactMomentsStayPositive) {
  CutCell sliver = box_cell({0, 0, 0}, Vector3(0.3, 0.3, 0.0), Vector3(0.31, 0.31, 0.02));
  for (std::size_t m = 0; m < 8; ++m) sliver.moments[m] += (m % 3 == 0 ? 1.0 : -1.0) * 1e-7;
  const auto moments = lattice::corner_moments(sliver);
  for (const double moment : moments) EXPECT_GT(moment, 0.0);
  EXPECT_NEAR(std::accumulate(moments.begin(), moments.end(), 0.0) / sliver.fraction(), 1.0, 1e-14);
}

TEST(GridCells, ParticlesAreTheCornersInGridOrder) {
  const lattice::GridCells cells(small_grid(), {whole_cell({1, 1, 1}), whole_cell({2, 1, 1})});
  EXPECT_EQ(cells.particles(), 12u);
  for (std::size_t p = 1; p < cells.particles(); ++p) EXPECT_LT(cells.point(p - 1), cells.point(p));
  EXPECT_EQ(cells.rest_position(0), small_grid().position(1, 1, 1));
  EXPECT_EQ(cells.rest_position(11), small_grid().position(3, 2, 2));
  const auto left = cells.corners(cells.cells()[0]), right = cells.corners(cells.cells()[1]);
  for (const std::size_t c : {0u, 2u, 4u, 6u}) EXPECT_EQ(left[c + 1], right[c]);
  EXPECT_EQ(cells.cell_at(2, 1, 1), 1u);
  EXPECT_EQ(cells.cell_at(3, 1, 1), lattice::GridCells::none);
  // Beyond the end of a row, where the next one begins in memory.
  EXPECT_EQ(cells.cell_at(1 + 5, 0, 1), lattice::GridCells::none);
  EXPECT_EQ(cells.cell_at(1 - 5, 2, 1), lattice::GridCells::none);
}

TEST(GridCells, HingedSliversAreLeftOutAndLargePiecesRefused) {
  // Six cells in a row, one that shares an edge only with the last of them.
  meshes::CubicGrid grid = small_grid();
  grid.size = {10, 10, 10};
  std::vector<CutCell> row;
  for (int i = 1; i <= 6; ++i) row.push_back(whole_cell({i, 1, 1}));
  EXPECT_EQ(lattice::largest_piece(grid, row).size(), 6u);
  auto with_sliver = row;
  with_sliver.push_back(box_cell({7, 2, 1}, Vector3::Zero(), Vector3(0.05, 0.05, 0.05)));
  const auto kept = lattice::largest_piece(grid, with_sliver);
  ASSERT_EQ(kept.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(kept[i].index, row[i].index);
  with_sliver.back() = box_cell({7, 2, 1}, Vector3::Zero(), Vector3(0.1, 0.1, 0.1));
  EXPECT_THROW_SAYING(lattice::largest_piece(grid, with_sliver), meshes::InvalidInput,
                      "lattice.spacing");
  with_sliver.push_back(whole_cell({7, 1, 1}));  // shares a face with both
  EXPECT_EQ(lattice::largest_piece(grid, with_sliver).size(), 8u);
}

TEST(EmbeddedPoints, WeightsReproduceAffineFields) {
  meshes::CubicGrid grid = small_grid();
  grid.axes = Eigen::AngleAxisd(0.4, Vector3(1.0, 1.0, 0.0).normalized()).toRotationMatrix();
  const lattice::GridCells cells(grid, {whole_cell({1, 1, 1}), whole_cell({2, 1, 1})});
  // In grid coordinates: inside, on a face, and outside by less and by more than half a cell.
  const Vector3 places[] = {{1.2, 1.7, 1.4}, {2.0, 1.5, 1.1}, {2.4, 2.01, 1.5}, {3.9, 0.2, 2.8}};
  for (const Vector3& place : places) {
    const Vector3 at = grid.axes * (grid.origin + grid.spacing * place);
    const auto embedded = lattice::tie(cells, {at, Vector3::UnitZ(), 2.0}, 3.0);
    double sum = 0.0;
    Vector3 position = Vector3::Zero();
    for (std::size_t c = 0; c < 8; ++c) {
      sum += embedded.weights[c];
      position += embedded.weights[c] * cells.rest_position(embedded.corners[c]);
      EXPECT_LE(std::abs(embedded.weights[c]), 8.0);
    }
    EXPECT_NEAR(sum, 1.0, 1e-14);
    EXPECT_LT((position - at).norm(), 1e-14);
    EXPECT_EQ(embedded.rest, at);
    EXPECT_EQ(embedded.area, 2.0);
    EXPECT_EQ(embedded.stiffness, 6.0);
  }
  // Just above either cell that one is the nearest.
  for (const std::size_t cell : {0u, 1u}) {
    const Vector3 place(cell == 0 ? 1.6 : 2.4, 2.01, 1.5);
    const Vector3 above = grid.axes * (grid.origin + grid.spacing * place);
    EXPECT_EQ(lattice::tie(cells, {above, Vector3::UnitZ(), 1.0}, 1.0).corners,
              cells.corners(cells.cells()[cell]));
  }
  const Vector3 far = grid.axes * (grid.origin + grid.spacing * Vector3(1.5, 1.5, 3.5));
  EXPECT_THROW_SAYING(lattice::tie(cells, {far, Vector3::UnitZ(), 1.0}, 1.0), meshes::InvalidInput,
                      "lattice.spacing");
}
