#include "meshes/cells/cubic_grid.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/expectations.h"

using namespace fingertip::meshes;

namespace {

std::size_t count(const std::vector<std::uint8_t>& inside) {
  return std::accumulate(inside.begin(), inside.end(), std::size_t{0});
}

std::size_t particles(const Geometry& geometry, double spacing, const Vector3& offset) {
  return count(sample_particles(geometry, covering_grid(geometry, spacing, offset, 1)));
}

TEST(VolumetricSampling, CountApproachesVolumeOverCubedSpacing) {
  const Geometry geometry;
  const auto excess = [&](int cells) {
    const double spacing = geometry.tip_radius / cells;
    return double(particles(geometry, spacing, Vector3::Zero())) /
               expected_particle_count(geometry, spacing) -
           1.0;
  };
  EXPECT_LT(std::abs(excess(7)), 0.12);
  EXPECT_LT(std::abs(excess(24)), 0.015);
}

TEST(VolumetricSampling, MeanCountOverAllOffsetsIsExactlyTheEstimate) {
  // Averaged over every position of the grid, a point set has volume/spacing³ points (Cavalieri).
  const Geometry geometry;
  const double spacing = geometry.tip_radius / 6.0;
  double sum = 0.0;
  const int n = 6;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const Vector3 offset((i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5, (k + 0.5) / n - 0.5);
        sum += double(particles(geometry, spacing, offset));
      }
    }
  }
  EXPECT_NEAR(sum / (n * n * n) / expected_particle_count(geometry, spacing), 1.0, 0.005);
}

TEST(VolumetricSampling, IsSymmetricAboutTheAxisWithoutOffset) {
  const Geometry geometry;
  const CubicGrid grid = covering_grid(geometry, geometry.tip_radius / 9.0, Vector3::Zero(), 1);
  const auto inside = sample_particles(geometry, grid);
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const auto here = inside[grid.index(i, j, k)];
        EXPECT_EQ(here, inside[grid.index(grid.size[0] - 1 - i, j, k)]);
        EXPECT_EQ(here, inside[grid.index(j, i, k)]);
      }
    }
  }
}

TEST(VolumetricSampling, PoleAndSleeveEndAreParticlesWhenTheGridHitsThem) {
  // R/12 with L = 1.5 R: 1.5/0.0833... is 18.000000000000004 in floating point.
  const Geometry geometry;
  const CubicGrid grid = covering_grid(geometry, geometry.tip_radius / 12.0, Vector3::Zero(), 1);
  const auto inside = sample_particles(geometry, grid);
  double top = -1.0, bottom = 1.0;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (!inside[grid.index(i, j, k)]) continue;
        top = std::max(top, grid.position(i, j, k).z());
        bottom = std::min(bottom, grid.position(i, j, k).z());
      }
    }
  }
  EXPECT_NEAR(top, geometry.tip_radius, 1e-12);
  EXPECT_NEAR(bottom, -geometry.sleeve_length, 1e-12);
}

TEST(CoveringGrid, LeavesTheAskedMarginOfEmptyLayersOnEverySide) {
  const Geometry geometry;
  for (const double offset : {-1.0, -0.3, 0.0, 0.5, 1.0}) {
    const int margin = 2;
    const CubicGrid grid =
        covering_grid(geometry, geometry.tip_radius / 8.0, Vector3::Constant(offset), margin);
    const auto inside = sample_particles(geometry, grid);
    for (int k = 0; k < grid.size[2]; ++k) {
      for (int j = 0; j < grid.size[1]; ++j) {
        for (int i = 0; i < grid.size[0]; ++i) {
          const bool edge = std::min({i, j, k}) < margin || i >= grid.size[0] - margin ||
                            j >= grid.size[1] - margin || k >= grid.size[2] - margin;
          if (edge) {
            ASSERT_EQ(inside[grid.index(i, j, k)], 0) << offset;
          }
        }
      }
    }
  }
}

