// Compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/dynamics/scaling/sweeps.h"

#include <algorithm>

#include "lattice/dynamics/scaling/eight.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

namespace {

void first_sweep(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      write(level.solution[c] + blocks[b],
            read(level.relaxation[c] + blocks[b]) * read(level.load[c] + blocks[b]));
    }
  }
}

/// load - (D + S) solution of one component at eight points.
Eight residual_of(const LevelArrays& level, std::size_t c, std::size_t first) {
  const std::ptrdiff_t y = level.next[0], z = level.next[1];
  const Single *right = level.edge[c][0] + first, *up = level.edge[c][1] + first,
               *far = level.edge[c][2] + first, *at = level.solution[c] + first;
  const Eight u = read(at);
  const Eight sum = read(right) * (u - read(at + 1)) + read(right - 1) * (u - read(at - 1)) +
                    read(up) * (u - read(at + y)) + read(up - y) * (u - read(at - y)) +
                    read(far) * (u - read(at + z)) + read(far - z) * (u - read(at - z));
  return read(level.load[c] + first) - read(level.inertia + first) * u - sum;
}

void find_residual(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c)
      write(level.residual[c] + blocks[b], residual_of(level, c, blocks[b]));
  }
}

void smooth(const LevelArrays& level, const std::uint32_t* blocks, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Eight step = read(level.relaxation[c] + blocks[b]) * residual_of(level, c, blocks[b]);
      write(level.residual[c] + blocks[b], read(level.solution[c] + blocks[b]) + step);
    }
  }
}

void find_relaxation(const RelaxationArrays& level, const std::uint32_t* blocks,
                     std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    const Eight inertia = read(level.inertia + blocks[b]);
    for (std::size_t c = 0; c < 3; ++c) {
      Eight sum = 0.0F, result = 0.0F;
      for (std::size_t d = 0; d < 3; ++d) {
        const Single* edge = level.edge[c][d] + blocks[b];
        sum += read(edge) + read(edge - level.next[d]);
      }
      where(inertia > 0.0F, result) = 1.0F / (inertia + level.damping * sum);
      write(level.relaxation[c] + blocks[b], result);
    }
  }
}

void share_across(const Weights& weights, const Single* fine, const SheetBlock* blocks,
                  std::size_t count, Single* sheet) {
  for (std::size_t b = 0; b < count; ++b) {
    Eight sum = 0.0F;
    for (std::ptrdiff_t z = -1; z <= 1; ++z) {
      for (std::ptrdiff_t y = -1; y <= 1; ++y) {
        const std::ptrdiff_t row = y * weights.next[0] + z * weights.next[1];
        sum += weights.along[1][y + 1] * weights.along[2][z + 1] *
               read(fine + (std::ptrdiff_t(blocks[b].row) + row));
      }
    }
    write(sheet + blocks[b].sheet, sum);
  }
}

void share_along(const Weights& weights, const Single* sheet, const std::uint32_t* sheets,
                 const std::uint32_t* coarse_blocks, std::size_t count, Single* coarse) {
  const Single *along = weights.along[0], all = weights.all;
  for (std::size_t b = 0; b < count; ++b) {
    const Single* from = sheet + sheets[b];
    Single result[lanes];
    for (std::size_t i = 0; i < lanes; ++i) {
      const Single* at = from + 2 * i;
      result[i] = all * (along[0] * at[-1] + along[1] * at[0] + along[2] * at[1]);
    }
    write(coarse + coarse_blocks[b], read(result));
  }
}

void gather(const TransferArrays& arrays, const SheetBlock* blocks, std::size_t count) {
  const std::ptrdiff_t y = arrays.next[0], z = arrays.next[1];
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* u = arrays.fine[c] + blocks[b].row;
      const Eight edges = read(u + y) + read(u - y) + read(u + z) + read(u - z);
      const Eight corners = read(u + y + z) + read(u + y - z) + read(u + z - y) + read(u - y - z);
      write(arrays.sheet[c] + blocks[b].sheet, read(u) + 0.5F * edges + 0.25F * corners);
    }
  }
}

void contract(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
              const std::uint32_t* sheets, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* from = arrays.sheet[c] + sheets[b];
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const Single* u = from + 2 * i;
        result[i] = u[0] + 0.5F * (u[-1] + u[1]);
      }
      write(arrays.coarse[c] + coarse_blocks[b], read(result));
    }
  }
}

void stretch(const TransferArrays& arrays, const std::uint32_t* coarse_blocks,
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
      write(to, read(result));
      write(to + lanes, read(result + lanes));
    }
  }
}

void spread(const TransferArrays& arrays, const std::uint32_t* blocks,
            const std::array<std::uint32_t, 4>* parents, std::size_t count) {
  for (std::size_t b = 0; b < count; ++b) {
    const std::uint32_t* from = parents[b].data();
    for (std::size_t c = 0; c < 3; ++c) {
      const Single* sheet = arrays.sheet[c];
      Single* const to = arrays.fine[c] + blocks[b];
      write(to, read(to) + 0.25F * ((read(sheet + from[0]) + read(sheet + from[1])) +
                                    (read(sheet + from[2]) + read(sheet + from[3]))));
    }
  }
}

constexpr Loops loops{first_sweep, find_residual, smooth,   find_relaxation, share_across,
                      share_along, gather,        contract, stretch,         spread};

}  // namespace

template <int width>
const Loops& loops_at() {
  return loops;
}
template const Loops& loops_at<native_width>();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
