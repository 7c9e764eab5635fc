/// From the deformation of a pack of cells to the forces conjugate to it, law by law; included by
/// the kernel of the cells only. Formulas: README of this folder.
#pragma once

#include <cstddef>

#include "lattice/kernels/cell_hyperelastic.h"
#include "lattice/kernels/cell_kernel.h"
#include "lattice/kernels/cell_law.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

/// Component by component, wherever components do not mix: few packs are alive at a time then.
/// Every function is inlined by force: handing dozens of packs on would lead through memory.
template <typename Pack>
struct CellResponse : Law<Pack>, Packs<Pack> {
  using Law = kernel::Law<Pack>;
  using Algebra = PackAlgebra<Pack>;
  using Algebra::contract, Algebra::transposed_times;
  using Packs<Pack>::load, Packs<Pack>::store;
  using typename Algebra::Rows;
  using Vector = PackVector<Pack>;

  static constexpr std::ptrdiff_t block = std::ptrdiff_t(lanes);

  struct Modes {
    Pack yz, zx, xy, xyz;

    [[gnu::always_inline]] friend Modes operator+(const Modes& a, const Modes& b) {
      return {a.yz + b.yz, a.zx + b.zx, a.xy + b.xy, a.xyz + b.xyz};
    }
  };
  /// Of one component of a displacement or velocity the mean gradient over the rubber and the
  /// bilinear modes; or what is conjugate to them.
  struct Row {
    Vector H;
    Modes q;
  };
  struct Field {
    Row x, y, z;
  };
  struct Extremes {
    Pack jacobian, tangent, beyond, viscosity, rate, swiftness;
  };

  /// Values of a block's cut cells, from the pack's first lane on.
  struct Cut {
    const Lanes* values;
    std::ptrdiff_t lane;

    [[gnu::always_inline]] Pack operator[](int v) const { return load(values[v].at + lane); }
    [[gnu::always_inline]] Pack fraction() const { return (*this)[0]; }
    /// Means over the rubber.
    [[gnu::always_inline]] Vector mean() const { return {(*this)[1], (*this)[2], (*this)[3]}; }
    /// Means of yz, zx, xy.
    [[gnu::always_inline]] Vector product() const { return {(*this)[4], (*this)[5], (*this)[6]}; }
  };

  /// From whole cells' gradient at the centre to the mean over the rubber.
  [[gnu::always_inline]] static Vector mean(const Row& r, const Cut& cut) {
    const Vector m = cut.mean(), p = cut.product();
    return {r.H.x + m.z * r.q.zx + m.y * r.q.xy + p.x * r.q.xyz,
            r.H.y + m.z * r.q.yz + m.x * r.q.xy + p.y * r.q.xyz,
            r.H.z + m.y * r.q.yz + m.x * r.q.zx + p.z * r.q.xyz};
  }
  /// Its transpose: what means hand back to the modes.
  [[gnu::always_inline]] static Modes fold(const Vector& P, const Cut& cut) {
    const Vector m = cut.mean(), p = cut.product();
    return {m.z * P.y + m.y * P.z, m.z * P.x + m.x * P.z, m.y * P.x + m.x * P.y,
            p.x * P.x + p.y * P.y + p.z * P.z};
  }
  /// R q, and below Rᵀ g: cut cells know their modes by R q, whose stiffness is 1.
  [[gnu::always_inline]] static Modes root(const Modes& q, const Cut& cut) {
    return {cut[7] * q.yz + cut[8] * q.zx + cut[9] * q.xy + cut[10] * q.xyz,
            cut[11] * q.zx + cut[12] * q.xy + cut[13] * q.xyz, cut[14] * q.xy + cut[15] * q.xyz,
            cut[16] * q.xyz};
  }
  [[gnu::always_inline]] static Modes transposed_root(const Modes& g, const Cut& cut) {
    return {cut[7] * g.yz, cut[8] * g.yz + cut[11] * g.zx,
            cut[9] * g.yz + cut[12] * g.zx + cut[14] * g.xy,
            cut[10] * g.yz + cut[13] * g.zx + cut[15] * g.xy + cut[16] * g.xyz};
  }

  /// Stiffness of the modes times q, in the units of `area`.
  template <bool Whole>
  [[gnu::always_inline]] static Modes bend(const CellMaterial& m, const Pack& area,
                                           const Modes& q) {
    if constexpr (Whole) {
      const Pack linear = area * Pack(m.hourglass_modulus), bilinear = Pack(2.0) * linear,
                 trilinear = Pack(3.0) * linear;
      return {bilinear * q.yz, bilinear * q.zx, bilinear * q.xy, trilinear * q.xyz};
    } else {
      return q;
    }
  }

