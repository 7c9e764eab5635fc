/// The kernel of the cells itself, compiled once per instruction set (cell_kernel_width2/4/8.cc).
/// Included by those files only. `Pack` is as wide as the instruction set's registers; its type
/// differs between them, which keeps their instantiations apart. Formulas: README of this folder.
#pragma once

#include <cstddef>
#include <experimental/simd>

#include "lattice/cells/cell_kernel.h"
#include "lattice/cells/pack_algebra.h"
#include "lattice/stencil.h"

namespace fingertip::lattice::kernel {

/// Every function is inlined by force: handing dozens of packs on would lead through memory.
template <typename Pack>
struct CellBody : PackAlgebra<Pack> {
  using Algebra = PackAlgebra<Pack>;
  using Algebra::cross, Algebra::dot, Algebra::load, Algebra::scaled, Algebra::store;
  using typename Algebra::Columns;
  using typename Algebra::Vector;

  static constexpr std::ptrdiff_t width = std::ptrdiff_t(Pack::size());
  static constexpr std::ptrdiff_t block = std::ptrdiff_t(lanes);

  /// A vector per bilinear mode.
  struct Modes {
    Vector yz, zx, xy, xyz;
  };
  /// Mean gradient over the rubber, by columns, and bilinear modes of a displacement or velocity.
  struct Field {
    Columns H;
    Modes q;
  };
  /// dW/dF by columns, and what is conjugate to the modes.
  struct Response {
    Columns P;
    Modes h;
  };
  struct Extremes {
    Pack jacobian, tangent, viscosity, rate;
  };

  /// Values of a block's cut cells, from the pack's first lane on.
  struct Cut {
    const double* values;

    [[gnu::always_inline]] Pack operator[](int v) const { return load(values + v * block); }
    [[gnu::always_inline]] Pack fraction() const { return (*this)[0]; }
    /// Means over the rubber.
    [[gnu::always_inline]] Vector mean() const { return {(*this)[1], (*this)[2], (*this)[3]}; }
    /// Means of yz, zx, xy.
    [[gnu::always_inline]] Vector product() const { return {(*this)[4], (*this)[5], (*this)[6]}; }
  };

  /// What the cells of the packs so far exert on the points at their right, row by row along x
  /// (corner bits y, z) and component by component. A point's force takes the sum of what its left
  /// and its right cell exert at once, formed the same way whatever the width.
  using Carry = Pack[4][3];

  /// Sums over the eight corners of one component, with the signs of x, y, z and their products.
  struct Sums {
    Pack x, y, z, yz, zx, xy, xyz;
  };

  [[gnu::always_inline]] static Sums sums(const CellArrays& a, const double* field) {
    const auto left = [&](int r) { return load(field + row_offset(a, r)); };
    const auto right = [&](int r) { return load(field + row_offset(a, r) + 1); };
    const Pack l0 = left(0), l1 = left(1), l2 = left(2), l3 = left(3);
    const Pack r0 = right(0), r1 = right(1), r2 = right(2), r3 = right(3);
    const Pack s0 = r0 + l0, s1 = r1 + l1, s2 = r2 + l2, s3 = r3 + l3;
    const Pack d0 = r0 - l0, d1 = r1 - l1, d2 = r2 - l2, d3 = r3 - l3;
    const Pack low = d0 + d1, high = d2 + d3, low_slope = d1 - d0, high_slope = d3 - d2;
    return {low + high, (s1 - s0) + (s3 - s2),  (s2 + s3) - (s0 + s1), (s3 - s2) - (s1 - s0),
            high - low, low_slope + high_slope, high_slope - low_slope};
  }

