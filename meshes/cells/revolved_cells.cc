#include "meshes/cells/revolved_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "meshes/cells/smoothed_gauss.h"

namespace fingertip::meshes::inline cells {
namespace {

/// Integrals of chi xi^i eta^j, [i + 2 j].
using SliceMoments = std::array<double, 4>;

/// A rectangle in the plane of a slice, from its lowest corner, and unit coordinates in it.
struct Rectangle {
  Vector2 low, high;
};

/// The disc x² + y² <= radius² within the rectangle: strips along y between the x at which its rim
/// reaches the upper or lower edge. In coordinates of the rectangle, lest fine cells be differences
/// of large numbers.
SliceMoments disc_moments(const Rectangle& cell, double radius) {
  SliceMoments sum{};
  const double size = cell.high.x() - cell.low.x();
  const double from = std::max(cell.low.x(), -radius), to = std::min(cell.high.x(), radius);
  if (from >= to) return sum;
  // By factors: where the rim is tangent to an edge, radius² - x² would be all round-off.
  const auto rim_at = [&](double x) {
    return std::sqrt(std::max(0.0, (radius - x) * (radius + x)));
  };
  const double lower = rim_at(cell.low.y()), upper = rim_at(cell.high.y());
  const double near = std::min(lower, upper), far = std::max(lower, upper);
  std::array<double, 6> events{from};
  std::size_t count = 1;
  for (const double event : {-far, -near, near, far})
    if (event > events[count - 1] && event < to) events[count++] = event;
  events[count++] = to;
  for (std::size_t e = 1; e < count; ++e) {
    const double a = events[e - 1], width = events[e] - a, middle = a + 0.5 * width;
    if (width <= 0.0) continue;
    const double s = rim_at(middle);
    if (std::min(s, cell.high.y()) <= std::max(-s, cell.low.y())) continue;
    const auto add = [&](double x, double weight, double bottom, double top) {
      const double xi = (x - cell.low.x()) / size, first = weight * (top - bottom),
                   second = 0.5 * weight * (top - bottom) * (top + bottom);
      sum[0] += first;
      sum[1] += xi * first;
      sum[2] += second;
      sum[3] += xi * second;
    };
    // y runs from the larger of low and -s to the smaller of high and s.
    if (s >= cell.high.y() && -s <= cell.low.y()) {
      add(middle, width / size, 0.0, 1.0);  // a rectangle: its middle is exact
      continue;
    }
    for (const double half : {0.0, 0.5})
      for (const QuadratureNode& node : smoothed_gauss_rule()) {
        const double x = a + width * (half + 0.5 * node.at), rim = rim_at(x);
        add(x, 0.5 * width * node.weight / size,
            (std::max(-rim, cell.low.y()) - cell.low.y()) / size,
            (std::min(rim, cell.high.y()) - cell.low.y()) / size);
      }
  }
  return sum;
}

/// The radii at which a disc's integrals over the rectangle are not smooth.
std::vector<double> critical_radii(const Rectangle& cell) {
  std::vector<double> radii;
  for (const double x : {cell.low.x(), cell.high.x()}) {
    radii.push_back(std::abs(x));
    for (const double y : {cell.low.y(), cell.high.y()}) radii.push_back(std::hypot(x, y));
  }
  for (const double y : {cell.low.y(), cell.high.y()}) radii.push_back(std::abs(y));
  return radii;
}

}  // namespace

bool along_axes(const CubicGrid& grid) {
  constexpr double round_off = 1e-12;  // right angles by sine and cosine
  const Eigen::Matrix3d size = grid.axes.cwiseAbs();
  return ((size.colwise().sum() - size.colwise().maxCoeff()).array() < round_off).all();
}

std::array<double, 8> revolved_moments(const Meridian& meridian, const CubicGrid& grid, int i,
                                       int j, int k) {
  constexpr double same_height = 1e-12;
  const Vector3 corner = grid.position(i, j, k), opposite = grid.position(i + 1, j + 1, k + 1);
  // Mirror images are computed as one and the same cell, so that round-off keeps their symmetry.
  const double grain = 1e-12 * grid.spacing;
  const auto rounded = [&](double x) { return std::nearbyint(x / grain) * grain; };
  Vector3 low = corner.cwiseMin(opposite).unaryExpr(rounded),
          high = corner.cwiseMax(opposite).unaryExpr(rounded);
  std::array<bool, 3> backward{};
  for (const int axis : {0, 1})
    if (low[axis] + high[axis] < -1e-9 * grid.spacing) {
      backward[std::size_t(axis)] = true;
      low[axis] = std::exchange(high[axis], -low[axis]) * -1.0;
    }
  const Rectangle cell{low.head<2>(), high.head<2>()};
  const std::vector<double> critical = critical_radii(cell);
  std::vector<double> heights{low.z(), high.z()};
  const auto add = [&](double z) {
    if (z > low.z() && z < high.z()) heights.push_back(z);
  };
  for (const MonotonePart& part : meridian.parts()) {
    if (part.lowest() >= high.z() || part.highest() <= low.z()) continue;
    add(part.lowest());
    add(part.highest());
    for (const double radius : critical)
      if (part.crosses_radius(radius)) add(part.height_at(radius));
  }
  std::ranges::sort(heights);
  std::array<double, 8> moments{};
  for (std::size_t e = 1; e < heights.size(); ++e) {
    const double width = heights[e] - heights[e - 1];
    if (width < same_height * grid.spacing) continue;
    for (const QuadratureNode& node : smoothed_gauss_rule()) {
      const double z = heights[e - 1] + width * node.at;
      const double weight = width * node.weight / grid.spacing, zeta = (z - low.z()) / grid.spacing;
      double sign = 1.0;
      for (const double radius : meridian.radii(z)) {
        const SliceMoments disc = disc_moments(cell, radius);
        for (std::size_t ij = 0; ij < 4; ++ij) {
          moments[ij] += sign * weight * disc[ij];
          moments[ij + 4] += sign * weight * zeta * disc[ij];
        }
        sign = -sign;
      }
    }
  }
  // [x + 2 y + 4 z] of the tip to those of the grid's own directions.
  std::array<std::size_t, 3> axis_of{};
  for (Eigen::Index d = 0; d < 3; ++d) {
    Eigen::Index along = 0;
    grid.axes.col(d).cwiseAbs().maxCoeff(&along);
    axis_of[std::size_t(d)] = std::size_t(along);
    if (grid.axes(along, d) < 0.0) backward[std::size_t(along)] = !backward[std::size_t(along)];
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t place = 0; place < 8 && backward[axis]; ++place)
      if (place >> axis & 1)
        moments[place] = moments[place ^ (std::size_t(1) << axis)] - moments[place];
  std::array<double, 8> own{};
  for (std::size_t place = 0; place < 8; ++place) {
    std::size_t turned = 0;
    for (std::size_t d = 0; d < 3; ++d)
      if (place >> axis_of[d] & 1) turned |= std::size_t(1) << d;
    own[turned] = moments[place];
  }
  return own;
}

}  // namespace fingertip::meshes::inline cells
