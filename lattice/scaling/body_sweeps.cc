#include "lattice/scaling/body_sweeps.h"

#include "lattice/stencil.h"

namespace fingertip::lattice::sweeps {

FINGERTIP_CLONES void load(const BodyArrays& body, std::size_t begin, std::size_t end,
                           const double* motion) {
  const double *a = motion, *w = motion + 3;
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    for (std::size_t i = 0; i < lanes; ++i) {
      const double x = body.starts[b][0] + double(i) * body.spacing + body.displacement[0][p + i],
                   y = body.starts[b][1] + body.displacement[1][p + i],
                   z = body.starts[b][2] + body.displacement[2][p + i];
      const double m = body.mass[p + i], gain = body.inertia[p + i] * body.inverse_mass[p + i];
      body.load[0][p + i] = Grain(gain * body.force[0][p + i] - m * (a[0] + (w[1] * z - w[2] * y)));
      body.load[1][p + i] = Grain(gain * body.force[1][p + i] - m * (a[1] + (w[2] * x - w[0] * z)));
      body.load[2][p + i] = Grain(gain * body.force[2][p + i] - m * (a[2] + (w[0] * y - w[1] * x)));
    }
  }
}

FINGERTIP_CLONES void sum(const BodyArrays& body, std::size_t begin, std::size_t end,
                          double* sums) {
  double s[16][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    for (std::size_t i = 0; i < lanes; ++i) {
      const double x = body.starts[b][0] + double(i) * body.spacing + body.displacement[0][p + i],
                   y = body.starts[b][1] + body.displacement[1][p + i],
                   z = body.starts[b][2] + body.displacement[2][p + i];
      const double m = body.mass[p + i], fx = m * double(body.acceleration[0][p + i]),
                   fy = m * double(body.acceleration[1][p + i]),
                   fz = m * double(body.acceleration[2][p + i]);
      const double mx = m * x, my = m * y, mz = m * z;
      s[0][i] += fx;
      s[1][i] += fy;
      s[2][i] += fz;
      s[3][i] += y * fz - z * fy;
      s[4][i] += z * fx - x * fz;
      s[5][i] += x * fy - y * fx;
      s[6][i] += m;
      s[7][i] += mx;
      s[8][i] += my;
      s[9][i] += mz;
      s[10][i] += mx * x;
      s[11][i] += my * y;
      s[12][i] += mz * z;
      s[13][i] += mx * y;
      s[14][i] += my * z;
      s[15][i] += mz * x;
    }
  }
  for (std::size_t k = 0; k < 16; ++k) {
    sums[k] = 0.0;
    for (const double value : s[k]) sums[k] += value;
  }
}

FINGERTIP_CLONES void carry(const BodyArrays& body, std::size_t begin, std::size_t end,
                            const double* motion) {
  const double *a = motion, *w = motion + 3;
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    for (std::size_t i = 0; i < lanes; ++i) {
      const double x = body.starts[b][0] + double(i) * body.spacing + body.displacement[0][p + i],
                   y = body.starts[b][1] + body.displacement[1][p + i],
                   z = body.starts[b][2] + body.displacement[2][p + i];
      const double m = body.mass[p + i];
      body.result[0][p + i] =
          m * (double(body.acceleration[0][p + i]) + (a[0] + (w[1] * z - w[2] * y)));
      body.result[1][p + i] =
          m * (double(body.acceleration[1][p + i]) + (a[1] + (w[2] * x - w[0] * z)));
      body.result[2][p + i] =
          m * (double(body.acceleration[2][p + i]) + (a[2] + (w[0] * y - w[1] * x)));
    }
  }
}

}  // namespace fingertip::lattice::sweeps
