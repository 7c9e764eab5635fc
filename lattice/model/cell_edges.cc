#include "lattice/model/cell_edges.h"

#include <cmath>

namespace fingertip::lattice::inline model {

CellEdges cell_edges(const CornerMoments& moments) {
  CellEdges edges;
  for (std::size_t d = 0; d < 3; ++d) {
    std::array<double, 4> share{};
    double fraction = 0.0, roots = 0.0;
    for (std::size_t e = 0; e < 4; ++e) {
      share[e] = spring_share(moments, edge_start(d, e), half_stencil[along_axis[d]]);
      fraction += share[e];
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

}  // namespace fingertip::lattice::inline model
