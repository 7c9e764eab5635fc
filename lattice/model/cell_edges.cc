#include "lattice/model/cell_edges.h"

#include <cmath>

namespace fingertip::lattice {

CellEdges cell_edges(const CornerMoments& moments) {
  constexpr std::array<Direction, 3> along{{{1, 0, 0, axis}, {0, 1, 0, axis}, {0, 0, 1, axis}}};
  CellEdges edges;
  for (std::size_t d = 0; d < 3; ++d) {
    std::array<double, 4> share{};
    double fraction = 0.0, roots = 0.0;
    for (int e = 0; e < 4; ++e) {
      const int corner = ((e & 1) << ((d + 1) % 3)) | ((e >> 1) << ((d + 2) % 3));
      share[std::size_t(e)] = spring_share(moments, corner, along[d]);
      fraction += share[std::size_t(e)];
    }
    for (const double s : share) roots += std::sqrt(s / fraction);
    for (std::size_t e = 0; e < 4; ++e) {
      const double w = share[e] / fraction;
      edges.mean[4 * d + e] = w;
      edges.majorant[4 * d + e] = fraction * w * std::sqrt(w) * roots;
      edges.spread[4 * d + e] = fraction * w;
    }
  }
  return edges;
}

}  // namespace fingertip::lattice
