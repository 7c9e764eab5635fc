/// The force kernel itself, compiled once per instruction set (kernel_widths.cc). Included by
/// that file only. `Pack` is as wide as the instruction set's registers; its type differs
/// between them, which keeps their instantiations apart.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#include <utility>

#include "lattice/kernels/kernel.h"
#include "lattice/kernels/packs.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

template <typename Pack>
struct Body : Packs<Pack> {
  using Base = Packs<Pack>;
  using Vector = PackVector<Pack>;
  using Base::load, Base::store, Base::keep;
  static constexpr std::ptrdiff_t width = std::ptrdiff_t(Base::width);
  static constexpr std::ptrdiff_t block = std::ptrdiff_t(lanes);

  static Vector load(const double* const* field, std::ptrdiff_t i) {
    return Base::load(field, std::size_t(i));
  }

  /// sign * value with sign known at compile time; vanishes for 0.
  template <int Sign>
  static void add_signed(Pack& sum, const Pack& value) {
    if constexpr (Sign > 0) sum += value;
    if constexpr (Sign < 0) sum -= value;
  }
  template <int S>
  static Pack along(const Vector& v) {  // the grid direction s times v
    constexpr Direction d = half_stencil[S];
    Pack sum = 0.0;
    add_signed<d.dx>(sum, v.x);
    add_signed<d.dy>(sum, v.y);
    add_signed<d.dz>(sum, v.z);
    return sum;
  }
  template <int S>
  static void add_along(Vector& force, const Pack& magnitude) {
    constexpr Direction d = half_stencil[S];
    add_signed<d.dx>(force.x, magnitude);
    add_signed<d.dy>(force.y, magnitude);
    add_signed<d.dz>(force.z, magnitude);
  }
  /// Small kinematics: f = k d̂ (d̂·(u_j - u_i)) + mu d̂ (d̂·(v_j - v_i)), d̂ at rest. The law is
  /// even in d̂, so both ends of the line through i read alike.
  template <int S, bool Rates>
  static void small_springs(const Arrays& a, std::ptrdiff_t i, const Vector& u, const Vector& v,
                            Vector& force) {
    constexpr Family family = half_stencil[S].family;
    const std::ptrdiff_t step = a.neighbour[S];
    const Pack ahead = load(a.weight[S] + i), behind = load(a.weight[S] + i - step);
    const double inverse_square = 1.0 / (double(family) + 1.0);
    const Pack stretch = ahead * along<S>(load(a.displacement, i + step) - u) +
                         behind * along<S>(load(a.displacement, i - step) - u);
    Pack magnitude = Pack(a.stiffness[family] * inverse_square) * stretch;
    if constexpr (Rates) {
      const Pack rate = ahead * along<S>(load(a.velocity, i + step) - v) +
                        behind * along<S>(load(a.velocity, i - step) - v);
      magnitude += Pack(a.damping[family] * inverse_square) * rate;
    }
    add_along<S>(force, magnitude);
  }

  template <bool Rates, std::size_t... S>
  static void small_springs(const Arrays& a, std::ptrdiff_t i, const Vector& u, const Vector& v,
                            Vector& force, std::index_sequence<S...>) {
    (small_springs<S, Rates>(a, i, u, v, force), ...);
  }
  /// Every point gathers its own 26 springs: what both ends share of a line is less than what they
  /// would have to hand on.
  template <bool Rates>
  static void gather(const Arrays& a, const std::uint32_t* blocks, std::size_t begin,
                     std::size_t end, double*) {
    for (std::size_t b = begin; b < end; ++b) {
      for (std::ptrdiff_t lane = 0; lane < block; lane += width) {
        const std::ptrdiff_t i = std::ptrdiff_t(blocks[b]) + lane;
        const Vector u = load(a.displacement, i);
        Vector v{0.0, 0.0, 0.0};
        if constexpr (Rates) v = load(a.velocity, i);
        Vector force{0.0, 0.0, 0.0};
        small_springs<Rates>(a, i, u, v, force, std::make_index_sequence<directions>());
        store(a.force, std::size_t(i), force);
      }
    }
  }

  /// A run of eight points while its springs are found. What they do to their other ends is summed
  /// apart for each step dx along x, so that no two runs write the same place one after the other,
  /// and a point's sums are formed in the same order for any width.
  struct Run {
    std::ptrdiff_t i, in_plane;
    double* const* pulls[2];  ///< of this plane of points and the next: by dx + 1 and component
    Vector u, v, force;
  };
  template <std::size_t S>
  [[gnu::always_inline]] static void apply(const Arrays& a, Run& run, const Vector& pull) {
    constexpr Direction way = half_stencil[S];
    double* const* pulls = run.pulls[way.dz] + 3 * (way.dx + 1);
    const std::ptrdiff_t there = run.in_plane + way.dy * a.neighbour[along_axis[1]];
    run.force += pull;
    keep(run.force.x), keep(run.force.y), keep(run.force.z);
    store(pulls, std::size_t(there), load(pulls, there) - pull);
  }

