#include "lattice/scaling/body_sweeps.h"

#include <algorithm>

#include "lattice/stencil.h"

namespace fingertip::lattice::sweeps {

namespace {

/// Present positions of eight particles.
struct Places {
  double x[lanes], y[lanes], z[lanes];
};

[[gnu::always_inline]] inline void find_places(const BodyArrays& body, std::size_t block,
                                               Places& at) {
  const std::size_t p = body.blocks[block];
  const std::array<double, 3>& start = body.starts[block];
  for (std::size_t i = 0; i < lanes; ++i) {
    at.x[i] = start[0] + double(i) * body.spacing + body.displacement[0][p + i];
    at.y[i] = start[1] + body.displacement[1][p + i];
    at.z[i] = start[2] + body.displacement[2][p + i];
  }
}

/// a + w x x for eight particles.
[[gnu::always_inline]] inline void find_rigid(const BodyArrays& body, std::size_t block,
                                              const double* motion, double (&rigid)[3][lanes]) {
  const double *a = motion, *w = motion + 3;
  Places at;
  find_places(body, block, at);
  for (std::size_t i = 0; i < lanes; ++i) {
    rigid[0][i] = a[0] + (w[1] * at.z[i] - w[2] * at.y[i]);
    rigid[1][i] = a[1] + (w[2] * at.x[i] - w[0] * at.z[i]);
    rigid[2][i] = a[2] + (w[0] * at.y[i] - w[1] * at.x[i]);
  }
}

template <std::size_t count>
[[gnu::always_inline]] inline void store(const double (&lane)[count][lanes], double* sums) {
  for (std::size_t k = 0; k < count; ++k) {
    sums[k] = 0.0;
    for (const double value : lane[k]) sums[k] += value;
  }
}

}  // namespace

FINGERTIP_CLONES void load(const BodyArrays& body, std::size_t begin, std::size_t end,
                           const double* motion) {
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    double rigid[3][lanes];
    find_rigid(body, b, motion, rigid);
    for (std::size_t c = 0; c < 3; ++c) {
      Grain result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const double gain = body.inertia[p + i] * body.inverse_mass[p + i];
        result[i] = Grain(gain * body.force[c][p + i] - body.mass[p + i] * rigid[c][i]);
      }
      std::copy(result, result + lanes, body.load[c] + p);
    }
  }
}

FINGERTIP_CLONES void sum_taken(const BodyArrays& body, std::size_t begin, std::size_t end,
                                double* sums) {
  double s[6][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    Places at;
    find_places(body, b, at);
    for (std::size_t i = 0; i < lanes; ++i) {
      const double m = body.mass[p + i], fx = m * double(body.acceleration[0][p + i]),
                   fy = m * double(body.acceleration[1][p + i]),
                   fz = m * double(body.acceleration[2][p + i]);
      s[0][i] += fx;
      s[1][i] += fy;
      s[2][i] += fz;
      s[3][i] += at.y[i] * fz - at.z[i] * fy;
      s[4][i] += at.z[i] * fx - at.x[i] * fz;
      s[5][i] += at.x[i] * fy - at.y[i] * fx;
    }
  }
  store(s, sums);
}

FINGERTIP_CLONES void sum_inertia(const BodyArrays& body, std::size_t begin, std::size_t end,
                                  double* sums) {
  double s[10][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    Places at;
    find_places(body, b, at);
    for (std::size_t i = 0; i < lanes; ++i) {
      const double m = body.mass[p + i], mx = m * at.x[i], my = m * at.y[i], mz = m * at.z[i];
      s[0][i] += m;
      s[1][i] += mx;
      s[2][i] += my;
      s[3][i] += mz;
      s[4][i] += mx * at.x[i];
      s[5][i] += my * at.y[i];
      s[6][i] += mz * at.z[i];
      s[7][i] += mx * at.y[i];
      s[8][i] += my * at.z[i];
      s[9][i] += mz * at.x[i];
    }
  }
  store(s, sums);
}

FINGERTIP_CLONES void carry(const BodyArrays& body, std::size_t begin, std::size_t end,
                            const double* motion) {
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    double rigid[3][lanes];
    find_rigid(body, b, motion, rigid);
    for (std::size_t c = 0; c < 3; ++c) {
      double result[lanes];
      for (std::size_t i = 0; i < lanes; ++i)
        result[i] = body.mass[p + i] * (double(body.acceleration[c][p + i]) + rigid[c][i]);
      std::copy(result, result + lanes, body.result[c] + p);
    }
  }
}

}  // namespace fingertip::lattice::sweeps
