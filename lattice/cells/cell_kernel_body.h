/// The kernel of the cells itself, compiled once per instruction set (cell_kernel_width2/4/8.cc).
/// Included by those files only. `Pack` is as wide as the instruction set's registers; its type
/// differs between them, which keeps their instantiations apart. Formulas: README of this folder.
#pragma once

#include <cstddef>
#include <experimental/simd>
#include <limits>

#include "lattice/cells/cell_energy_kernel.h"
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

  static constexpr int chunks = int(block / width);

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

  /// One component on the four edges' ends where two neighbours along y meet: of sums (s) and
  /// differences (d) along x the sum over both rows, and the upper row's less the lower one's (_z).
  struct Side {
    Pack s, d, s_z, d_z;
  };
  /// By components.
  using Sides = Side[3];

  /// At the row of points `field` and the one above it.
  [[gnu::always_inline]] static Side side(const CellArrays& a, const double* field, double factor) {
    const Pack l0 = load(field), r0 = load(field + 1);
    const Pack l1 = load(field + a.plane), r1 = load(field + a.plane + 1);
    const Pack s0 = r0 + l0, s1 = r1 + l1, d0 = r0 - l0, d1 = r1 - l1, f = factor;
    return {f * (s1 + s0), f * (d1 + d0), f * (s1 - s0), f * (d1 - d0)};
  }

  /// What sides along y make of a cell. Absent cells are at rest whatever their corners hold.
  template <bool Whole>
  [[gnu::always_inline]] static Field between(const Sides& low, const Sides& high, const Cut& cut) {
    const auto each = [&](const auto& function) {
      return Vector{function(low[0], high[0]), function(low[1], high[1]),
                    function(low[2], high[2])};
    };
    Field f{{each([](const Side& l, const Side& h) { return h.d + l.d; }),
             each([](const Side& l, const Side& h) { return h.s - l.s; }),
             each([](const Side& l, const Side& h) { return h.s_z + l.s_z; })},
            {each([](const Side& l, const Side& h) { return h.s_z - l.s_z; }),
             each([](const Side& l, const Side& h) { return h.d_z + l.d_z; }),
             each([](const Side& l, const Side& h) { return h.d - l.d; }),
             each([](const Side& l, const Side& h) { return h.d_z - l.d_z; })}};
    if constexpr (!Whole) {
      const auto absent = cut.fraction() == Pack(0.0);
      if (any_of(absent)) {
        for (Vector* v : {&f.H.x, &f.H.y, &f.H.z, &f.q.yz, &f.q.zx, &f.q.xy, &f.q.xyz}) {
          where(absent, v->x) = Pack(0.0);
          where(absent, v->y) = Pack(0.0);
          where(absent, v->z) = Pack(0.0);
        }
      }
      const Vector m = cut.mean(), p = cut.product();
      f.H.x = f.H.x + scaled(m.z, f.q.zx) + scaled(m.y, f.q.xy) + scaled(p.x, f.q.xyz);
      f.H.y = f.H.y + scaled(m.z, f.q.yz) + scaled(m.x, f.q.xy) + scaled(p.y, f.q.xyz);
      f.H.z = f.H.z + scaled(m.y, f.q.yz) + scaled(m.x, f.q.zx) + scaled(p.z, f.q.xyz);
      f.q = root(f.q, cut);
    }
    return f;
  }

  /// R q, and below Rᵀ g: cut cells know their modes by R q, whose stiffness is 1.
  [[gnu::always_inline]] static Modes root(const Modes& q, const Cut& cut) {
    return {
        scaled(cut[7], q.yz) + scaled(cut[8], q.zx) + scaled(cut[9], q.xy) + scaled(cut[10], q.xyz),
        scaled(cut[11], q.zx) + scaled(cut[12], q.xy) + scaled(cut[13], q.xyz),
        scaled(cut[14], q.xy) + scaled(cut[15], q.xyz), scaled(cut[16], q.xyz)};
  }
  [[gnu::always_inline]] static Modes transposed_root(const Modes& g, const Cut& cut) {
    return {scaled(cut[7], g.yz), scaled(cut[8], g.yz) + scaled(cut[11], g.zx),
            scaled(cut[9], g.yz) + scaled(cut[12], g.zx) + scaled(cut[14], g.xy),
            scaled(cut[10], g.yz) + scaled(cut[13], g.zx) + scaled(cut[15], g.xy) +
                scaled(cut[16], g.xyz)};
  }

  /// Stiffness of the modes times q, in the units of `area`.
  template <bool Whole>
  [[gnu::always_inline]] static Modes bend(const CellMaterial& m, const Pack& area,
                                           const Modes& q) {
    if constexpr (Whole) {
      const Pack one = area * Pack(m.bending), bilinear = Pack(2.0) * one,
                 trilinear = Pack(3.0) * one;
      return {scaled(bilinear, q.yz), scaled(bilinear, q.zx), scaled(bilinear, q.xy),
              scaled(trilinear, q.xyz)};
    } else {
      return q;
    }
  }

  /// `area`, here and below: a²/4 times the rubber's fraction, which makes stresses forces.
  template <bool Whole>
  [[gnu::always_inline]] static Response cubic(const CellMaterial& m, const Pack& area,
                                               const Field& u) {
    const Columns& H = u.H;
    const Pack c12 = area * Pack(m.c12), c44 = area * Pack(m.c44);
    const Pack trace = c12 * (H.x.x + H.y.y + H.z.z), excess = area * Pack(m.c11 - m.c12);
    const Pack yz = c44 * (H.z.y + H.y.z), zx = c44 * (H.x.z + H.z.x), xy = c44 * (H.y.x + H.x.y);
    return {{{excess * H.x.x + trace, xy, zx},
             {xy, excess * H.y.y + trace, yz},
             {zx, yz, excess * H.z.z + trace}},
            bend<Whole>(m, area, u.q)};
  }

  [[gnu::always_inline]] static void extend(Extremes& e, const Pack& jacobian, const Pack& tangent,
                                            const Pack& viscosity) {
    e.jacobian = min(e.jacobian, jacobian);
    e.tangent = max(e.tangent, tangent);
    e.viscosity = max(e.viscosity, viscosity);
  }

  /// `w`: velocities times tau, as everywhere below.
  template <bool Rates>
  [[gnu::always_inline]] static Response volume(const CellMaterial& m, const Pack& area,
                                                const Field& u, const Field& w,
                                                Extremes& extremes) {
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
    return {Algebra::multiple(area * Pack(m.kappa) * excess, cofactor), {}};
  }

  template <bool Rates, bool Whole>
  [[gnu::always_inline]] static Response network(const CellMaterial& m, const Pack& area,
                                                 const Field& u, const Field& w,
                                                 Extremes& extremes) {
    const Columns F = Algebra::plus_one(u.H);
    Columns T = Algebra::cofactor(F);
    const Pack J = dot(F.x, T.x), lambda = m.lambda, G = area * Pack(m.shear);
    T = Algebra::multiple(Pack(1.0) / J, T);  // F⁻ᵀ
    const Pack pressure = lambda * Algebra::log(J) - Pack(m.shear), g = Algebra::gershgorin(T);
    extend(extremes, J, (abs(pressure) + lambda) * g, g);
    Response r;
    r.h = bend<Whole>(m, area, u.q);
    if constexpr (Rates) {
      const Columns L = Algebra::times_transposed(w.H, T);
      const Modes slip{w.q.yz - L * u.q.yz, w.q.zx - L * u.q.zx, w.q.xy - L * u.q.xy,
                       w.q.xyz - L * u.q.xyz};
      const Modes drags = bend<Whole>(m, area, slip);
      r.h = {r.h.yz + drags.yz, r.h.zx + drags.zx, r.h.xy + drags.xy, r.h.xyz + drags.xyz};
      // Kirchhoff stress but for the part G F Fᵀ.
      Columns A = Algebra::twice_symmetric(G, L);
      const Pack trace = L.x.x + L.y.y + L.z.z, diagonal = area * (pressure + lambda * trace);
      extremes.rate = max(extremes.rate, abs(trace));
      A = {A.x - drag<0>(drags, u.q), A.y - drag<1>(drags, u.q), A.z - drag<2>(drags, u.q)};
      A.x.x += diagonal;
      A.y.y += diagonal;
      A.z.z += diagonal;
      r.P = {scaled(G, F.x) + A * T.x, scaled(G, F.y) + A * T.y, scaled(G, F.z) + A * T.z};
    } else {
      const Pack p = area * pressure;
      r.P = {scaled(G, F.x) + scaled(p, T.x), scaled(G, F.y) + scaled(p, T.y),
             scaled(G, F.z) + scaled(p, T.z)};
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

  /// Hands the response on to the sides: forces on the rows of points, with the sign reversed.
  /// `Bent`: whether it has modes. `low` receives what belongs there, `high` is overwritten.
  template <bool Bent, bool Whole>
  [[gnu::always_inline]] static void share_out(Response r, const Cut& cut, Sides& low,
                                               Sides& high) {
    if constexpr (!Whole) {
      const Vector m = cut.mean(), p = cut.product();
      const Columns& P = r.P;
      const Modes fold{scaled(m.z, P.y) + scaled(m.y, P.z), scaled(m.z, P.x) + scaled(m.x, P.z),
                       scaled(m.y, P.x) + scaled(m.x, P.y),
                       scaled(p.x, P.x) + scaled(p.y, P.y) + scaled(p.z, P.z)};
      if constexpr (Bent) {
        const Modes h = transposed_root(r.h, cut);
        r.h = {h.yz + fold.yz, h.zx + fold.zx, h.xy + fold.xy, h.xyz + fold.xyz};
      } else {
        r.h = fold;
      }
    }
    share_out<Bent || !Whole, 0>(r, low[0], high[0]);
    share_out<Bent || !Whole, 1>(r, low[1], high[1]);
    share_out<Bent || !Whole, 2>(r, low[2], high[2]);
  }
  /// Component C.
  template <bool Bent, int C>
  [[gnu::always_inline]] static void share_out(const Response& r, Side& low, Side& high) {
    const Pack x = Algebra::template entry<C>(r.P.x), y = Algebra::template entry<C>(r.P.y),
               z = Algebra::template entry<C>(r.P.z);
    if constexpr (Bent) {
      const Pack yz = Algebra::template entry<C>(r.h.yz), zx = Algebra::template entry<C>(r.h.zx),
                 xy = Algebra::template entry<C>(r.h.xy), xyz = Algebra::template entry<C>(r.h.xyz);
      low = {low.s - y, low.d + (x - xy), low.s_z + (z - yz), low.d_z + (zx - xyz)};
      high = {y, x + xy, z + yz, zx + xyz};
    } else {
      low = {low.s - y, low.d + x, low.s_z + z, low.d_z};
      high = {y, x, z, Pack(0.0)};
    }
  }

  /// What the cells of the packs so far exert on the points at their right, by rows (along z) and
  /// components. A point's force takes the sum of what its left and its right cells exert at once,
  /// formed the same way whatever the width.
  using Carry = Pack[2][3];

  [[gnu::always_inline]] static void clear(Carry& carry) {
    for (auto& row : carry) {
      for (Pack& component : row) component = 0.0;
    }
  }

  /// Adds the forces on a row of points and on the one above it.
  [[gnu::always_inline]] static void write(const CellArrays& a, const Sides& sides,
                                           std::ptrdiff_t i, Carry& carry) {
    for (int c = 0; c < 3; ++c) {
      const Side& side = sides[c];
      put(a.force[c] + i, side.s - side.s_z, side.d - side.d_z, carry[0][c]);
      put(a.force[c] + i + a.plane, side.s + side.s_z, side.d + side.d_z, carry[1][c]);
    }
  }
  [[gnu::always_inline]] static void put(double* force, const Pack& sum, const Pack& difference,
                                         Pack& carry) {
    const Pack left = sum - difference, right = sum + difference;
    store(force, load(force) - (left + Algebra::shifted(carry, right)));
    carry = right;
  }
  /// Adds what is left for the points at the block's right end.
  [[gnu::always_inline]] static void close(const CellArrays& a, std::ptrdiff_t end,
                                           const Carry& carry) {
    for (int c = 0; c < 3; ++c) {
      a.force[c][end] -= carry[0][c][width - 1];
      a.force[c][end + a.plane] -= carry[1][c][width - 1];
    }
  }

  /// Neighbours along y share a side: what has been read there, and the forces so far.
  struct Shared {
    Sides u, w, force;
  };
  /// Those along a block.
  using Border = Shared[chunks];

  template <bool Rates>
  [[gnu::always_inline]] static void read(const CellArrays& a, std::ptrdiff_t i, Sides& u,
                                          Sides& w) {
    const double factor = 0.25 / a.spacing, rate = factor * a.material.retardation_time;
    for (int c = 0; c < 3; ++c) {
      u[c] = side(a, a.displacement[c] + i, factor);
      if constexpr (Rates) w[c] = side(a, a.velocity[c] + i, rate);
    }
  }

  /// Between the borders `low` and `high`, the second of which is written.
  template <CellLawKind Law, bool Rates, bool Whole>
  [[gnu::always_inline]] static void evaluate(const CellArrays& a, const CellBlock& b, Border& lows,
                                              Border& highs, Extremes& extremes) {
    Carry carry;
    clear(carry);
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const std::ptrdiff_t lane = chunk * width, i = std::ptrdiff_t(b.first) + lane;
      const Cut cut{Whole ? nullptr : a.cut + b.cut + lane};
      const CellMaterial& m = a.material;
      Shared &low = lows[chunk], &high = highs[chunk];
      read<Rates>(a, i + a.row, high.u, high.w);
      const Field u = between<Whole>(low.u, high.u, cut);
      Field w;
      if constexpr (Rates) w = between<Whole>(low.w, high.w, cut);
      Pack area = 0.25 * a.spacing * a.spacing;
      if constexpr (!Whole) area = area * cut.fraction();
      if constexpr (Law == CellLawKind::cubic) {
        share_out<true, Whole>(cubic<Whole>(m, area, u), cut, low.force, high.force);
      } else if constexpr (Law == CellLawKind::volume) {
        share_out<false, Whole>(volume<Rates>(m, area, u, w, extremes), cut, low.force, high.force);
      } else {
        share_out<true, Whole>(network<Rates, Whole>(m, area, u, w, extremes), cut, low.force,
                               high.force);
      }
      write(a, low.force, i, carry);
    }
    close(a, std::ptrdiff_t(b.first) + block, carry);
  }

  /// Begins a column of blocks, which follow one another along y.
  template <bool Rates>
  [[gnu::always_inline]] static void open(const CellArrays& a, std::ptrdiff_t first, Border& low) {
    for (int chunk = 0; chunk < chunks; ++chunk) {
      read<Rates>(a, first + chunk * width, low[chunk].u, low[chunk].w);
      for (Side& side : low[chunk].force) side = {0.0, 0.0, 0.0, 0.0};
    }
  }
  /// Adds what is left for the column's last points.
  [[gnu::always_inline]] static void finish(const CellArrays& a, std::ptrdiff_t first,
                                            const Border& high) {
    Carry carry;
    clear(carry);
    for (int chunk = 0; chunk < chunks; ++chunk) {
      write(a, high[chunk].force, first + chunk * width, carry);
    }
    close(a, first + block, carry);
  }

  template <CellLawKind Law, bool Rates>
  static void sweep(const CellArrays& arrays, const CellBlock* blocks, std::size_t begin,
                    std::size_t end, CellBounds& bounds) {
    const CellArrays a = arrays;  // a copy that no store can alias
    Extremes extremes{bounds.smallest_jacobian, bounds.tangent, bounds.viscosity, bounds.fastest};
    Border borders[2];
    for (std::size_t b = begin; b < end; ++b) {
      const std::ptrdiff_t first = std::ptrdiff_t(blocks[b].first);
      Border &low = borders[b % 2], &high = borders[(b + 1) % 2];
      if (b == begin || std::ptrdiff_t(blocks[b - 1].first) + a.row != first) {
        open<Rates>(a, first, low);
      }
      if (blocks[b].cut == CellBlock::whole) {
        evaluate<Law, Rates, true>(a, blocks[b], low, high, extremes);
      } else {
        evaluate<Law, Rates, false>(a, blocks[b], low, high, extremes);
      }
      if (b + 1 == end || first + a.row != std::ptrdiff_t(blocks[b + 1].first)) {
        finish(a, first + a.row, high);
      }
    }
    bounds = {hmin(extremes.jacobian), hmax(extremes.tangent), hmax(extremes.viscosity),
              hmax(extremes.rate)};
  }

  [[gnu::always_inline]] static Pack power(const Columns& A, const Columns& C) {
    return dot(A.x, C.x) + dot(A.y, C.y) + dot(A.z, C.z);
  }

  /// Energy of the cells of a pack; the modes' is half of what is conjugate to them times
  /// themselves. A stress in the units of `area` is 4 a times too small for an energy.
  template <CellLawKind Law, bool Whole>
  [[gnu::always_inline]] static Pack energy_of(const CellArrays& a, const Pack& area,
                                               const Field& u, Pack& smallest_jacobian) {
    const CellMaterial& m = a.material;
    const Pack twice = 2.0 * a.spacing, four = 4.0 * a.spacing;
    if constexpr (Law == CellLawKind::cubic) {
      const Response r = cubic<Whole>(m, area, u);
      return twice * (power(r.P, u.H) + modes_times(r.h, u.q));
    }
    const Columns F = Algebra::plus_one(u.H);
    const Pack J = dot(F.x, Algebra::cross(F.y, F.z));
    if constexpr (Law == CellLawKind::volume) {
      const Pack excess = J - Pack(1.0);
      return twice * area * Pack(m.kappa) * excess * excess;
    }
    smallest_jacobian = min(smallest_jacobian, J);
    // |F|² - 3 written so that it does not cancel at small strain.
    const Pack excess = Pack(2.0) * (u.H.x.x + u.H.y.y + u.H.z.z) + power(u.H, u.H);
    const Pack log_J = Algebra::log(J);
    const Pack law =
        Pack(0.5 * m.shear) * excess + (Pack(0.5 * m.lambda) * log_J - Pack(m.shear)) * log_J;
    return four * area * law + twice * modes_times(bend<Whole>(m, area, u.q), u.q);
  }
  [[gnu::always_inline]] static Pack modes_times(const Modes& g, const Modes& q) {
    return dot(g.yz, q.yz) + dot(g.zx, q.zx) + dot(g.xy, q.xy) + dot(g.xyz, q.xyz);
  }

  template <CellLawKind Law, bool Whole>
  [[gnu::always_inline]] static void add_energy(const CellArrays& a, const CellBlock& b, Pack* sum,
                                                Pack& smallest_jacobian) {
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const std::ptrdiff_t lane = chunk * width, i = std::ptrdiff_t(b.first) + lane;
      const Cut cut{Whole ? nullptr : a.cut + b.cut + lane};
      Sides low, high, none;
      read<false>(a, i, low, none);
      read<false>(a, i + a.row, high, none);
      Pack area = 0.25 * a.spacing * a.spacing;
      if constexpr (!Whole) area = area * cut.fraction();
      sum[chunk] = sum[chunk] + energy_of<Law, Whole>(a, area, between<Whole>(low, high, cut),
                                                      smallest_jacobian);
    }
  }

  template <CellLawKind Law>
  static double energy(const CellArrays& arrays, const CellBlock* blocks, std::size_t count) {
    Pack sum[chunks], smallest_jacobian = 1.0;
    for (Pack& s : sum) s = 0.0;
    for (std::size_t b = 0; b < count; ++b) {
      if (blocks[b].cut == CellBlock::whole) {
        add_energy<Law, true>(arrays, blocks[b], sum, smallest_jacobian);
      } else {
        add_energy<Law, false>(arrays, blocks[b], sum, smallest_jacobian);
      }
    }
    if (!(hmin(smallest_jacobian) > 0.0)) return std::numeric_limits<double>::infinity();
    double lane[block], total = 0.0;  // lane by lane: the same whatever the width
    for (int chunk = 0; chunk < chunks; ++chunk) store(lane + chunk * width, sum[chunk]);
    for (const double value : lane) total += value;
    return total;
  }

  static CellEnergy select_energy(CellLawKind law) {
    switch (law) {
      case CellLawKind::cubic: return energy<CellLawKind::cubic>;
      case CellLawKind::volume: return energy<CellLawKind::volume>;
      default: return energy<CellLawKind::network>;
    }
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