  /// The field times `factor`. Absent cells are at rest whatever their corners hold.
  template <bool Whole>
  [[gnu::always_inline]] static Field read(const CellArrays& a, const double* const* field,
                                           std::ptrdiff_t i, double factor, const Cut& cut) {
    const Sums x = sums(a, field[0] + i), y = sums(a, field[1] + i), z = sums(a, field[2] + i);
    const double unit = factor / a.spacing;
    const Pack quarter = 0.25 * unit, half = 0.5 * unit, one = unit;
    Field f{{scaled(quarter, {x.x, y.x, z.x}), scaled(quarter, {x.y, y.y, z.y}),
             scaled(quarter, {x.z, y.z, z.z})},
            {scaled(half, {x.yz, y.yz, z.yz}), scaled(half, {x.zx, y.zx, z.zx}),
             scaled(half, {x.xy, y.xy, z.xy}), scaled(one, {x.xyz, y.xyz, z.xyz})}};
    if constexpr (!Whole) {
      const auto absent = cut.fraction() == Pack(0.0);
      for (Vector* v : {&f.H.x, &f.H.y, &f.H.z, &f.q.yz, &f.q.zx, &f.q.xy, &f.q.xyz}) {
        where(absent, v->x) = Pack(0.0);
        where(absent, v->y) = Pack(0.0);
        where(absent, v->z) = Pack(0.0);
      }
      const Vector m = cut.mean(), p = cut.product();
      f.H.x = f.H.x + scaled(m.z, f.q.zx) + scaled(m.y, f.q.xy) + scaled(p.x, f.q.xyz);
      f.H.y = f.H.y + scaled(m.z, f.q.yz) + scaled(m.x, f.q.xy) + scaled(p.y, f.q.xyz);
      f.H.z = f.H.z + scaled(m.y, f.q.yz) + scaled(m.x, f.q.zx) + scaled(p.z, f.q.xyz);
    }
    return f;
  }

  /// bending Omega q.
  template <bool Whole>
  [[gnu::always_inline]] static Modes bend(double bending, const Modes& q, const Cut& cut) {
    if constexpr (Whole) {
      const Pack bilinear = 0.5 * bending, trilinear = 0.1875 * bending;
      return {scaled(bilinear, q.yz), scaled(bilinear, q.zx), scaled(bilinear, q.xy),
              scaled(trilinear, q.xyz)};
    } else {
      const auto row = [&](int v0, int v1, int v2, int v3) {
        return scaled(Pack(bending), scaled(cut[v0], q.yz) + scaled(cut[v1], q.zx) +
                                         scaled(cut[v2], q.xy) + scaled(cut[v3], q.xyz));
      };
      return {row(7, 8, 9, 10), row(8, 11, 12, 13), row(9, 12, 14, 15), row(10, 13, 15, 16)};
    }
  }

  template <bool Whole>
  [[gnu::always_inline]] static Response cubic(const CellMaterial& m, const Field& u,
                                               const Cut& cut) {
    const Columns& H = u.H;
    const Pack trace = Pack(m.c12) * (H.x.x + H.y.y + H.z.z), excess = m.c11 - m.c12;
    const Pack yz = Pack(m.c44) * (H.z.y + H.y.z), zx = Pack(m.c44) * (H.x.z + H.z.x),
               xy = Pack(m.c44) * (H.y.x + H.x.y);
    return {{{excess * H.x.x + trace, xy, zx},
             {xy, excess * H.y.y + trace, yz},
             {zx, yz, excess * H.z.z + trace}},
            bend<Whole>(m.bending, u.q, cut)};
  }

  [[gnu::always_inline]] static void extend(Extremes& e, const Pack& jacobian, const Pack& tangent,
                                            const Pack& viscosity) {
    e.jacobian = min(e.jacobian, jacobian);
    e.tangent = max(e.tangent, tangent);
    e.viscosity = max(e.viscosity, viscosity);
  }

  /// `w`: velocities times tau, as everywhere below.
  template <bool Rates>
  [[gnu::always_inline]] static Response volume(const CellMaterial& m, const Field& u,
                                                const Field& w, Extremes& extremes) {
    const Columns F = Algebra::plus_one(u.H), cofactor = Algebra::cofactor(F);
    const Pack J = dot(F.x, cofactor.x), inverse = Pack(1.0) / abs(J);
    const Pack square = Algebra::gershgorin(cofactor);  // J² g
    Pack excess = J - Pack(1.0);
    extend(extremes, J, square * (Pack(1.0) + abs(excess) * inverse), square);
    if constexpr (Rates) {
      const Pack rate = dot(cofactor.x, w.H.x) + dot(cofactor.y, w.H.y) + dot(cofactor.z, w.H.z);
      extremes.rate = max(extremes.rate, abs(rate) * inverse);
      excess += rate;
    }
    return {Algebra::multiple(Pack(m.kappa) * excess, cofactor), {}};
  }

