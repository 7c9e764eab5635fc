/// The kernel of the cells itself, compiled once per instruction set (cell_kernel_widths.cc).
/// Included by that file only. `Pack` is as wide as the instruction set's registers; its type
/// differs between them, which keeps their instantiations apart. Formulas: README of this folder.
#pragma once

#include <cstddef>
#include <experimental/simd>
#include <limits>

#include "lattice/kernels/cell_kernel.h"
#include "lattice/kernels/cell_response.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::inline kernels::kernel {

template <typename Pack>
struct CellBody : CellResponse<Pack> {
  using Response = CellResponse<Pack>;
  using Response::block, Response::fold, Response::load, Response::store;
  using typename Response::Cut;
  using typename Response::Extremes;
  using typename Response::Field;
  using typename Response::Modes;
  using typename Response::Row;
  using typename Response::Rows;
  using Vector = PackVector<Pack>;

  static constexpr std::ptrdiff_t width = std::ptrdiff_t(Pack::size());
  static constexpr int chunks = int(block / width);

  /// One component on the four edges' ends where two neighbours along y meet: of sums (s) and
  /// differences (d) along x the sum over both rows, and the upper row's less the lower one's (_z).
  struct Side {
    Pack s, d, s_z, d_z;

    Side() = default;
    [[gnu::always_inline]] Side(const Pack& sum, const Pack& difference, const Pack& sum_z,
                                const Pack& difference_z)
        : s(sum), d(difference), s_z(sum_z), d_z(difference_z) {}
    [[gnu::always_inline]] Side(const Side& o) : s(o.s), d(o.d), s_z(o.s_z), d_z(o.d_z) {}
    [[gnu::always_inline]] Side& operator=(const Side& o) {
      s = o.s;
      d = o.d;
      s_z = o.s_z;
      d_z = o.d_z;
      return *this;
    }
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
  [[gnu::always_inline]] static Row between(const Side& low, const Side& high, const Cut& cut) {
    Row r{{high.d + low.d, high.s - low.s, high.s_z + low.s_z},
          {high.s_z - low.s_z, high.d_z + low.d_z, high.d - low.d, high.d_z - low.d_z}};
    if constexpr (!Whole) {
      const auto absent = cut.fraction() == Pack(0.0);
      const auto seen = [&](Pack p) __attribute__((always_inline)) {
        where(absent, p) = Pack(0.0);
        return p;
      };
      r = {{seen(r.H.x), seen(r.H.y), seen(r.H.z)},
           {seen(r.q.yz), seen(r.q.zx), seen(r.q.xy), seen(r.q.xyz)}};
      r.H = Response::mean(r, cut);
      r.q = Response::root(r.q, cut);
    }
    return r;
  }