TEST(CoveringGrid, HoldsTheTipWithItsMarginInEveryRotation) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const int margin = 1;
  for (const Geometry& geometry : {Geometry{}, Geometry{.sleeve_length = 0.0}}) {
    for (int turn = 0; turn < 12; ++turn) {
      Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
      const Vector3 offset = Vector3::Random();
      const CubicGrid grid = covering_grid(geometry, geometry.tip_radius / 8.0, offset, margin,
                                           q.normalized().toRotationMatrix());
      for (int sample = 0; sample < 3000; ++sample) {
        // Points on and in the tip, the rim of its end included.
        const double angle = 0.01 * sample, height = 0.5 * normal(random);
        const double z = std::clamp(height, -1.0, 1.0);
        const double radius = geometry.tip_radius;
        const double across = z > 0.0 ? radius * std::sqrt(1.0 - z * z) : radius;
        const Vector3 w(across * std::cos(angle), across * std::sin(angle),
                        z > 0.0 ? z * radius : z * geometry.sleeve_length);
        const Vector3 at = grid.coordinates(w);
        for (int d = 0; d < 3; ++d) {
          ASSERT_GE(at[d], margin);
          ASSERT_LE(at[d], grid.size[std::size_t(d)] - 1 - margin);
        }
      }
    }
  }
}

TEST(CoveringGrid, CoordinatesInvertPositions) {
  const Eigen::Matrix3d axes =
      Eigen::AngleAxisd(0.7, Vector3(1, -2, 0.5).normalized()).toRotationMatrix();
  const CubicGrid grid = covering_grid(Geometry{}, 1e-3, Vector3(0.1, 0.5, -0.3), 2, axes);
  EXPECT_LT((grid.coordinates(grid.position(3, 17, 8)) - Vector3(3, 17, 8)).norm(), 1e-12);
  // A step along the grid's second direction.
  const Vector3 step = grid.position(3, 18, 8) - grid.position(3, 17, 8);
  EXPECT_LT((step - 1e-3 * axes.col(1)).norm(), 1e-16);
}

TEST(CoveringGrid, IsThePapersWhenNotTurned) {
  const Geometry geometry;
  const double spacing = geometry.tip_radius / 12.0;
  const Vector3 offset(0.25, -0.5, 0.125);
  const CubicGrid grid = covering_grid(geometry, spacing, offset, 1);
  EXPECT_EQ(grid.size, (std::array<int, 3>{29, 29, 35}));
  const Vector3 anchor = grid.position(14, 14, 2);  // the point i = j = k = 0
  EXPECT_LT((anchor - spacing * offset - Vector3(0, 0, -geometry.sleeve_length)).norm(), 1e-17);
}

TEST(CoveringGrid, RefusesDirectionsThatAreNoRotation) {
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity(), stretch = mirror;
  mirror(2, 2) = -1.0;
  stretch(0, 0) = 1.001;
  for (const Eigen::Matrix3d& axes : {mirror, stretch}) {
    EXPECT_THROW_SAYING(covering_grid(Geometry{}, 1e-3, Vector3::Zero(), 1, axes), InvalidInput,
                        "lattice.rotation");
  }
}

TEST(CoveringGrid, RefusesSpacingsWithoutTwoCellsThroughTheRubber) {
  const Geometry geometry;
  for (const double spacing : {0.0, -1e-3, 0.0026, std::nan("")}) {
    EXPECT_THROW_SAYING(covering_grid(geometry, spacing, Vector3::Zero(), 1), InvalidInput,
                        "lattice.spacing")
        << spacing;
  }
  EXPECT_NO_THROW(covering_grid(geometry, 0.0025, Vector3::Zero(), 1));
  EXPECT_THROW_SAYING(covering_grid(geometry, 1e-3, Vector3(0, 0, 1.5), 1), InvalidInput,
                      "lattice.offset");
}

}  // namespace