  template <bool Rates, bool Whole>
  [[gnu::always_inline]] static Response network(const CellMaterial& m, const Field& u,
                                                 const Field& w, const Cut& cut,
                                                 Extremes& extremes) {
    const Columns F = Algebra::plus_one(u.H);
    Columns T = Algebra::cofactor(F);
    const Pack J = dot(F.x, T.x), G = m.shear, lambda = m.lambda;
    T = Algebra::multiple(Pack(1.0) / J, T);  // F⁻ᵀ
    const Pack pressure = lambda * Algebra::log(J) - G, g = Algebra::gershgorin(T);
    extend(extremes, J, (abs(pressure) + lambda) * g, g);
    Response r;
    r.h = bend<Whole>(m.bending, u.q, cut);
    if constexpr (Rates) {
      const Columns L = Algebra::times_transposed(w.H, T);
      const Modes slip{w.q.yz - L * u.q.yz, w.q.zx - L * u.q.zx, w.q.xy - L * u.q.xy,
                       w.q.xyz - L * u.q.xyz};
      const Modes drags = bend<Whole>(m.bending, slip, cut);
      r.h = {r.h.yz + drags.yz, r.h.zx + drags.zx, r.h.xy + drags.xy, r.h.xyz + drags.xyz};
      // Kirchhoff stress but for the part G F Fᵀ.
      Columns A = Algebra::twice_symmetric(G, L);
      const Pack trace = L.x.x + L.y.y + L.z.z, diagonal = pressure + lambda * trace;
      extremes.rate = max(extremes.rate, abs(trace));
      A = {A.x - drag<0>(drags, u.q), A.y - drag<1>(drags, u.q), A.z - drag<2>(drags, u.q)};
      A.x.x += diagonal;
      A.y.y += diagonal;
      A.z.z += diagonal;
      r.P = {scaled(G, F.x) + A * T.x, scaled(G, F.y) + A * T.y, scaled(G, F.z) + A * T.z};
    } else {
      r.P = {scaled(G, F.x) + scaled(pressure, T.x), scaled(G, F.y) + scaled(pressure, T.y),
             scaled(G, F.z) + scaled(pressure, T.z)};
    }
    return r;
  }

  /// Column K of the sum of g_m (x) q_m over the modes.
  template <int K>
  [[gnu::always_inline]] static Vector drag(const Modes& g, const Modes& q) {
    return scaled(Algebra::template entry<K>(q.yz), g.yz) +
           scaled(Algebra::template entry<K>(q.zx), g.zx) +
           scaled(Algebra::template entry<K>(q.xy), g.xy) +
           scaled(Algebra::template entry<K>(q.xyz), g.xyz);
  }

  /// Hands the response on to the corners. `Bent`: whether it has modes.
  template <bool Bent, bool Whole>
  [[gnu::always_inline]] static void write(const CellArrays& a, Response r, const Cut& cut,
                                           std::ptrdiff_t i, Carry& carry) {
    const double linear = -0.25 * a.spacing * a.spacing, bilinear = 2.0 * linear,
                 trilinear = 4.0 * linear;  // -a³ times the factors of read()
    Pack share = 1.0;
    if constexpr (!Whole) {
      share = cut.fraction();
      const Vector m = cut.mean(), p = cut.product();
      const Columns& P = r.P;
      const Modes fold{scaled(m.z, P.y) + scaled(m.y, P.z), scaled(m.z, P.x) + scaled(m.x, P.z),
                       scaled(m.y, P.x) + scaled(m.x, P.y),
                       scaled(p.x, P.x) + scaled(p.y, P.y) + scaled(p.z, P.z)};
      r.h = Bent ? Modes{r.h.yz + fold.yz, r.h.zx + fold.zx, r.h.xy + fold.xy, r.h.xyz + fold.xyz}
                 : fold;
    }
    const Pack first = share * Pack(linear), second = share * Pack(bilinear),
               third = share * Pack(trilinear);
    const Columns P = Algebra::multiple(first, r.P);
    if constexpr (Bent || !Whole) {
      const Modes h{scaled(second, r.h.yz), scaled(second, r.h.zx), scaled(second, r.h.xy),
                    scaled(third, r.h.xyz)};
      spread<0>(a, P, h, i, carry);
      spread<1>(a, P, h, i, carry);
      spread<2>(a, P, h, i, carry);
    } else {
      spread<0>(a, P, i, carry);
      spread<1>(a, P, i, carry);
      spread<2>(a, P, i, carry);
    }
  }

