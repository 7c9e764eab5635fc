#include "meshes/cells/solid_cells.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace fingertip::meshes::inline cells {
namespace {

/// A flat convex polygon in grid coordinates; three corners, and one more for each wall that cuts.
using FlatPolygon = std::vector<Vector3>;

/// Parts of a polygon below and above coordinate = at. Corners in the wall belong to both.
void split(const FlatPolygon& polygon, Eigen::Index axis, double at, FlatPolygon& below,
           FlatPolygon& above) {
  below.clear();
  above.clear();
  for (std::size_t c = 0; c < polygon.size(); ++c) {
    const Vector3 &a = polygon[c], &b = polygon[(c + 1) % polygon.size()];
    const double from = a[axis] - at, to = b[axis] - at;
    if (from <= 0.0) below.push_back(a);
    if (from >= 0.0) above.push_back(a);
    if (!(from * to < 0.0)) continue;
    // From below upward, so that facets on both sides of an edge cut it at one place.
    const Vector3 &low = from < 0.0 ? a : b, &high = from < 0.0 ? b : a;
    const double part = (at - low[axis]) / (high[axis] - low[axis]);
    Vector3 w = low + part * (high - low);
    w[axis] = at;
    below.push_back(w);
    above.push_back(w);
  }
}

std::pair<double, double> range_of(const FlatPolygon& polygon, Eigen::Index axis) {
  double low = polygon[0][axis], high = low;
  for (const Vector3& w : polygon) low = std::min(low, w[axis]), high = std::max(high, w[axis]);
  return {low, high};
}

/// Cuts a polygon by the walls of cells across an axis, and hands over the pieces between wall
/// number n and n + 1, 0 <= n < count; what lies below the first or above the last one, as n = -1
/// and n = count.
class Slicer {
 public:
  void operator()(const FlatPolygon& polygon, Eigen::Index axis, int count, const auto& visit) {
    const auto [low, high] = range_of(polygon, axis);
    const auto cell_of = [count](double x) {
      return int(std::clamp(std::floor(x), -1.0, double(count)));
    };
    const int first = cell_of(low), last = std::max(first, cell_of(high));
    rest_ = polygon;
    for (int n = first; n < last && rest_.size() > 2; ++n) {
      split(rest_, axis, n + 1.0, below_, above_);
      if (below_.size() > 2) visit(below_, n);
      std::swap(rest_, above_);
    }
    if (rest_.size() > 2) visit(rest_, last);
  }

 private:
  FlatPolygon rest_, below_, above_;
};

/// Strang & Fix (1973): two sets of three points, exact for polynomials of degree four.
struct TriangleRule {
  std::array<double, 2> corner;  ///< barycentric coordinates of a point: a, a, 1 - 2a
  std::array<double, 2> weight;

  TriangleRule() {
    const double root = std::sqrt(10.0), inner = std::sqrt(38.0 - 44.0 * std::sqrt(0.4)),
                 outer = std::sqrt(213125.0 - 53320.0 * root);
    corner = {(8.0 - root + inner) / 18.0, (8.0 - root - inner) / 18.0};
    weight = {(620.0 + outer) / 3720.0, (620.0 - outer) / 3720.0};
  }
};

/// What a cell gets from the facets within it, and what those add to every cell below.
struct CellSum {
  std::array<double, 8> own{};    ///< [i + 2 j + 4 k]
  std::array<double, 4> below{};  ///< [i + 2 j]: of xi^i eta^j over the facets' shadow
};

/// Adds a facet's piece within the cell with the lowest corner `corner`.
void add_piece(const FlatPolygon& piece, const Vector3& corner, CellSum& sum) {
  static const TriangleRule rule;
  for (std::size_t c = 2; c < piece.size(); ++c) {
    const std::array<Vector3, 3> at{piece[0] - corner, piece[c - 1] - corner, piece[c] - corner};
    const Vector3 u = at[1] - at[0], v = at[2] - at[0];
    const double shadow = 0.5 * (u.x() * v.y() - u.y() * v.x());
    if (shadow == 0.0) continue;
    for (std::size_t set = 0; set < 2; ++set)
      for (std::size_t alone = 0; alone < 3; ++alone) {
        const double share = rule.corner[set], rest = 1.0 - 3.0 * share;
        const Vector3 p = share * (at[0] + at[1] + at[2]) + rest * at[alone];
        const double weight = shadow * rule.weight[set];
        const std::array<double, 4> plane{weight, weight * p.x(), weight * p.y(),
                                          weight * p.x() * p.y()};
        for (std::size_t ij = 0; ij < 4; ++ij) {
          sum.below[ij] += plane[ij];
          sum.own[ij] += plane[ij] * p.z();
          sum.own[ij + 4] += 0.5 * plane[ij] * p.z() * p.z();
        }
      }
  }
}

/// One layer of the grid, across its first direction.
class Layer {
 public:
  Layer(const CubicGrid& grid, double smallest_fraction)
      : columns_(grid.size[1] - 1),
        cells_(grid.size[2] - 1),
        sums_(std::size_t(columns_) * std::size_t(cells_ + 1)),
        smallest_(std::max(smallest_fraction, round_off)) {}

