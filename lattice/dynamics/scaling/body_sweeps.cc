// Compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/dynamics/scaling/body_sweeps.h"

#include <algorithm>

#include "lattice/dynamics/scaling/eight.h"

namespace fingertip::lattice::inline dynamics::inline scaling::sweeps {

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
[[gnu::always_inline]] inline void find_rigid(const Places& at, const double* motion,
                                              double (&rigid)[3][lanes]) {
  const double *a = motion, *w = motion + 3;
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

void load(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion) {
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    Places at;
    find_places(body, b, at);
    double rigid[3][lanes];
    find_rigid(at, motion, rigid);
    for (std::size_t c = 0; c < 3; ++c) {
      Single result[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        const double taken = body.mass[p + i] * rigid[c][i];
        result[i] = Single(body.gain[p + i] * body.force[c][p + i] - taken);
      }
      std::copy(result, result + lanes, body.load[c] + p);
    }
  }
}

void sum(const BodyArrays& body, std::size_t begin, std::size_t end, double* sums) {
  double s[16][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    Places at;
    find_places(body, b, at);
    for (std::size_t i = 0; i < lanes; ++i) {
      const double m = body.mass[p + i], mx = m * at.x[i], my = m * at.y[i], mz = m * at.z[i];
      const double ax = double(body.acceleration[0][p + i]),
                   ay = double(body.acceleration[1][p + i]),
                   az = double(body.acceleration[2][p + i]);
      s[0][i] += m * ax;
      s[1][i] += m * ay;
      s[2][i] += m * az;
      s[3][i] += my * az - mz * ay;
      s[4][i] += mz * ax - mx * az;
      s[5][i] += mx * ay - my * ax;
      s[6][i] += m;
      s[7][i] += mx;
      s[8][i] += my;
      s[9][i] += mz;
      s[10][i] += mx * at.x[i];
      s[11][i] += my * at.y[i];
      s[12][i] += mz * at.z[i];
      s[13][i] += mx * at.y[i];
      s[14][i] += my * at.z[i];
      s[15][i] += mz * at.x[i];
    }
  }
  store(s, sums);
}

/// Component c of eight particles that the rod accelerates by `carried`; points without a mass stay
/// where they are.
[[gnu::always_inline]] inline void move_lanes(const BodyArrays& body, std::size_t p, std::size_t c,
                                              const double (&carried)[lanes], double step,
                                              double (&momentum)[lanes],
                                              double (&twice_energy)[lanes]) {
  double* const u = body.place[c] + p;
  double* const v = body.velocity[c] + p;
  double after[lanes], place[lanes], twice[lanes];
  for (std::size_t i = 0; i < lanes; ++i) {
    const double a = double(body.acceleration[c][p + i]) + carried[i];
    const double mv = body.mass[p + i] * v[i];
    momentum[i] += mv;
    twice[i] = mv * v[i];
    after[i] = v[i] + step * (double(body.moves[p + i]) * a);
    place[i] = u[i] + step * after[i];
  }
  for (std::size_t i = 0; i < lanes; ++i) twice_energy[i] += twice[i];
  std::copy(after, after + lanes, v);
  std::copy(place, place + lanes, u);
}

void move(const BodyArrays& body, std::size_t begin, std::size_t end, const double* motion,
          double step, double* sums) {
  double s[4][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    Places at;
    find_places(body, b, at);
    double rigid[3][lanes];
    find_rigid(at, motion, rigid);
    for (std::size_t c = 0; c < 3; ++c)
      move_lanes(body, body.blocks[b], c, rigid[c], step, s[c], s[3]);
  }
  store(s, sums);
}

void move_restrained(const BodyArrays& body, std::size_t begin, std::size_t end,
                     const double* motion, const Patch& patch, double step, double* sums) {
  double before[4][lanes] = {}, s[6][lanes] = {};
  for (std::size_t b = begin; b < end; ++b) {
    const std::size_t p = body.blocks[b];
    Places at;
    find_places(body, b, at);
    double rigid[3][lanes], kept[3][lanes];
    find_rigid(at, motion, rigid);
    for (std::size_t c = 0; c < 3; ++c) {
      double carried[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        kept[c][i] = double(body.share[0][p + i]) * patch.part[0][c] +
                     double(body.share[1][p + i]) * patch.part[1][c] +
                     double(body.share[2][p + i]) * patch.part[2][c];
        carried[i] = rigid[c][i] - kept[c][i];
      }
      move_lanes(body, p, c, carried, step, before[c], before[3]);
    }
    for (std::size_t i = 0; i < lanes; ++i) {
      const double m = body.mass[p + i], fx = m * kept[0][i], fy = m * kept[1][i],
                   fz = m * kept[2][i];
      s[0][i] += fx;
      s[1][i] += fy;
      s[2][i] += fz;
      s[3][i] += at.y[i] * fz - at.z[i] * fy;
      s[4][i] += at.z[i] * fx - at.x[i] * fz;
      s[5][i] += at.x[i] * fy - at.y[i] * fx;
    }
  }
  store(before, sums);
  store(s, sums + 4);
}

constexpr BodyLoops loops{load, sum, move, move_restrained};

}  // namespace

template <int width>
const BodyLoops& body_loops_at() {
  return loops;
}
template const BodyLoops& body_loops_at<native_width>();

}  // namespace fingertip::lattice::inline dynamics::inline scaling::sweeps