  template <int C>
  [[gnu::always_inline]] static void spread(const CellArrays& a, const Columns& P, const Modes& h,
                                            std::ptrdiff_t i, Carry& carry) {
    const Pack x = Algebra::template entry<C>(P.x), y = Algebra::template entry<C>(P.y),
               z = Algebra::template entry<C>(P.z), yz = Algebra::template entry<C>(h.yz),
               zx = Algebra::template entry<C>(h.zx), xy = Algebra::template entry<C>(h.xy),
               xyz = Algebra::template entry<C>(h.xyz);
    // Parts odd in x (they change sign from left to right) and even in x, per row.
    const Pack below = x - xy, above = x + xy, low = zx - xyz, high = zx + xyz;
    const Pack rise = y - yz, steep = y + yz;
    put<C>(a, 0, below - low, -(rise + z), i, carry);
    put<C>(a, 1, above - high, rise - z, i, carry);
    put<C>(a, 2, below + low, z - steep, i, carry);
    put<C>(a, 3, above + high, z + steep, i, carry);
  }
  template <int C>
  [[gnu::always_inline]] static void spread(const CellArrays& a, const Columns& P, std::ptrdiff_t i,
                                            Carry& carry) {
    const Pack x = Algebra::template entry<C>(P.x), y = Algebra::template entry<C>(P.y),
               z = Algebra::template entry<C>(P.z);
    put<C>(a, 0, x, -(y + z), i, carry);
    put<C>(a, 1, x, y - z, i, carry);
    put<C>(a, 2, x, z - y, i, carry);
    put<C>(a, 3, x, z + y, i, carry);
  }
  template <int C>
  [[gnu::always_inline]] static void put(const CellArrays& a, int row, const Pack& odd,
                                         const Pack& even, std::ptrdiff_t i, Carry& carry) {
    double* const force = a.force[C] + i + row_offset(a, row);
    const Pack left = even - odd, right = even + odd;
    store(force, load(force) + (left + Algebra::shifted(carry[row][C], right)));
    carry[row][C] = right;
  }

  /// From a cell's lowest corner to row `row` of its corners along x.
  [[gnu::always_inline]] static std::ptrdiff_t row_offset(const CellArrays& a, int row) {
    return (row & 1) * a.row + (row >> 1) * a.plane;
  }

  /// Adds what is left for the points at the block's right end.
  [[gnu::always_inline]] static void close(const CellArrays& a, std::ptrdiff_t end,
                                           const Carry& carry) {
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 3; ++c) a.force[c][end + row_offset(a, r)] += carry[r][c][width - 1];
    }
  }

  template <CellLawKind Law, bool Rates, bool Whole>
  [[gnu::always_inline]] static void evaluate(const CellArrays& a, const CellBlock& b,
                                              Extremes& extremes) {
    Carry carry;
    for (auto& row : carry) {
      for (Pack& component : row) component = 0.0;
    }
    for (std::ptrdiff_t lane = 0; lane < block; lane += width) {
      const Cut cut{Whole ? nullptr : a.cut + b.cut + lane};
      const std::ptrdiff_t i = std::ptrdiff_t(b.first) + lane;
      const CellMaterial& m = a.material;
      const Field u = read<Whole>(a, a.displacement, i, 1.0, cut);
      Field w;
      if constexpr (Rates) w = read<Whole>(a, a.velocity, i, m.retardation_time, cut);
      if constexpr (Law == CellLawKind::cubic) {
        write<true, Whole>(a, cubic<Whole>(m, u, cut), cut, i, carry);
      } else if constexpr (Law == CellLawKind::volume) {
        write<false, Whole>(a, volume<Rates>(m, u, w, extremes), cut, i, carry);
      } else {
        write<true, Whole>(a, network<Rates, Whole>(m, u, w, cut, extremes), cut, i, carry);
      }
    }
    close(a, std::ptrdiff_t(b.first) + block, carry);
  }

  template <CellLawKind Law, bool Rates>
  static void sweep(const CellArrays& arrays, const CellBlock* blocks, std::size_t begin,
                    std::size_t end, CellBounds& bounds) {
    const CellArrays a = arrays;  // a copy that no store can alias
    Extremes extremes{bounds.smallest_jacobian, bounds.tangent, bounds.viscosity, bounds.fastest};
    for (std::size_t b = begin; b < end; ++b) {
      if (blocks[b].cut == CellBlock::whole) {
        evaluate<Law, Rates, true>(a, blocks[b], extremes);
      } else {
        evaluate<Law, Rates, false>(a, blocks[b], extremes);
      }
    }
    bounds = {hmin(extremes.jacobian), hmax(extremes.tangent), hmax(extremes.viscosity),
              hmax(extremes.rate)};
  }

  static CellSweep select(CellLawKind law, bool rates) {
    if (law == CellLawKind::cubic) return sweep<CellLawKind::cubic, false>;
    if (law == CellLawKind::volume) {
      return rates ? sweep<CellLawKind::volume, true> : sweep<CellLawKind::volume, false>;
    }
    return rates ? sweep<CellLawKind::network, true> : sweep<CellLawKind::network, false>;
  }
};

}  // namespace fingertip::lattice::kernel
