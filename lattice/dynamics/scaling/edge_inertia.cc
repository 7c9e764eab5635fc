#include "lattice/dynamics/scaling/edge_inertia.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace fingertip::lattice {

namespace {

using Pack = EdgeInertiaRule::Pack;
using Shares = EdgeInertiaRule::Shares;
using Factors = EdgeInertiaRule::Factors;

using sweeps::Eight, sweeps::read, sweeps::write;

constexpr std::size_t edges_at_once = 32;  // packs of eight cells

/// To the next point along x, y, z.
using Strides = std::array<std::ptrdiff_t, 3>;

/// From a cell's lowest corner to the start of edge `e` of 4 along d.
[[gnu::always_inline]] inline std::ptrdiff_t edge_start(const Strides& next, std::size_t d,
                                                        std::size_t e) {
  return std::ptrdiff_t(e & 1) * next[(d + 1) % 3] + std::ptrdiff_t(e >> 1) * next[(d + 2) % 3];
}

/// Of eight cells, by row and column.
using Matrices = Eight[3][3];

[[gnu::always_inline]] inline void add_size(Eight& sum, const Eight& x) {
  sum += x < 0.0F ? -x : x;
}

/// Mean of dx/dX over a cell's rubber.
[[gnu::always_inline]] inline void find_gradients(const double* const* displacement,
                                                  const Strides& next, const Shares& shares,
                                                  double per_spacing, Matrices& F) {
  using Doubles = double __attribute__((vector_size(lanes * sizeof(double))));
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t d = 0; d < 3; ++d) {
      F[row][d] = Eight{} + (row == d ? 1.0F : 0.0F);
      for (std::size_t e = 0; e < 4; ++e) {
        const double* start = displacement[row] + edge_start(next, d, e);
        Doubles from, to;
        std::memcpy(&from, start, sizeof from);
        std::memcpy(&to, start + next[d], sizeof to);
        Eight mean;
        read(mean, shares.mean[4 * d + e]);
        F[row][d] += mean * __builtin_convertvector(per_spacing * (to - from), Eight);
      }
    }
  }
}

/// T = F⁻ᵀ, and max(J, 1/J) - 1.
[[gnu::always_inline]] inline void invert(const Matrices& F, Matrices& T, Eight& excess) {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      T[r][c] = F[r1][c1] * F[r2][c2] - F[r1][c2] * F[r2][c1];
    }
  }
  const Eight J = F[0][0] * T[0][0] + F[0][1] * T[0][1] + F[0][2] * T[0][2], one = Eight{} + 1.0F;
  // A press with cells turned inside out ends with CrushedCells; till then S stays finite.
  const Eight sound = J > 1e-3F ? J : one, inverse = one / sound;
  excess = (sound > inverse ? sound : inverse) - one;
  for (auto& row : T) {
    for (Eight& entry : row) entry *= inverse;
  }
}

/// Of |T|, and of |TᵀT|.
struct RowSums {
  Eight row[3], column[3], all, metric[3];
};

[[gnu::always_inline]] inline void add_up(const Matrices& T, RowSums& sums) {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t d = 0; d < 3; ++d) {
      add_size(sums.row[c], T[c][d]);
      add_size(sums.column[d], T[c][d]);
      add_size(sums.all, T[c][d]);
      add_size(sums.metric[c], T[0][c] * T[0][d] + T[1][c] * T[1][d] + T[2][c] * T[2][d]);
    }
  }
}

FINGERTIP_CLONES void find_moduli(const double* const* displacement, const Strides& next,
                                  const Shares* shares, double per_spacing, const Factors& f,
                                  Pack* packs, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    Pack& pack = packs[p];
    const double* const here[3] = {displacement[0] + pack.first, displacement[1] + pack.first,
                                   displacement[2] + pack.first};
    Matrices F, T;
    find_gradients(here, next, shares[pack.shares], per_spacing, F);
    Eight excess;
    invert(F, T, excess);
    RowSums sums{};
    add_up(T, sums);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        const Eight dyad = sums.row[c] * sums.column[d];
        Eight bulk{};
        add_size(bulk, sums.all * T[c][d]);
        const Eight now = f.elastic_shear * (1.0F + dyad) +
                          f.elastic_bulk * (excess * dyad + bulk) +
                          f.viscous_shear * (sums.metric[d] + dyad) + f.viscous_bulk * bulk,
                    rest = Eight{} + (c == d ? f.rest_same : f.rest_other);
        write(pack.moduli[c][d], now > rest ? now : rest);
      }
    }
  }
}

