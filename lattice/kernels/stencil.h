/// The 26 neighbours of a particle on the cubic grid, as 13 directions and their opposites.
#pragma once

#include <array>
#include <cstddef>

namespace fingertip::lattice::inline kernels {

/// Classes of neighbours, in the order of SpringConstants: along an edge of the cell (length a), a
/// face diagonal (a√2) or a body diagonal (a√3). The squared length is (family + 1) a².
enum Family { axis = 0, face_diagonal = 1, body_diagonal = 2 };

/// One direction of the half stencil: the neighbour's grid offset and its class.
struct Direction {
  int dx, dy, dz;
  Family family;
};

inline constexpr int directions = 13;

/// Points processed together by the kernel: eight neighbours along x, the width of AVX-512.
inline constexpr std::size_t lanes = 8;

/// Every pair of neighbours occurs once: from the particle that comes first in the grid's order.
inline constexpr std::array<Direction, directions> half_stencil{{
    {1, 0, 0, axis},
    {-1, 1, 0, face_diagonal},
    {0, 1, 0, axis},
    {1, 1, 0, face_diagonal},
    {-1, -1, 1, body_diagonal},
    {0, -1, 1, face_diagonal},
    {1, -1, 1, body_diagonal},
    {-1, 0, 1, face_diagonal},
    {0, 0, 1, axis},
    {1, 0, 1, face_diagonal},
    {-1, 1, 1, body_diagonal},
    {0, 1, 1, face_diagonal},
    {1, 1, 1, body_diagonal},
}};

/// Distance to the neighbour in direction `s` in arrays over a grid of size[0] x size[1] x size[2]
/// points; always positive.
inline std::ptrdiff_t neighbour_offset(const std::array<int, 3>& size, int s) {
  const Direction& d = half_stencil[std::size_t(s)];
  return (std::ptrdiff_t(d.dz) * size[1] + d.dy) * size[0] + d.dx;
}

/// Corner c of the cell whose lowest point is `cell`: bits 0, 1, 2 of c step along x, y, z.
inline std::size_t cell_corner(const std::array<int, 3>& size, std::size_t cell, int c) {
  return cell + std::size_t(c & 1) + std::size_t(c >> 1 & 1) * std::size_t(size[0]) +
         std::size_t(c >> 2 & 1) * std::size_t(size[0]) * std::size_t(size[1]);
}

/// Directions of the half stencil along x, y and z.
inline constexpr std::array<std::size_t, 3> along_axis{0, 2, 8};

/// Of a cell's twelve edges, four along each axis: the corner where edge e of those along d starts.
/// It is up along d + 1 if e is odd, and along d + 2 if e is 2 or 3.
constexpr int edge_start(std::size_t d, std::size_t e) {
  return int(((e & 1) << (d + 1) % 3) | ((e >> 1) << (d + 2) % 3));
}

/// A spring of a cell, between two of its corners, and which direction of the half stencil it has.
struct CellSpring {
  int start = 0, end = 0;
  std::size_t direction = 0;
};

/// All of a cell: 12 edges, 12 face diagonals, 4 body diagonals; by direction.
inline constexpr std::array<CellSpring, 28> cell_springs = [] {
  std::array<CellSpring, 28> springs;
  std::size_t next = 0;
  for (std::size_t s = 0; s < half_stencil.size(); ++s) {
    const Direction& d = half_stencil[s];
    for (int c = 0; c < 8; ++c) {
      const int x = (c & 1) + d.dx, y = (c >> 1 & 1) + d.dy, z = (c >> 2 & 1) + d.dz;
      if (((x | y | z) & ~1) == 0) springs[next++] = {c, x | y << 1 | z << 2, s};
    }
  }
  return springs;
}();

/// Share of a direction's spring that one cell owns: an edge belongs to four cells, a face
/// diagonal to two, a body diagonal to one.
inline constexpr std::array<double, 3> cell_share{0.25, 0.5, 1.0};

}  // namespace fingertip::lattice::inline kernels