  /// Hands the response on to the sides: forces on the rows of points, with the sign reversed.
  /// `Bent`: whether it has modes. `low` receives what belongs there, `high` is overwritten.
  template <bool Bent, bool Whole>
  [[gnu::always_inline]] static void share_out(Row r, const Cut& cut, Side& low, Side& high) {
    if constexpr (!Whole) {
      if constexpr (Bent) {
        r.q = Response::transposed_root(r.q, cut) + fold(r.H, cut);
      } else {
        r.q = fold(r.H, cut);
      }
    }
    if constexpr (Bent || !Whole) {
      low = {low.s - r.H.y, low.d + (r.H.x - r.q.xy), low.s_z + (r.H.z - r.q.yz),
             low.d_z + (r.q.zx - r.q.xyz)};
      high = {r.H.y, r.H.x + r.q.xy, r.H.z + r.q.yz, r.q.zx + r.q.xyz};
    } else {
      low = {low.s - r.H.y, low.d + r.H.x, low.s_z + r.H.z, low.d_z};
      high = {r.H.y, r.H.x, r.H.z, Pack(0.0)};
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

  /// Adds the forces of component c on a row of points and on the one above it.
  [[gnu::always_inline]] static void write(const CellArrays& a, int c, const Side& side,
                                           std::ptrdiff_t i, Carry& carry) {
    put(a.force[c] + i, side.s - side.s_z, side.d - side.d_z, carry[0][c]);
    put(a.force[c] + i + a.plane, side.s + side.s_z, side.d + side.d_z, carry[1][c]);
  }
  [[gnu::always_inline]] static void put(double* force, const Pack& sum, const Pack& difference,
                                         Pack& carry) {
    const Pack left = sum - difference, right = sum + difference;
    store(force, load(force) - (left + Response::shifted(carry, right)));
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

  [[gnu::always_inline]] static Side displacements(const CellArrays& a, int c, std::ptrdiff_t i) {
    return side(a, a.displacement[c] + i, 0.25 / a.spacing);
  }
  /// Times tau.
  [[gnu::always_inline]] static Side velocities(const CellArrays& a, int c, std::ptrdiff_t i) {
    return side(a, a.velocity[c] + i, 0.25 / a.spacing * a.material.retardation_time);
  }

  /// Between the borders `low` and `high`, the second of which is written.
  /// `number`: of the block.
  template <CellLawKind Law, CellTask task, bool Whole>
  [[gnu::always_inline]] static void evaluate(const CellArrays& a, const CellBlock& b,
                                              std::size_t number, Border& lows, Border& highs,
                                              Extremes& extremes, Pack* stored) {
    constexpr bool Rates = task != CellTask::elastic, Fades = task == CellTask::relaxing;
    Carry carry;
    clear(carry);
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const std::ptrdiff_t lane = chunk * width, i = std::ptrdiff_t(b.first) + lane;
      const Cut cut{Whole ? nullptr : a.cut + b.cut, lane};
      const CellMaterial& m = a.material;
      Shared &low = lows[chunk], &high = highs[chunk];
      Field u;
      for_components([&](auto c) __attribute__((always_inline)) {
        const Side l = low.u[c()], h = displacements(a, c(), i + a.row);
        entry<c()>(u) = between<Whole>(l, h, cut);
        high.u[c()] = h;
      });
      const auto velocity = [&](auto c) __attribute__((always_inline)) {
        const Side l = low.w[c()], h = velocities(a, c(), i + a.row);
        high.w[c()] = h;
        return between<Whole>(l, h, cut);
      };
      const auto take = [&](auto c, const Row& r) __attribute__((always_inline)) {
        Side l = low.force[c()], h;
        share_out<Law != CellLawKind::volume, Whole>(r, cut, l, h);
        high.force[c()] = h;
        write(a, c(), l, i, carry);
      };
      Pack area = 0.25 * a.spacing * a.spacing;
      if constexpr (!Whole) area = area * cut.fraction();
      if constexpr (task == CellTask::storing) {
        Pack margin;  // known by the extremes
        stored[chunk] = stored[chunk] + energy_of<Law, Whole>(a, area, u, margin);
      }
      if constexpr (Law == CellLawKind::cubic) {
        Response::template answer_cubic<Whole>(m, area, u, take);
      } else if constexpr (Law == CellLawKind::volume) {
        Response::template answer_volume<Rates>(m, area, u, velocity, extremes, take);
      } else {
        const typename Response::Memory history{a.history, number, lane};
        Response::template answer_large<Law, Rates, Fades, Whole>(m, area, u, velocity, history,
                                                                  extremes, take);
      }
    }
    close(a, std::ptrdiff_t(b.first) + block, carry);
  }

  /// Begins a column of blocks, which follow one another along y.
  template <bool Rates>
  [[gnu::always_inline]] static void open(const CellArrays& a, std::ptrdiff_t first, Border& low) {
    for (int chunk = 0; chunk < chunks; ++chunk) {
      for (int c = 0; c < 3; ++c) {
        low[chunk].u[c] = displacements(a, c, first + chunk * width);
        if constexpr (Rates) low[chunk].w[c] = velocities(a, c, first + chunk * width);
        low[chunk].force[c] = {0.0, 0.0, 0.0, 0.0};
      }
    }
  }
  /// Adds what is left for the column's last points.
  [[gnu::always_inline]] static void finish(const CellArrays& a, std::ptrdiff_t first,
                                            const Border& high) {
    Carry carry;
    clear(carry);
    for (int chunk = 0; chunk < chunks; ++chunk) {
      for (int c = 0; c < 3; ++c) {
        write(a, c, high[chunk].force[c], first + chunk * width, carry);
      }
    }
    close(a, first + block, carry);
  }

  template <CellLawKind Law, CellTask task>
  static double sweep(const CellArrays& arrays, const CellBlock* blocks, std::size_t begin,
                      std::size_t end, CellBounds& bounds) {
    constexpr bool Rates = task != CellTask::elastic;
    const CellArrays a = arrays;  // a copy that no store can alias
    Pack stored[chunks];
    for (Pack& s : stored) s = 0.0;
    Extremes extremes{bounds.smallest_jacobian, bounds.tangent, bounds.beyond,
                      bounds.viscosity,         bounds.fastest, bounds.velocity_gradient};
    Border borders[2];
    for (std::size_t b = begin; b < end; ++b) {
      const std::ptrdiff_t first = std::ptrdiff_t(blocks[b].first);
      Border &low = borders[b % 2], &high = borders[(b + 1) % 2];
      if (b == begin || std::ptrdiff_t(blocks[b - 1].first) + a.row != first) {
        open<Rates>(a, first, low);
      }
      if (blocks[b].cut == CellBlock::whole) {
        evaluate<Law, task, true>(a, blocks[b], b, low, high, extremes, stored);
      } else {
        evaluate<Law, task, false>(a, blocks[b], b, low, high, extremes, stored);
      }
      if (b + 1 == end || first + a.row != std::ptrdiff_t(blocks[b + 1].first)) {
        finish(a, first + a.row, high);
      }
    }
    bounds = {hmin(extremes.jacobian),  hmax(extremes.tangent), hmax(extremes.beyond),
              hmax(extremes.viscosity), hmax(extremes.rate),    hmax(extremes.swiftness)};
    return task == CellTask::storing ? total(stored) : 0.0;
  }

  /// Lane by lane: the same whatever the width.
  static double total(const Pack* sum) {
    double lane[block], all = 0.0;
    for (int chunk = 0; chunk < chunks; ++chunk) store(lane + chunk * width, sum[chunk]);
    for (const double value : lane) all += value;
    return all;
  }

  /// Energy of the cells of a pack. A stress in the units of `area` is 4 a times too small for one.
  template <CellLawKind Law, bool Whole>
  [[gnu::always_inline]] static Pack energy_of(const CellArrays& a, const Pack& area,
                                               const Field& u, Pack& smallest_jacobian) {
    const CellMaterial& m = a.material;
    const Pack volume = Pack(4.0 * a.spacing) * area;
    const Rows H = Response::gradient(u), F = Response::plus_one(H);
    const Pack J = dot(F.x, cross(F.y, F.z));
    if constexpr (Law == CellLawKind::volume) return Response::volume_energy(m, volume, J);
    if constexpr (Law == CellLawKind::hyperelastic) {
      Pack margin;
      const Pack density = Hyperelastic<Pack>::energy(
          m, H, J, Response::template excess_of<Whole>(m, area, u), margin);
      smallest_jacobian = min(smallest_jacobian, min(J, margin));
      return volume * density;
    }
    const Pack modes = Pack(2.0 * a.spacing) *
                       (modes_energy<Whole>(m, area, u.x.q) + modes_energy<Whole>(m, area, u.y.q) +
                        modes_energy<Whole>(m, area, u.z.q));
    if constexpr (Law == CellLawKind::cubic) return Response::cubic_energy(m, volume, H) + modes;
    smallest_jacobian = min(smallest_jacobian, J);
    return Response::network_energy(m, volume, H, J) + modes;
  }
  /// Twice what they store, in the units of `area`.
  template <bool Whole>
  [[gnu::always_inline]] static Pack modes_energy(const CellMaterial& m, const Pack& area,
                                                  const Modes& q) {
    return Response::contract(Response::template bend<Whole>(m, area, q), q);
  }

  template <CellLawKind Law, bool Whole>
  [[gnu::always_inline]] static void add_energy(const CellArrays& a, const CellBlock& b, Pack* sum,
                                                Pack& smallest_jacobian) {
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const std::ptrdiff_t lane = chunk * width, i = std::ptrdiff_t(b.first) + lane;
      const Cut cut{Whole ? nullptr : a.cut + b.cut, lane};
      Field u;
      for_components([&](auto c) __attribute__((always_inline)) {
        entry<c()>(u) =
            between<Whole>(displacements(a, c(), i), displacements(a, c(), i + a.row), cut);
      });
      Pack area = 0.25 * a.spacing * a.spacing;
      if constexpr (!Whole) area = area * cut.fraction();
      sum[chunk] = sum[chunk] + energy_of<Law, Whole>(a, area, u, smallest_jacobian);
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
    return total(sum);
  }

  static CellEnergy select_energy(CellLawKind law) {
    switch (law) {
      case CellLawKind::cubic: return energy<CellLawKind::cubic>;
      case CellLawKind::volume: return energy<CellLawKind::volume>;
      case CellLawKind::hyperelastic: return energy<CellLawKind::hyperelastic>;
      default: return energy<CellLawKind::network>;
    }
  }

  template <CellLawKind Law>
  static CellSweep damped(CellTask task) {
    return task == CellTask::elastic ? sweep<Law, CellTask::elastic> : sweep<Law, CellTask::damped>;
  }
  static CellSweep select(CellLawKind law, CellTask task) {
    using Kind = CellLawKind;
    const bool relaxes = task == CellTask::relaxing;
    switch (law) {
      case Kind::cubic: return sweep<Kind::cubic, CellTask::elastic>;
      case Kind::volume: return damped<Kind::volume>(task);
      case Kind::hyperelastic:
        return relaxes ? sweep<Kind::hyperelastic, CellTask::relaxing>
                       : damped<Kind::hyperelastic>(task);
      default: break;
    }
    if (task == CellTask::storing) return sweep<Kind::network, CellTask::storing>;
    return relaxes ? sweep<Kind::network, CellTask::relaxing> : damped<Kind::network>(task);
  }
};

}  // namespace fingertip::lattice::inline kernels::kernel
