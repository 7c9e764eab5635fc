#include "lattice/model/grid_cells.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline model {

using meshes::CubicGrid;
using meshes::CutCell;
using meshes::Vector3;

CornerMoments corner_moments(const CutCell& cell) {
  CornerMoments moments = cell.moments;
  // Coordinate by coordinate, the integrals with 1 and with xi become those with 1 - xi and xi.
  for (int bit = 1; bit < 8; bit *= 2) {
    for (int c = 0; c < 8; ++c) {
      if ((c & bit) == 0) moments[std::size_t(c)] -= moments[std::size_t(c | bit)];
    }
  }
  constexpr double least = 1e-9;
  if (*std::min_element(moments.begin(), moments.end()) >= least * cell.fraction()) return moments;
  for (double& moment : moments) moment = std::max(moment, least * cell.fraction());
  const double sum = std::accumulate(moments.begin(), moments.end(), 0.0);
  for (double& moment : moments) moment *= cell.fraction() / sum;
  return moments;
}

double spring_share(const CornerMoments& moments, int corner, const Direction& direction) {
  const int across =
      (direction.dx == 0 ? 1 : 0) | (direction.dy == 0 ? 2 : 0) | (direction.dz == 0 ? 4 : 0);
  double share = 0.0;
  // The shape functions of a coordinate add up to 1, which integrates the others out.
  for (int c = 0; c < 8; ++c) {
    if (((c ^ corner) & across) == 0) share += moments[std::size_t(c)];
  }
  return share;
}

Eigen::Matrix<double, 3, 8> mean_gradients(const CornerMoments& moments, double spacing,
                                           const Eigen::Matrix3d& axes) {
  const double volume = std::accumulate(moments.begin(), moments.end(), 0.0);
  Eigen::Matrix<double, 3, 8> gradients;
  for (int c = 0; c < 8; ++c) {
    for (int d = 0; d < 3; ++d) {
      const double slope = (c >> d & 1) != 0 ? 1.0 : -1.0;
      const Direction& edge = half_stencil[along_axis[std::size_t(d)]];
      gradients(d, c) = slope * spring_share(moments, c, edge) / (volume * spacing);
    }
  }
  return axes * gradients;
}

GridCells::GridCells(const CubicGrid& grid, std::vector<CutCell> cells)
    : grid_(grid),
      cells_(std::move(cells)),
      particle_at_(grid.points(), none),
      cell_at_(grid.points(), none) {
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const auto& index = cells_[c].index;
    const std::size_t lowest = grid_.index(index[0], index[1], index[2]);
    cell_at_[lowest] = std::uint32_t(c);
    for (int corner = 0; corner < 8; ++corner) {
      particle_at_[cell_corner(grid_.size, lowest, corner)] = 0;
    }
  }
  for (std::size_t point = 0; point < particle_at_.size(); ++point) {
    if (particle_at_[point] == none) continue;
    particle_at_[point] = std::uint32_t(point_of_.size());
    point_of_.push_back(std::uint32_t(point));
  }
}

Vector3 GridCells::rest_position(std::size_t particle) const {
  const auto [i, j, k] = grid_.place(point_of_[particle]);
  return grid_.position(i, j, k);
}

std::uint32_t GridCells::cell_at(int i, int j, int k) const {
  const bool inside =
      std::min({i, j, k}) >= 0 && i < grid_.size[0] && j < grid_.size[1] && k < grid_.size[2];
  return inside ? cell_at_[grid_.index(i, j, k)] : none;
}

std::array<std::uint32_t, 8> GridCells::corners(const CutCell& cell) const {
  const std::size_t lowest = grid_.index(cell.index[0], cell.index[1], cell.index[2]);
  std::array<std::uint32_t, 8> particles;
  for (int c = 0; c < 8; ++c) {
    particles[std::size_t(c)] = particle_at_[cell_corner(grid_.size, lowest, c)];
  }
  return particles;
}

namespace {

/// The cells of the piece that holds cell `first`; marks them as visited.
std::vector<std::uint32_t> piece_around(const GridCells& all, std::uint32_t first,
                                        std::vector<std::uint8_t>& visited) {
  std::vector<std::uint32_t> piece{first};
  visited[first] = 1;
  for (std::size_t next = 0; next < piece.size(); ++next) {
    for (int d = 0; d < 3; ++d) {
      for (const int step : {-1, 1}) {
        std::array<int, 3> beside = all.cells()[piece[next]].index;
        beside[std::size_t(d)] += step;
        const std::uint32_t cell = all.cell_at(beside[0], beside[1], beside[2]);
        if (cell == GridCells::none || visited[cell]) continue;
        visited[cell] = 1;
        piece.push_back(cell);
      }
    }
  }
  return piece;
}

}  // namespace

std::vector<CutCell> largest_piece(const CubicGrid& grid, const std::vector<CutCell>& cells) {
  const GridCells all(grid, cells);
  std::vector<std::uint8_t> visited(cells.size(), 0);
  std::vector<std::uint32_t> largest;
  double rubber = 0.0, in_largest = 0.0;
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    if (visited[c]) continue;
    std::vector<std::uint32_t> piece = piece_around(all, c, visited);
    double sum = 0.0;
    for (const std::uint32_t cell : piece) sum += cells[cell].fraction();
    rubber += sum;
    if (sum <= in_largest) continue;
    in_largest = sum;
    largest = std::move(piece);
  }
  if (rubber - in_largest > 1e-4 * rubber) {
    throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(grid.spacing) + " m",
                                "the lattice's cells must hang together in one piece",
                                "choose a finer lattice or another offset"});
  }
  std::sort(largest.begin(), largest.end());
  std::vector<CutCell> kept;
  kept.reserve(largest.size());
  for (const std::uint32_t c : largest) kept.push_back(cells[c]);
  return kept;
}

std::vector<CutCell> whole_cells(const std::array<int, 3>& lowest,
                                 const std::array<int, 3>& counts) {
  std::vector<CutCell> cells;
  for (int k = 0; k < counts[2]; ++k) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int i = 0; i < counts[0]; ++i) {
        cells.push_back({{lowest[0] + i, lowest[1] + j, lowest[2] + k},
                         {1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125}});
      }
    }
  }
  return cells;
}

std::array<std::vector<double>, directions> spring_shares(const GridCells& cells) {
  std::array<std::vector<double>, directions> shares;
  for (auto& share : shares) share.assign(cells.grid().points(), 0.0);
  for (const CutCell& cell : cells.cells()) {
    const CornerMoments moments = corner_moments(cell);
    const std::array<std::uint32_t, 8> corners = cells.corners(cell);
    for (const CellSpring& spring : cell_springs) {
      shares[spring.direction][cells.point(corners[std::size_t(spring.start)])] +=
          spring_share(moments, spring.start, half_stencil[spring.direction]);
    }
  }
  return shares;
}

}  // namespace fingertip::lattice::inline model
