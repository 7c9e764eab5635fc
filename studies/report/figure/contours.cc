#include "studies/report/figure/contours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <tuple>

namespace fingertip::studies::report::inline figure {
namespace {

using Values = std::vector<double>;

bool increasing(const Values& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || (i > 0 && !(values[i] > values[i - 1]))) return false;
  }
  return values.size() >= 2;
}

/// Lagrange's polynomial through the nodes first … first + count - 1.
double polynomial(const Values& nodes, const Values& values, std::size_t first, std::size_t count,
                  double at) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + count; ++j)
      if (j != i) weight *= (at - nodes[j]) / (nodes[i] - nodes[j]);
    sum += weight * values[i];
  }
  return sum;
}

/// The value at `at` inside the interval that starts at node `left`: of the widest stencil of at
/// most four known nodes that hold the interval, the most central one.
double interpolated(const Values& nodes, const Values& values, std::size_t left, double at) {
  const auto size = std::ptrdiff_t(nodes.size()), from = std::ptrdiff_t(left);
  for (std::ptrdiff_t count = std::min<std::ptrdiff_t>(4, size); count > 2; --count) {
    for (const std::ptrdiff_t before : {1, 0, 2}) {
      const std::ptrdiff_t first = from - before;
      if (first < 0 || first + count > size || before > count - 2) continue;
      const double value = polynomial(nodes, values, std::size_t(first), std::size_t(count), at);
      if (std::isfinite(value)) return value;
    }
  }
  return polynomial(nodes, values, left, 2, at);
}

/// The nodes and what lies between them; at a node its own value, whatever its neighbours are.
Values refined_line(const Values& nodes, const Values& values, int factor) {
  Values line;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    line.push_back(values[i]);
    for (int k = 1; k < factor; ++k) {
      const double at = nodes[i] + (nodes[i + 1] - nodes[i]) * k / factor;
      line.push_back(interpolated(nodes, values, i, at));
    }
  }
  line.push_back(values.back());
  return line;
}

std::vector<Values> transposed(const std::vector<Values>& rows) {
  std::vector<Values> columns(rows.front().size());
  for (const Values& row : rows)
    for (std::size_t j = 0; j < row.size(); ++j) columns[j].push_back(row[j]);
  return columns;
}

/// An edge of the grid: its lower node and whether it runs along x.
using Edge = std::tuple<std::size_t, std::size_t, bool>;

/// Finds where the level crosses edges and which crossings a cell joins.
class LevelSearch {
 public:
  LevelSearch(const GridFunction& grid, double level) : grid_(grid), level_(level) {
    for (std::size_t i = 0; i + 1 < grid.x.size(); ++i)
      for (std::size_t j = 0; j + 1 < grid.y.size(); ++j) visit(i, j);
  }

  std::vector<Polyline> lines() {
    std::vector<Polyline> lines;
    // Open lines first, from an end; what is left then is closed.
    for (const bool open : {true, false}) {
      for (auto& [edge, neighbours] : joined_) {
        if (neighbours.empty() || (open && neighbours.size() != 1)) continue;
        lines.push_back(follow(edge));
      }
    }
    return lines;
  }

 private:
  double over(std::size_t i, std::size_t j) const { return grid_.values[i][j] - level_; }

  bool crossed(const Edge& edge) const {
    const auto [i, j, along_x] = edge;
    return (over(i, j) > 0.0) != (over(i + along_x, j + !along_x) > 0.0);
  }

  void visit(std::size_t i, std::size_t j) {
    const double middle = over(i, j) + over(i + 1, j) + over(i, j + 1) + over(i + 1, j + 1);
    if (!std::isfinite(middle)) return;
    // Around the cell, from its lower left corner.
    const std::array<Edge, 4> around{
        Edge{i, j, true}, {i + 1, j, false}, {i, j + 1, true}, {i, j, false}};
    std::vector<Edge> found;
    for (const Edge& edge : around)
      if (crossed(edge)) found.push_back(edge);
    if (found.size() == 2) join(found[0], found[1]);
    if (found.size() != 4) return;
    // A saddle: the middle belongs with the corners on its side of the level.
    const bool with_first_corner = (middle > 0.0) == (over(i, j) > 0.0);
    join(found[0], found[with_first_corner ? 1 : 3]);
    join(found[2], found[with_first_corner ? 3 : 1]);
  }

  void join(const Edge& a, const Edge& b) {
    joined_[a].push_back(b);
    joined_[b].push_back(a);
  }

  std::pair<double, double> point(const Edge& edge) const {
    const auto [i, j, along_x] = edge;
    const double from = over(i, j), to = over(i + along_x, j + !along_x);
    const double share = from / (from - to);
    const auto between = [&](const Values& nodes, std::size_t k, bool moves) {
      return moves ? nodes[k] + share * (nodes[k + 1] - nodes[k]) : nodes[k];
    };
    return {between(grid_.x, i, along_x), between(grid_.y, j, !along_x)};
  }

  /// The line through `edge`, whose joints are used up on the way.
  Polyline follow(Edge edge) {
    Polyline line{point(edge)};
    while (!joined_[edge].empty()) {
      const Edge next = joined_[edge].back();
      joined_[edge].pop_back();
      std::vector<Edge>& back = joined_[next];
      back.erase(std::find(back.begin(), back.end(), edge));
      edge = next;
      line.push_back(point(edge));
    }
    return line;
  }

  const GridFunction& grid_;
  double level_;
  std::map<Edge, std::vector<Edge>> joined_;
};

}  // namespace

bool GridFunction::valid() const {
  return increasing(x) && increasing(y) && values.size() == x.size() &&
         std::ranges::all_of(values, [&](const Values& row) { return row.size() == y.size(); });
}

GridFunction refined(const GridFunction& coarse, int factor) {
  GridFunction fine;
  fine.x = refined_line(coarse.x, coarse.x, factor);
  fine.y = refined_line(coarse.y, coarse.y, factor);
  std::vector<Values> rows;
  for (const Values& row : coarse.values) rows.push_back(refined_line(coarse.y, row, factor));
  for (const Values& column : transposed(rows))
    fine.values.push_back(refined_line(coarse.x, column, factor));
  fine.values = transposed(fine.values);
  return fine;
}

std::vector<Polyline> level_lines(const GridFunction& grid, double level) {
  return LevelSearch(grid, level).lines();
}

}  // namespace fingertip::studies::report::inline figure