  /// A facet's part within the layer i.
  void add(const FlatPolygon& part, int i) {
    across_(part, 1, columns_, [&](const FlatPolygon& strip, int j) {
      if (j < 0 || j >= columns_) return;
      along_(strip, 2, cells_, [&](const FlatPolygon& piece, int k) {
        // What lies above the grid throws its shadow on all of it.
        if (k >= 0) add_piece(piece, Vector3(i, j, k), sum(j, k));
      });
    });
  }

  /// Hands over the layer's cells and empties it.
  void finish(int i, std::vector<CutCell>& cells) {
    const std::array<double, 8> cube{1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125};
    for (int j = 0; j < columns_; ++j) {
      std::array<double, 4> above = sum(j, cells_).below;
      for (int k = cells_ - 1; k >= 0; --k) {
        CutCell cell{{i, j, k}, sum(j, k).own};
        for (std::size_t ij = 0; ij < 4; ++ij) {
          cell.moments[ij] += above[ij];
          cell.moments[ij + 4] += 0.5 * above[ij];
          above[ij] += sum(j, k).below[ij];
        }
        if (cell.moments[0] <= smallest_) continue;
        for (std::size_t m = 0; m < 8; ++m)
          cell.moments[m] = std::clamp(cell.moments[m], 0.0, cube[m]);
        if (cell.moments[0] >= 1.0 - round_off) cell.moments = cube;
        cells.push_back(cell);
      }
    }
    std::ranges::fill(sums_, CellSum{});
  }

 private:
  static constexpr double round_off = 1e-12;

  CellSum& sum(int j, int k) {
    return sums_[std::size_t(j) * std::size_t(cells_ + 1) + std::size_t(k)];
  }

  int columns_, cells_;
  std::vector<CellSum> sums_;
  double smallest_;
  Slicer across_, along_;
};

}  // namespace

std::vector<CutCell> solid_cells(const Solid& solid, const CubicGrid& grid,
                                 double smallest_fraction) {
  const TriangleMesh& mesh = solid.mesh();
  std::vector<Vector3> vertices;
  for (const Vector3& vertex : mesh.vertices) vertices.push_back(grid.coordinates(vertex));
  const int layers = grid.size[0] - 1;
  const auto facet = [&](std::size_t t) {
    FlatPolygon polygon;
    for (const int v : mesh.triangles[t]) polygon.push_back(vertices[std::size_t(v)]);
    return polygon;
  };
  std::vector<std::vector<std::size_t>> facets_of{std::size_t(std::max(layers, 0))};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [low, high] = range_of(facet(t), 0);
    const int first = int(std::clamp(std::floor(low), 0.0, double(layers))),
              last = int(std::clamp(std::floor(high), -1.0, layers - 1.0));
    for (int i = first; i <= last; ++i) facets_of[std::size_t(i)].push_back(t);
  }
  std::vector<CutCell> cells;
  Layer layer(grid, smallest_fraction);
  FlatPolygon below, above, outside;
  for (int i = 0; i < layers; ++i) {
    for (const std::size_t t : facets_of[std::size_t(i)]) {
      split(facet(t), 0, double(i), outside, above);
      if (above.size() < 3) continue;
      split(above, 0, i + 1.0, below, outside);
      // What lies in the upper wall throws no shadow.
      if (below.size() > 2) layer.add(below, i);
    }
    layer.finish(i, cells);
  }
  std::ranges::sort(cells, {}, [](const CutCell& cell) {
    return std::tuple(cell.index[2], cell.index[1], cell.index[0]);
  });
  return cells;
}

}  // namespace fingertip::meshes::inline cells
