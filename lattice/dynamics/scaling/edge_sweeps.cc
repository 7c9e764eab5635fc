// Compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/dynamics/scaling/edge_sweeps.h"

#include "lattice/dynamics/scaling/eight.h"
#include "lattice/kernels/pack_algebra.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

namespace {

using Algebra = kernel::PackAlgebra<Eight>;

/// From a cell's lowest corner to the start of edge `e` of 4 along d.
std::ptrdiff_t to_edge(const EdgeArrays& arrays, std::size_t d, std::size_t e) {
  const int c = edge_start(d, e);
  return (c & 1) * arrays.next[0] + (c >> 1 & 1) * arrays.next[1] + (c >> 2) * arrays.next[2];
}

/// Entry d of a row of dx/dX, the mean over the cells' rubber.
[[gnu::always_inline]] inline Eight gradient(const EdgeArrays& arrays, const EdgePack& pack,
                                             std::size_t row, std::size_t d) {
  const EdgeShares& shares = arrays.shares[pack.shares];
  Eight sum = row == d ? 1.0F : 0.0F;
  for (std::size_t e = 0; e < 4; ++e) {
    const double* from = arrays.displacement[row] + pack.first + to_edge(arrays, d, e);
    Single slope[lanes];
    for (std::size_t i = 0; i < lanes; ++i)
      slope[i] = Single(arrays.per_spacing * (from[std::ptrdiff_t(i) + arrays.next[d]] - from[i]));
    sum += read(shares.mean[4 * d + e]) * read(slope);
  }
  return sum;
}

/// Of |T|, and of |TᵀT|.
struct RowSums {
  Eight row[3], column[3], all, metric[3];
};

[[gnu::always_inline]] inline void add_up(const Eight (&T)[3][3], RowSums& sums) {
  sums.all = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) sums.row[c] = sums.column[c] = sums.metric[c] = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t d = 0; d < 3; ++d) {
      sums.row[c] += abs(T[c][d]);
      sums.column[d] += abs(T[c][d]);
      sums.all += abs(T[c][d]);
      sums.metric[c] += abs(T[0][c] * T[0][d] + T[1][c] * T[1][d] + T[2][c] * T[2][d]);
    }
  }
}

void find_moduli(const EdgeArrays& arrays, const EdgeFactors& f, EdgePack* packs,
                 std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    EdgePack& pack = packs[p];
    const auto row = [&](std::size_t r) __attribute__((always_inline)) {
      return Algebra::Vector{gradient(arrays, pack, r, 0), gradient(arrays, pack, r, 1),
                             gradient(arrays, pack, r, 2)};
    };
    const Algebra::Rows F{row(0), row(1), row(2)}, cofactor = Algebra::cofactor(F);
    const Eight J = dot(F.x, cofactor.x);
    // A press with cells turned inside out ends with CrushedCells; till then S stays finite.
    Eight sound = 1.0F;
    where(J > 1e-3F, sound) = J;
    const Eight inverse = 1.0F / sound, excess = max(sound, inverse) - 1.0F;
    const auto [x, y, z] = Algebra::multiple(inverse, cofactor);
    const Eight T[3][3] = {{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}};  // F⁻ᵀ
    RowSums sums;
    add_up(T, sums);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t d = 0; d < 3; ++d) {
        const Eight dyad = sums.row[c] * sums.column[d], bulk = abs(sums.all * T[c][d]);
        const Eight now = f.elastic_shear * (1.0F + dyad) +
                          f.elastic_bulk * (excess * dyad + bulk) +
                          f.viscous_shear * (sums.metric[d] + dyad) + f.viscous_bulk * bulk;
        write(pack.moduli[c][d], max(Eight(c == d ? f.rest_same : f.rest_other), now));
      }
    }
  }
}

void add_blocks(const EdgeArrays& arrays, const EdgePack* packs, std::size_t count, std::size_t d,
                Single spread, Single* const* edges) {
  std::ptrdiff_t to[4];
  for (std::size_t e = 0; e < 4; ++e) to[e] = to_edge(arrays, d, e);
  for (std::size_t p = 0; p < count; ++p) {
    const EdgePack& pack = packs[p];
    const EdgeShares& shares = arrays.shares[pack.shares];
    const Eight moduli[3] = {read(pack.moduli[0][d]), read(pack.moduli[1][d]),
                             read(pack.moduli[2][d])};
    for (std::size_t e = 0; e < 4; ++e) {
      const Eight majorant = read(shares.majorant[4 * d + e]),
                  same = spread * read(shares.spread[4 * d + e]);
      for (std::size_t c = 0; c < 3; ++c) {
        Single* const start = edges[c] + (std::ptrdiff_t(pack.first) + to[e]);
        write(start, read(start) + (moduli[c] * majorant + same));
      }
    }
  }
}

constexpr EdgeLoops loops{find_moduli, add_blocks};

}  // namespace

template <int width>
const EdgeLoops& edge_loops_at() {
  return loops;
}
template const EdgeLoops& edge_loops_at<native_width>();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
