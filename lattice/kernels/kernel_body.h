/// The force kernel itself, compiled once per instruction set (kernel_widths.cc). Included by
/// that file only. `Pack` is as wide as the instruction set's registers; its type differs
/// between them, which keeps their instantiations apart.
#pragma once

#include <cstddef>
#include <cstdint>
#include <experimental/simd>
#include <utility>

#include "lattice/kernels/kernel.h"
#include "lattice/kernels/packs.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::kernel {

template <typename Pack>
struct Body : Packs<Pack> {
  using Base = Packs<Pack>;
  using Vector = PackVector<Pack>;
  using Base::load, Base::store;
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

  /// Equation (1): [k (|d| - l0) + mu d̂·(v_j - v_i)] d̂ of the spring toward direction
  /// Sign * half_stencil[S].
  template <int S, int Sign>
  static void finite_spring(const Arrays& a, std::ptrdiff_t i, const Vector& u, const Vector& v,
                            Vector& force) {
    constexpr Direction s = half_stencil[S];
    const std::ptrdiff_t step = a.neighbour[S];
    const std::ptrdiff_t j = Sign > 0 ? i + step : i - step;
    const Pack weight = load(a.weight[S] + (Sign > 0 ? i : j));
    Vector d = load(a.displacement, j) - u;
    d.x += Pack(Sign * s.dx * a.spacing);
    d.y += Pack(Sign * s.dy * a.spacing);
    d.z += Pack(Sign * s.dz * a.spacing);
    const Vector w = load(a.velocity, j) - v;
    const double rest = a.spacing * __builtin_sqrt(double(s.family) + 1.0);
    // Absent neighbours may coincide with the point: the floor keeps 0 * (1/0) out of the sum.
    const Pack floor = 1e-24 * a.spacing * a.spacing;
    const Pack square = max(dot(d, d), floor);
    const Pack inverse_length = Pack(1.0) / sqrt(square);
    const Pack rate = dot(d, w) * inverse_length;
    const Pack magnitude =
        weight * (Pack(a.stiffness[s.family]) * (Pack(1.0) - Pack(rest) * inverse_length) +
                  Pack(a.damping[s.family]) * rate * inverse_length);
    force += magnitude * d;
  }

  template <bool Finite, bool Rates, std::size_t... S>
  static void springs(const Arrays& a, std::ptrdiff_t i, const Vector& u, const Vector& v,
                      Vector& force, std::index_sequence<S...>) {
    if constexpr (Finite) {
      ((finite_spring<S, 1>(a, i, u, v, force), finite_spring<S, -1>(a, i, u, v, force)), ...);
    } else {
      (small_springs<S, Rates>(a, i, u, v, force), ...);
    }
  }

  template <bool Finite, bool Rates>
  static void gather(const Arrays& a, const std::uint32_t* blocks, std::size_t begin,
                     std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      for (std::ptrdiff_t lane = 0; lane < block; lane += width) {
        const std::ptrdiff_t i = std::ptrdiff_t(blocks[b]) + lane;
        const Vector u = load(a.displacement, i);
        Vector v{0.0, 0.0, 0.0};
        if constexpr (Rates) v = load(a.velocity, i);
        Vector force{0.0, 0.0, 0.0};
        springs<Finite, Rates>(a, i, u, v, force, std::make_index_sequence<directions>());
        store(a.force, std::size_t(i), force);
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

  static GatherForces select(const Variant& variant) {
    if (variant.finite) return gather<true, true>;
    return variant.rates ? gather<false, true> : gather<false, false>;
  }
};

}  // namespace fingertip::lattice::kernel
