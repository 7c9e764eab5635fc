#include "lattice/dynamics/scaling/sweeps.h"

#include <algorithm>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::sweeps {

FINGERTIP_CLONES void first_sweep(const LevelArrays& level, const std::uint32_t* blocks,
                                  std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* relaxation = level.relaxation[c] + blocks[b];
      const Single* load = level.load[c] + blocks[b];
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) result[i] = relaxation[i] * load[i];
      std::copy(result, result + lanes, level.solution[c] + blocks[b]);
    }
  }
}

namespace {

/// load - (D + S) solution of one component at eight points.
[[gnu::always_inline]] inline void residual_of(const LevelArrays& level, std::size_t c,
                                               std::size_t first, Single (&result)[lanes]) {
  const std::ptrdiff_t y = level.next[0], z = level.next[1];
  const Single *right = level.edge[c][0] + first, *up = level.edge[c][1] + first,
               *far = level.edge[c][2] + first, *inertia = level.inertia + first;
  const Single *from = level.solution[c] + first, *load = level.load[c] + first;
  for (std::size_t i = 0; i < lanes; ++i) {
    const Single* u = from + i;
    const std::ptrdiff_t n = std::ptrdiff_t(i);
    const Single sum = right[n] * (u[0] - u[1]) + right[n - 1] * (u[0] - u[-1]) +
                       up[n] * (u[0] - u[y]) + up[n - y] * (u[0] - u[-y]) + far[n] * (u[0] - u[z]) +
                       far[n - z] * (u[0] - u[-z]);
    result[i] = load[n] - inertia[n] * u[0] - sum;
  }
}

}  // namespace

FINGERTIP_CLONES void find_residual(const LevelArrays& level, const std::uint32_t* blocks,
                                    std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      Single result[lanes];
      residual_of(level, c, blocks[b], result);
      std::copy(result, result + lanes, level.residual[c] + blocks[b]);
    }
  }
}

FINGERTIP_CLONES void smooth(const LevelArrays& level, const std::uint32_t* blocks,
                             std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* relaxation = level.relaxation[c] + blocks[b];
      const Single* from = level.solution[c] + blocks[b];
      Single result[lanes];
      residual_of(level, c, blocks[b], result);
      for (std::size_t i = 0; i < lanes; ++i) result[i] = from[i] + relaxation[i] * result[i];
      std::copy(result, result + lanes, level.residual[c] + blocks[b]);
    }
  }
}

FINGERTIP_CLONES void find_relaxation(const RelaxationArrays& level, const std::uint32_t* blocks,
                                      std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t p = blocks[b];
    for (std::size_t c = 0; c < 3; ++c) {
      Single result[lanes] = {};
      for (std::size_t d = 0; d < 3; ++d) {
        const Single* edge = level.edge[c][d] + p;
        for (std::size_t i = 0; i < lanes; ++i)
          result[i] += edge[i] + edge[std::ptrdiff_t(i) - level.next[d]];
      }
      for (std::size_t i = 0; i < lanes; ++i) {
        const Single inertia = level.inertia[p + i];
        result[i] = inertia > 0.0F ? 1.0F / (inertia + level.damping * result[i]) : 0.0F;
      }
      std::copy(result, result + lanes, level.relaxation[c] + p);
    }
  }
}

FINGERTIP_CLONES void share_across(const Weights& weights, const Single* fine,
                                   const GridLevel::SheetBlock* blocks, std::size_t count,
                                   Single* sheet) {
  for (std::size_t b = 0; b < count; ++b) {
    Eight sum = {};
    for (std::ptrdiff_t z = -1; z <= 1; ++z) {
      for (std::ptrdiff_t y = -1; y <= 1; ++y) {
        Eight row;
        read(row,
             fine + (std::ptrdiff_t(blocks[b].row) + y * weights.next[0] + z * weights.next[1]));
        sum += weights.along[1][y + 1] * weights.along[2][z + 1] * row;
      }
    }
    write(sheet + blocks[b].sheet, sum);
  }
}

FINGERTIP_CLONES void share_along(const Weights& weights, const Single* sheet,
                                  const std::uint32_t* sheets, const std::uint32_t* coarse_blocks,
                                  std::size_t count, Single* coarse) {
  const Single *along = weights.along[0], all = weights.all;
  for (std::size_t b = 0; b < count; ++b) {
    const Single* from = sheet + sheets[b];
    Single result[lanes];
    for (std::size_t i = 0; i < lanes; ++i) {
      const Single* at = from + 2 * i;
      result[i] = all * (along[0] * at[-1] + along[1] * at[0] + along[2] * at[1]);
    }
    std::copy(result, result + lanes, coarse + coarse_blocks[b]);
  }
}

FINGERTIP_CLONES void gather(const TransferArrays& arrays, const GridLevel::SheetBlock* blocks,
                             std::size_t count) {
  const std::ptrdiff_t y = arrays.next[0], z = arrays.next[1];
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* from = arrays.fine[c] + blocks[b].row;
      Single* const to = arrays.sheet[c] + blocks[b].sheet;
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const Single* u = from + i;
        const Single edges = u[y] + u[-y] + u[z] + u[-z];
        const Single corners = u[y + z] + u[y - z] + u[z - y] + u[-y - z];
        result[i] = u[0] + 0.5F * edges + 0.25F * corners;
      }
      std::copy(result, result + lanes, to);
    }
  }
}

FINGERTIP_CLONES void contract(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
                               const std::uint32_t* sheets, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* from = arrays.sheet[c] + sheets[b];
      Single* const to = arrays.coarse[c] + coarse_blocks[b];
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const Single* u = from + 2 * i;
        result[i] = u[0] + 0.5F * (u[-1] + u[1]);
      }
      std::copy(result, result + lanes, to);
    }
  }
}

FINGERTIP_CLONES void stretch(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
                              const std::uint32_t* sheets, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* from = arrays.coarse[c] + coarse_blocks[b];
      Single* const to = arrays.sheet[c] + sheets[b];
      Single result[2 * lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        result[2 * i] = from[i];
        result[2 * i + 1] = 0.5F * (from[i] + from[i + 1]);
      }
      std::copy(result, result + 2 * lanes, to);
    }
  }
}

FINGERTIP_CLONES void spread(const TransferArrays& arrays, const std::uint32_t* blocks,
                             const std::array<std::uint32_t, 4>* parents, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single *one = arrays.sheet[c] + parents[b][0], *two = arrays.sheet[c] + parents[b][1],
                   *three = arrays.sheet[c] + parents[b][2],
                   *four = arrays.sheet[c] + parents[b][3];
      Single* const to = arrays.fine[c] + blocks[b];
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        result[i] = to[i] + 0.25F * ((one[i] + two[i]) + (three[i] + four[i]));
      }
      std::copy(result, result + lanes, to);
    }
  }
}

}  // namespace fingertip::lattice::sweeps