/// Adds up what cells give to the edges of component c along axis d.
FINGERTIP_CLONES void add_blocks(const Pack* packs, std::size_t count, const Shares* all,
                                 const Strides& next, std::size_t c, std::size_t d, Single spread,
                                 Single* edges) {
  for (std::size_t p = 0; p < count; ++p) {
    const Pack& pack = packs[p];
    const Shares& shares = all[pack.shares];
    Eight modulus;
    read(modulus, pack.moduli[c][d]);
    for (std::size_t e = 0; e < 4; ++e) {
      Single* const start = edges + (std::ptrdiff_t(pack.first) + edge_start(next, d, e));
      Eight sum, majorant, more;
      read(sum, start);
      read(majorant, shares.majorant[4 * d + e]);
      read(more, shares.spread[4 * d + e]);
      write(start, sum + (modulus * majorant + spread * more));
    }
  }
}

Shares whole_shares() {
  const CellEdges edges = cell_edges({0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125, 0.125});
  Shares shares;
  for (std::size_t e = 0; e < 12; ++e) {
    std::fill_n(shares.mean[e], lanes, Single(edges.mean[e]));
    std::fill_n(shares.majorant[e], lanes, Single(edges.majorant[e]));
    std::fill_n(shares.spread[e], lanes, Single(edges.spread[e]));
  }
  return shares;
}

/// Of the cells from `cell` on that lie within a pack; `cell` is the next one afterwards.
Shares take_pack(const LatticeModel& model, std::size_t& cell) {
  const std::uint32_t first = model.cells[cell];
  Shares shares;
  for (; cell < model.cells.size() && model.cells[cell] < first + lanes; ++cell) {
    const std::size_t lane = model.cells[cell] - first;
    const CellEdges& edges = model.edges[cell];
    for (std::size_t e = 0; e < 12; ++e) {
      shares.mean[e][lane] = Single(edges.mean[e]);
      shares.majorant[e][lane] = Single(edges.majorant[e]);
      shares.spread[e][lane] = Single(edges.spread[e]);
    }
  }
  return shares;
}

}  // namespace

EdgeInertiaRule::EdgeInertiaRule(const LatticeModel& model)
    : model_(&model), shares_{whole_shares()} {
  if (model.edges.empty()) {
    throw std::invalid_argument("mass scaling: the model must consist of cut cells with a law");
  }
  for (std::size_t cell = 0; cell < model.cells.size();) {
    Pack pack;
    pack.first = model.cells[cell];
    const Shares shares = take_pack(model, cell);
    if (!(shares == shares_.front())) {
      pack.shares = std::uint32_t(shares_.size());
      shares_.push_back(shares);
    }
    packs_.push_back(pack);
  }
}

/// `elastic` and `viscous`: dt²/4 and dt tau/2, with all that multiplies them.
EdgeInertiaRule::Factors EdgeInertiaRule::factors(double elastic, double viscous) const {
  const CellMaterial& m = model_->cell_lattice.material;
  const double both = elastic + viscous;
  if (m.kind == CellLawKind::cubic) {
    Factors rest{};
    rest.rest_same = Single(both * (std::abs(m.c11) + 2.0 * std::abs(m.c12)));
    rest.rest_other = Single(both * 2.0 * m.c44);
    return rest;
  }
  const double lambda = std::abs(m.lambda);
  return {Single(elastic * m.shear),
          Single(elastic * lambda),
          Single(viscous * m.shear),
          Single(viscous * lambda),
          Single(both * (3.0 * lambda + 2.0 * m.shear)),
          Single(both * 2.0 * m.shear)};
}

double EdgeInertiaRule::find(const State& state, double step, double allowance, Team& team,
                             EdgeInertia& edges) {
  const CellLattice& cells = model_->cell_lattice;
  const double unit = allowance * cells.spacing, elastic = unit * 0.25 * step * step,
               viscous = unit * 0.5 * step * cells.material.retardation_time;
  const Factors now = factors(elastic, viscous);
  const Strides next{1, cells.row, cells.plane};
  const double* displacement[3];
  for (std::size_t c = 0; c < 3; ++c) displacement[c] = state.displacement.component[c].data();
  team.split(packs_.size(), edges_at_once, [&](std::size_t begin, std::size_t end) {
    find_moduli(displacement, next, shares_.data(), 1.0 / cells.spacing, now, packs_.data() + begin,
                end - begin);
  });
  const Single spread = Single((elastic + viscous) * cells.material.bending);
  team.split(9, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::vector<Single>& edge = edges[n / 3][n % 3];
      std::fill(edge.begin(), edge.end(), 0.0F);
      add_blocks(packs_.data(), packs_.size(), shares_.data(), next, n / 3, n % 3, spread,
                 edge.data());
    }
  });
  constexpr std::size_t some = 8;  // are enough to measure it
  double sum = 0.0;
  for (std::size_t p = 0; p < packs_.size(); p += some) {
    for (std::size_t c = 0; c < 3; ++c) sum += double(packs_[p].moduli[c][c][0]);
  }
  return sum;
}

}  // namespace fingertip::lattice