  template <int Sign>
  static void shift(Pack& component, double spacing) {
    if constexpr (Sign > 0) component += Pack(spacing);
    if constexpr (Sign < 0) component -= Pack(spacing);
  }
  template <std::size_t S>
  [[gnu::always_inline]] static void measure(const Arrays& a, const Run& run, Vector& d,
                                             Pack& square, Pack& rate) {
    constexpr Direction way = half_stencil[S];
    const std::ptrdiff_t j = run.i + a.neighbour[S];
    d = load(a.displacement, j) - run.u;
    shift<way.dx>(d.x, a.spacing);
    shift<way.dy>(d.y, a.spacing);
    shift<way.dz>(d.z, a.spacing);
    square = dot(d, d);
    keep(square);
    rate = dot(d, load(a.velocity, j) - run.v);
    keep(rate);
  }
  /// Equation (1): [k (|d| - l0) + mu d̂·(v_j - v_i)] d̂. A spring is a long chain of operations,
  /// each of which waits for the one before: some springs take turns.
  template <std::size_t... S>
  [[gnu::always_inline]] static void finite_springs(const Arrays& a, Run& run) {
    constexpr std::size_t count = sizeof...(S);
    constexpr Family family[count] = {half_stencil[S].family...};
    const double* const weight[count] = {a.weight[S]...};
    Vector d[count];
    Pack square[count], rate[count], inverse[count];
    std::size_t n = 0;
    ((measure<S>(a, run, d[n], square[n], rate[n]), ++n), ...);
    // Absent neighbours may coincide with the point: the floor keeps 0 * (1/0) out of the sum.
    const Pack floor = 1e-24 * a.spacing * a.spacing;
    for (n = 0; n < count; ++n) {
      inverse[n] = Pack(1.0) / sqrt(max(square[n], floor));
      keep(inverse[n]);
    }
    for (n = 0; n < count; ++n) {
      const double k = a.stiffness[family[n]];
      const double rest = a.spacing * __builtin_sqrt(double(family[n]) + 1.0);
      rate[n] = Pack(a.damping[family[n]]) * rate[n] * inverse[n] - Pack(k * rest);
      keep(rate[n]);
    }
    for (n = 0; n < count; ++n) {
      inverse[n] = load(weight[n] + run.i) * (Pack(a.stiffness[family[n]]) + rate[n] * inverse[n]);
      keep(inverse[n]);
    }
    n = 0;
    ((apply<S>(a, run, inverse[n] * d[n]), ++n), ...);
  }

  template <std::size_t... Pair>
  [[gnu::always_inline]] static void all_springs(const Arrays& a, Run& run,
                                                 std::index_sequence<Pair...>) {
    finite_springs<0>(a, run);
    (finite_springs<2 * Pair + 1, 2 * Pair + 2>(a, run), ...);
  }

  /// What the springs of the points before have left for these, which is then forgotten.
  [[gnu::always_inline]] static void take(Run& run) {
    for (std::ptrdiff_t dx = 0; dx < 3; ++dx) {
      double* const* pulls = run.pulls[0] + 3 * dx;
      const std::ptrdiff_t there = run.in_plane + 1 - dx;
      run.force += load(pulls, there);
      store(pulls, std::size_t(there), Vector{0.0, 0.0, 0.0});
    }
  }

  static void sweep(const Arrays& a, const std::uint32_t* blocks, std::size_t begin,
                    std::size_t end, double* pulls) {
    // Springs from up to a plane and a row before lead to the first of these points.
    const std::ptrdiff_t reach = a.neighbour[directions - 1] + block;
    std::size_t lead = begin;
    while (lead > 0 && std::ptrdiff_t(blocks[lead - 1]) + reach > std::ptrdiff_t(blocks[begin]))
      --lead;
    double* sums[2][9];
    const std::ptrdiff_t in_plane = a.neighbour[along_axis[2]], stride = in_plane + 2 * block;
    for (std::ptrdiff_t n = 0; n < 18; ++n) sums[n / 9][n % 9] = pulls + n * stride + block;
    std::fill_n(pulls, 18 * stride, 0.0);
    for (std::size_t b = lead; b < end; ++b) {
      const std::ptrdiff_t plane = std::ptrdiff_t(blocks[b]) / in_plane;
      for (std::ptrdiff_t lane = 0; lane < block; lane += width) {
        Run run{};
        run.i = std::ptrdiff_t(blocks[b]) + lane;
        run.in_plane = run.i - plane * in_plane;
        run.pulls[0] = sums[plane & 1];
        run.pulls[1] = sums[~plane & 1];
        run.u = load(a.displacement, run.i);
        run.v = load(a.velocity, run.i);
        all_springs(a, run, std::make_index_sequence<directions / 2>());
        take(run);
        if (b >= begin) store(a.force, std::size_t(run.i), run.force);
      }
    }
  }

  static void move(const Motion& m, const std::uint32_t* blocks, std::size_t begin, std::size_t end,
                   double momentum[3]) {
    const Pack step = m.step;
    for (int c = 0; c < 3; ++c) {
      // Summed lane by lane first, so that the sum does not depend on the register width.
      Pack sum[block / width];
      for (Pack& s : sum) s = 0.0;
      for (std::size_t b = begin; b < end; ++b) {
        for (std::ptrdiff_t part = 0; part < block / width; ++part) {
          const std::ptrdiff_t i = std::ptrdiff_t(blocks[b]) + part * width;
          const Pack before = load(m.velocity[c] + i);
          const Pack after = before + step * (load(m.inverse_mass + i) * load(m.force[c] + i));
          sum[part] += load(m.mass + i) * before;
          store(m.displacement[c] + i,
                load(m.displacement[c] + i) + step * (m.symplectic ? after : before));
          store(m.velocity[c] + i, after);
        }
      }
      double lane[block];
      for (std::ptrdiff_t part = 0; part < block / width; ++part) {
        store(lane + part * width, sum[part]);
      }
      momentum[c] = 0.0;
      for (const double value : lane) momentum[c] += value;
    }
  }

  static SpringForces select(const Variant& variant) {
    if (variant.finite) return sweep;
    return variant.rates ? gather<true> : gather<false>;
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