  /// v.x a.x + v.y a.y + v.z a.z.
  template <typename Three>
  [[gnu::always_inline]] static Modes along(const Vector& v, const Three& a) {
    return {v.x * a.x.yz + v.y * a.y.yz + v.z * a.z.yz, v.x * a.x.zx + v.y * a.y.zx + v.z * a.z.zx,
            v.x * a.x.xy + v.y * a.y.xy + v.z * a.z.xy,
            v.x * a.x.xyz + v.y * a.y.xyz + v.z * a.z.xyz};
  }
  /// By components.
  struct HourglassModes {
    Modes x, y, z;
  };

  /// What cells remember (cell_kernel.h), of a block from the pack's first lane on.
  struct Memory {
    const History& history;
    std::size_t block;
    std::ptrdiff_t lane;

    [[gnu::always_inline]] std::ptrdiff_t at(int row, int k) const {
      return (std::ptrdiff_t(block) * (history.branches + 3) + row) * remembered + k;
    }
    [[gnu::always_inline]] Pack value(int row, int k) const {
      return load(history.values[at(row, k)].at + lane);
    }
    [[gnu::always_inline]] void note(int row, int k, const Pack& value) const {
      store(history.noted[at(row, k)].at + lane, value);
    }
    /// Makes of what drives the branches now what they hold.
    [[gnu::always_inline]] void fade(Pack (&values)[remembered]) const {
      if (!history.held) {
        Pack handed[remembered];  // what a call is handed lives in memory: not `values`
        for (int k = 0; k < remembered; ++k) handed[k] = values[k];
        history.noted != nullptr ? fade_from_note<true>(handed) : fade_from_note<false>(handed);
        for (int k = 0; k < remembered; ++k) values[k] = handed[k];
        return;
      }
      const int first = 1 + history.branches;
      const Pack share = history.share, before = history.first, after = history.second;
#pragma GCC unroll 18
      for (int k = 0; k < remembered; ++k)
        values[k] = share * values[k] + (before * value(first, k) + after * value(first + 1, k));
    }
    /// One function for all sweeps: inlined in each it is half of their code, for 7 % (+-10) of
    /// those that note, one in an interval.
    template <bool Noting>
    [[gnu::noinline]] void fade_from_note(Pack (&values)[remembered]) const {
      const History own = history;  // a copy that no store can alias
      const Memory memory{own, block, lane};
      const int first = 1 + own.branches;
#pragma GCC unroll 18
      for (int k = 0; k < remembered; ++k) {
        const Pack now = values[k], change = now - memory.value(0, k);
        Pack sum = 0.0, later = 0.0;
        for (int n = 0; n < own.branches; ++n) {
          const PronyBranch& f = own.prony[n];
          const Pack h = Pack(f.decay) * memory.value(1 + n, k) + Pack(f.gain) * change;
          sum = sum + h;
          if constexpr (!Noting) continue;
          later = later + Pack(f.later) * h;
          memory.note(1 + n, k, h);
        }
        values[k] = sum;
        if constexpr (!Noting) continue;
        memory.note(0, k, now);
        memory.note(first, k, sum - Pack(own.gain_now) * now);
        memory.note(first + 1, k, later - Pack(own.gain_later) * now);
      }
    }
  };

  [[gnu::always_inline]] static Rows gradient(const Field& u) {
    return {u.x.H, u.y.H, u.z.H};
  }

  /// `area`, here and below: a²/4 times the rubber's fraction, which makes stresses forces.
  template <bool Whole, typename Take>
  [[gnu::always_inline]] static void answer_cubic(const CellMaterial& m, const Pack& area,
                                                  const Field& u, const Take& take) {
    const Rows P = Law::cubic(m, area, gradient(u));
    for_components([&](auto c) __attribute__((always_inline)) {
      take(c, Row{entry<c()>(P), bend<Whole>(m, area, entry<c()>(u).q)});
    });
  }

  /// Keeps the compiler from reading what follows ahead of time, only to spill it: worth 5 % with
  /// AVX-512, where reading is cheap; with half the registers it costs as much.
  [[gnu::always_inline]] static void read_later() {
    if constexpr (Pack::size() == lanes) asm volatile("" ::: "memory");
  }

  [[gnu::always_inline]] static void extend(Extremes& e, const Pack& jacobian, const Pack& tangent,
                                            const Pack& viscosity) {
    e.jacobian = min(e.jacobian, jacobian);
    e.tangent = max(e.tangent, tangent);
    e.viscosity = max(e.viscosity, viscosity);
  }

  /// `velocity(c)`: velocities times tau, as everywhere below.
  template <bool Rates, typename Velocity, typename Take>
  [[gnu::always_inline]] static void answer_volume(const CellMaterial& m, const Pack& area,
                                                   const Field& u, const Velocity& velocity,
                                                   Extremes& extremes, const Take& take) {
    const Rows F = Algebra::plus_one(gradient(u)), cofactor = Algebra::cofactor(F);
    const Pack J = dot(F.x, cofactor.x), inverse = Pack(1.0) / abs(J);
    const Pack square = Algebra::gershgorin(cofactor);  // J² g
    Pack excess = J - Pack(1.0);
    extend(extremes, J, square * (Pack(1.0) + abs(excess) * inverse), square);
    if constexpr (Rates) {
      Pack rate = 0.0;
      for_components([&](auto c) __attribute__((always_inline)) {
        rate += dot(entry<c()>(cofactor), velocity(c).H);
      });
      extremes.rate = max(extremes.rate, abs(rate) * inverse);
      excess += rate;
    }
    const Pack pressure = Law::volume_pressure(m, area, excess);
    for_components([&](auto c) __attribute__((always_inline)) {
      take(c, Row{pressure * entry<c()>(cofactor), {}});
    });
  }

  /// Laws of large strain. Damping is that of G and lambda at rest.
  template <CellLawKind Kind, bool Rates, bool Fades, bool Whole, typename Velocity, typename Take>
  [[gnu::always_inline]] static void answer_large(const CellMaterial& m, const Pack& area,
                                                  const Field& u, const Velocity& velocity,
                                                  const Memory& history, Extremes& extremes,
                                                  const Take& take) {
    constexpr bool network = Kind == CellLawKind::network;
    using Hyperelastic = kernel::Hyperelastic<Pack>;
    const Rows F = Algebra::plus_one(gradient(u));
    Rows T = Algebra::cofactor(F);
    const Pack J = dot(F.x, T.x), lambda = m.lambda, G = area * Pack(m.shear);
    T = Algebra::multiple(Pack(1.0) / J, T);  // F⁻ᵀ
    const Pack g = Algebra::gershgorin(T);
    Pack pressure;
    typename Hyperelastic::Answer answer;
    if constexpr (network) {
      pressure = Law::network_pressure(m, J);
      extend(extremes, J, (abs(pressure) + lambda) * g, g);
    } else {
      answer = Hyperelastic::answer(m, F, T, J, excess_of<Whole>(m, area, u));
      pressure = answer.pressure;
      extend(extremes, min(J, answer.margin), answer.tangent, g);
      extremes.beyond = max(extremes.beyond, answer.beyond);
    }
    typename Hyperelastic::Symmetric Q;  // what relaxes of the stress ...
    HourglassModes faded;                // ... and of the modes
    if constexpr (Fades) {
      const HourglassModes q{u.x.q, u.y.q, u.z.q};
      HourglassModes kappa, moment;
      Pack stiffer = 1.0;
      if constexpr (!network) stiffer = answer.modes;
      for_components([&](auto c) __attribute__((always_inline)) {
        entry<c()>(kappa) = along({entry<c()>(T.x), entry<c()>(T.y), entry<c()>(T.z)}, q);
        entry<c()>(moment) = along({entry<c()>(F.x), entry<c()>(F.y), entry<c()>(F.z)}, q);
      });
      const auto mode_products = [&](const Modes& a, const Modes& b)
          __attribute__((always_inline)) {
        return stiffer * contract(bend<Whole>(m, area, a), b);
      };
      // The second Piola-Kirchhoff stress while F⁻¹ q stays as it is.
      typename Hyperelastic::Symmetric S = Hyperelastic::right_cauchy_green(T), R;
      if constexpr (network) {
        const Pack none = 0.0;
        R = {Pack(m.shear), Pack(m.shear), Pack(m.shear), none, none, none};
      } else {
        R = answer.S;
      }
      S = {area * (R.xx + pressure * S.xx) + mode_products(kappa.x, kappa.x),
           area * (R.yy + pressure * S.yy) + mode_products(kappa.y, kappa.y),
           area * (R.zz + pressure * S.zz) + mode_products(kappa.z, kappa.z),
           area * (R.yz + pressure * S.yz) + mode_products(kappa.y, kappa.z),
           area * (R.zx + pressure * S.zx) + mode_products(kappa.z, kappa.x),
           area * (R.xy + pressure * S.xy) + mode_products(kappa.x, kappa.y)};
      Pack values[remembered] = {S.xx, S.yy, S.zz, S.yz, S.zx, S.xy};
      for_components([&](auto c) __attribute__((always_inline)) {
        const Modes& k = entry<c()>(moment);
        Pack* const at = values + 6 + 4 * c();
        at[0] = stiffer * k.yz, at[1] = stiffer * k.zx;
        at[2] = stiffer * k.xy, at[3] = stiffer * k.xyz;
      });
      history.fade(values);
      Q = {values[0], values[1], values[2], values[3], values[4], values[5]};
      const Pack* const h = values + 6;
      const HourglassModes held{
          {h[0], h[1], h[2], h[3]}, {h[4], h[5], h[6], h[7]}, {h[8], h[9], h[10], h[11]}};
      for_components([&](auto c) __attribute__((always_inline)) {
        entry<c()>(faded) = along(entry<c()>(T), held);
      });
    }
    /// Of a component the stress but for the pressure, and what the modes exert.
    const auto elastic = [&](auto c) __attribute__((always_inline)) {
      Vector P;
      if constexpr (network) {
        P = G * entry<c()>(F);
      } else {
        P = area * Hyperelastic::times(entry<c()>(F), answer.S);
      }
      if constexpr (Fades) P += Hyperelastic::times(entry<c()>(F), Q);
      return P;
    };
    const auto bent = [&](auto c) __attribute__((always_inline)) {
      const Modes d = bend<Whole>(m, area, entry<c()>(u).q);
      if constexpr (network) {
        return d;
      } else {
        return Modes{answer.modes * d.yz, answer.modes * d.zx, answer.modes * d.xy,
                     answer.modes * d.xyz};
      }
    };
    if constexpr (Rates) {
      read_later();
      Rows L, drag;
      HourglassModes h;
      for_components([&](auto c) __attribute__((always_inline)) {
        const Row w = velocity(c);
        const Vector l = Algebra::times(T, w.H);
        const Modes slip{w.q.yz - (l.x * u.x.q.yz + l.y * u.y.q.yz + l.z * u.z.q.yz),
                         w.q.zx - (l.x * u.x.q.zx + l.y * u.y.q.zx + l.z * u.z.q.zx),
                         w.q.xy - (l.x * u.x.q.xy + l.y * u.y.q.xy + l.z * u.z.q.xy),
                         w.q.xyz - (l.x * u.x.q.xyz + l.y * u.y.q.xyz + l.z * u.z.q.xyz)};
        Modes d = bend<Whole>(m, area, slip);
        // What relaxes acts as damping does.
        if constexpr (Fades) d = d + bend<Whole>(m, area, entry<c()>(faded));
        entry<c()>(L) = l;
        entry<c()>(drag) = {contract(d, u.x.q), contract(d, u.y.q), contract(d, u.z.q)};
        entry<c()>(h) = bent(c) + d;
      });
      const Pack trace = L.x.x + L.y.y + L.z.z, diagonal = area * (pressure + lambda * trace);
      extremes.rate = max(extremes.rate, abs(trace));
      for_components([&](auto c) __attribute__((always_inline)) {
        const Vector& l = entry<c()>(L);
        extremes.swiftness = max(extremes.swiftness, abs(l.x) + abs(l.y) + abs(l.z));
      });
      // Kirchhoff stress but for the part G F Fᵀ.
      const Pack yz = G * (L.y.z + L.z.y), zx = G * (L.z.x + L.x.z), xy = G * (L.x.y + L.y.x);
      const Rows A{{G * (L.x.x + L.x.x) - drag.x.x + diagonal, xy - drag.x.y, zx - drag.x.z},
                   {xy - drag.y.x, G * (L.y.y + L.y.y) - drag.y.y + diagonal, yz - drag.y.z},
                   {zx - drag.z.x, yz - drag.z.y, G * (L.z.z + L.z.z) - drag.z.z + diagonal}};
      for_components([&](auto c) __attribute__((always_inline)) {
        take(c, Row{elastic(c) + transposed_times(T, entry<c()>(A)), entry<c()>(h)});
      });
    } else {
      const Pack p = area * pressure;
      for_components([&](auto c) __attribute__((always_inline)) {
        take(c, Row{elastic(c) + p * entry<c()>(T), bent(c)});
      });
    }
  }

  /// mu_h/G q:Omega:q; absent cells have none.
  template <bool Whole>
  [[gnu::always_inline]] static Pack excess_of(const CellMaterial& m, const Pack& area,
                                               const Field& u) {
    const Pack sum = contract(bend<Whole>(m, area, u.x.q), u.x.q) +
                     contract(bend<Whole>(m, area, u.y.q), u.y.q) +
                     contract(bend<Whole>(m, area, u.z.q), u.z.q);
    return sum / max(area * Pack(m.shear), Pack(1e-300));
  }

  [[gnu::always_inline]] static Pack contract(const Modes& a, const Modes& b) {
    return a.yz * b.yz + a.zx * b.zx + (a.xy * b.xy + a.xyz * b.xyz);
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
