/// The sweep itself, compiled once per instruction set (sweep_width2/4/8.cc). Included by those
/// files only. `Pack` is one of their registers; its type keeps the instantiations apart.
///
/// README.md explains layout and order. In short: a neighbouring slot is taken against the three
/// own slots it has springs to, so that its masses are loaded once and their reactions stored
/// once, while the forces on the own slots stay in registers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/springs/sweep.h"

namespace fingertip::lattice::springs {

#define FINGERTIP_INLINE [[gnu::always_inline]] static inline
#define FINGERTIP_UNROLL _Pragma("GCC unroll 16")

template <typename Pack, bool Damped>
struct Sweep {
  using Real = typename Pack::Real;
  using Mask = LaneMask<Real>;
  using Class = ClassConstants<Real>;
  static constexpr std::ptrdiff_t W = Pack::width;
  static constexpr std::ptrdiff_t motion_slot = axes_per_slot * W, force_slot = 3 * W;

  struct Force {
    Pack along[3];
  };

  /// Ends, class and lanes of N springs: `own` is the mass the force is for, `other` its neighbour.
  template <int N>
  struct Ends {
    const Real* own[N];
    const Real* other[N];
    const Class* family[N];
    const Mask* mask[N];
  };

  /// N springs on their way from ends to coefficients. The chain of operations is long and each
  /// waits for the one before, so springs of two batches take turns: `keep` holds that order
  /// against the compiler's own.
  template <int N>
  struct Batch {
    Pack square[N];  ///< |d|², then the error of the root's estimate
    Pack rate[N];    ///< w·d
    Pack root[N];    ///< y = s/|d|, at last the coefficient: force = root d
    Pack series[N];
  };

  template <int C, int N>
  FINGERTIP_INLINE void measure(Batch<N>& b, const Ends<N>& e) {
    FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
      const Pack d = Pack::load(e.other[q] + C * W) - Pack::load(e.own[q] + C * W);
      b.square[q] = C == 0 ? d * d : multiply_add(d, d, b.square[q]);
      keep(b.square[q]);
      if constexpr (Damped) {
        const Pack w = Pack::load(e.other[q] + (3 + C) * W) - Pack::load(e.own[q] + (3 + C) * W);
        b.rate[q] = C == 0 ? d * w : multiply_add(d, w, b.rate[q]);
        keep(b.rate[q]);
      }
    }
  }

  static constexpr int refinements = 9;

  /// One of the operations that lead from |d|² and w·d to the coefficient.
  template <int Step>
  FINGERTIP_INLINE void refine_one(Pack& square, Pack& rate, Pack& root, Pack& series,
                                   const Class& c, const Mask* mask) {
    if constexpr (Pack::estimates_roots) {
      constexpr bool cubic = Pack::root_terms == 4;
      if constexpr (Step == 0) root = root_estimate(square);
      if constexpr (Step == 1) square = square * root;
      if constexpr (Step == 2) square = subtract_product(Pack::all(1), square, root);
      if constexpr (Step == 3) {
        series = multiply_add(square, Pack::all(c.series[cubic ? 3 : 1]),
                              Pack::all(c.series[cubic ? 2 : 0]));
      }
      if constexpr (Step == 4 && cubic)
        series = multiply_add(series, square, Pack::all(c.series[1]));
      if constexpr (Step == 5 && cubic)
        series = multiply_add(series, square, Pack::all(c.series[0]));
      if constexpr (Step == 6) root = root * series;
    } else if constexpr (Step == 0) {
      root = Pack::all(c.series[0]) / square_root(square);
    }
    if constexpr (Damped) {
      if constexpr (Step == 7) rate = multiply_subtract(root, rate, Pack::all(c.pull));
      if constexpr (Step == 8)
        root = multiply_add_where(Pack::mask(mask), root, rate, Pack::all(c.stiffness));
    } else if constexpr (Step == 8) {
      root = where(Pack::mask(mask),
                   subtract_product(Pack::all(c.stiffness), root, Pack::all(c.pull)));
    }
  }
  template <int Step, int N>
  FINGERTIP_INLINE void refine(Batch<N>& b, const Ends<N>& e) {
    FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
      refine_one<Step>(b.square[q], b.rate[q], b.root[q], b.series[q], *e.family[q], e.mask[q]);
      keep(b.root[q]);
    }
  }

  /// All of it, for springs that have no other batch to take turns with.
  template <int N>
  FINGERTIP_INLINE void find_coefficients(Batch<N>& b, const Ends<N>& e) {
    measure<0>(b, e);
    measure<1>(b, e);
    measure<2>(b, e);
    refine<0>(b, e);
    refine<1>(b, e);
    refine<2>(b, e);
    refine<3>(b, e);
    refine<4>(b, e);
    refine<5>(b, e);
    refine<6>(b, e);
    refine<7>(b, e);
    refine<8>(b, e);
  }

  /// Adds the forces of springs to one common neighbour: to `own[q]` in registers, to the
  /// neighbour's in memory.
  template <int N>
  FINGERTIP_INLINE void apply(const Batch<N>& b, const Ends<N>& e, Force* const (&own)[N],
                              Real* other) {
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      Pack reaction = Pack::load(other + c * W);
      FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
        const Pack t = b.root[q] * (Pack::load(e.other[q] + c * W) - Pack::load(e.own[q] + c * W));
        own[q]->along[c] = own[q]->along[c] + t;
        reaction = reaction - t;
      }
      reaction.store(other + c * W);
    }
  }

  /// Adds the forces of springs from one mass to N neighbours: to `own` in registers, to the
  /// others' in memory.
  template <int N>
  FINGERTIP_INLINE void apply_fan(const Batch<N>& b, const Ends<N>& e, Force& own,
                                  Real* const (&other)[N]) {
    FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
        const Pack t = b.root[q] * (Pack::load(e.other[q] + c * W) - Pack::load(e.own[q] + c * W));
        own.along[c] = own.along[c] + t;
        (Pack::load(other[q] + c * W) - t).store(other[q] + c * W);
      }
    }
  }

  /// A row of the lattice and the rows that half a stencil leads to.
  struct Row {
    Real* motion;
    Real* force;
    const Mask* masks;
    unsigned links;
    std::ptrdiff_t to_motion[linked_rows];
    Real* linked_force[linked_rows];
    const SweepConstants<Real>* constants;
  };

  static constexpr int family_of(int row, int dx) { return (row & 1) + (dx != 0 ? 1 : 0); }
  static constexpr int mask_of(int row, int dx) { return 1 + 3 * row + dx + 1; }

  template <int Lower, int Upper, int R>
  FINGERTIP_INLINE Ends<1 + Lower + Upper> ends(const Row& row, std::ptrdiff_t slot) {
    Ends<1 + Lower + Upper> e;
    FINGERTIP_UNROLL for (int q = 0; q < 1 + Lower + Upper; ++q) {
      const int own = q - Lower;  // slot of the mass, dx = -own
      e.own[q] = row.motion + (slot + own) * motion_slot;
      e.other[q] = row.motion + row.to_motion[R] + slot * motion_slot;
      e.family[q] = &row.constants->family[family_of(R, own)];
      e.mask[q] = row.masks + (slot + own) * masks_per_slot + mask_of(R, -own);
    }
    return e;
  }

  template <int Lower, int Upper, int R>
  FINGERTIP_INLINE void linked(const Row& row, std::ptrdiff_t slot, Force& below, Force& here,
                               Force& above) {
    constexpr int N = 1 + Lower + Upper;
    const Ends<N> e = ends<Lower, Upper, R>(row, slot);
    Batch<N> b;
    find_coefficients(b, e);
    Real* other = row.linked_force[R] + slot * force_slot;
    if constexpr (N == 3) {
      Force* const own[3] = {&below, &here, &above};
      apply(b, e, own, other);
    } else if constexpr (Lower == 1) {
      Force* const own[2] = {&below, &here};
      apply(b, e, own, other);
    } else if constexpr (Upper == 1) {
      Force* const own[2] = {&here, &above};
      apply(b, e, own, other);
    } else {
      Force* const own[1] = {&here};
      apply(b, e, own, other);
    }
  }

  /// The spring along the row from `slot` to the next one.
  FINGERTIP_INLINE void along_row(const Row& row, std::ptrdiff_t slot, Force& here, Force& above) {
    const Real* own = row.motion + slot * motion_slot;
    const Ends<1> e{{own},
                    {own + motion_slot},
                    {&row.constants->family[0]},
                    {row.masks + slot * masks_per_slot}};
    Batch<1> b;
    find_coefficients(b, e);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      const Pack t = b.root[0] * (Pack::load(e.other[0] + c * W) - Pack::load(e.own[0] + c * W));
      here.along[c] = here.along[c] + t;
      above.along[c] = above.along[c] - t;
    }
  }

  /// Springs of the own slot to the linked rows' slots at dx = Dx, which lie beyond the row's end.
  template <int R, int Dx>
  FINGERTIP_INLINE void beyond(const Row& row, std::ptrdiff_t slot, Force& here) {
    if ((row.links >> R & 1u) == 0) return;
    const Real* own = row.motion + slot * motion_slot;
    const Ends<1> e{{own},
                    {own + row.to_motion[R] + Dx * motion_slot},
                    {&row.constants->family[family_of(R, Dx)]},
                    {row.masks + slot * masks_per_slot + mask_of(R, Dx)}};
    Batch<1> b;
    find_coefficients(b, e);
    Real* const other[1] = {row.linked_force[R] + (slot + Dx) * force_slot};
    apply_fan(b, e, here, other);
  }
  template <int Dx>
  FINGERTIP_INLINE void beyond(const Row& row, std::ptrdiff_t slot, Force& here) {
    beyond<0, Dx>(row, slot, here);
    beyond<1, Dx>(row, slot, here);
    beyond<2, Dx>(row, slot, here);
    beyond<3, Dx>(row, slot, here);
  }

  FINGERTIP_INLINE void integrate(const Row& row, std::ptrdiff_t slot, Force force) {
    const SweepConstants<Real>& k = *row.constants;
    Real* motion = row.motion + slot * motion_slot;
    Real* spent = row.force + slot * force_slot;
    Pack x[3], v[3];
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      x[c] = Pack::load(motion + c * W);
      v[c] = Pack::load(motion + (3 + c) * W);
      Pack::all(0).store(spent + c * W);
    }
    Pack depth = Pack::all(k.height);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) depth =
        subtract_product(depth, Pack::all(k.normal[c]), x[c]);
    const auto touches = greater(depth, Pack::all(0));
    if (Pack::any(touches)) {
      Pack push = Pack::all(k.plane_stiffness) * depth;
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) push =
          subtract_product(push, Pack::all(k.plane_damping * k.normal[c]), v[c]);
      push = where(touches, maximum(push, Pack::all(0)));
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) force.along[c] =
          multiply_add(push, Pack::all(k.normal[c]), force.along[c]);
    }
    const auto masses = Pack::mask(row.masks + slot * masks_per_slot + mass_mask);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      const Pack faster =
          multiply_add(force.along[c], Pack::all(k.gain), v[c]) + Pack::all(k.gravity_step[c]);
      const Pack further = multiply_add(faster, Pack::all(k.step), x[c]);
      select(masses, faster, v[c]).store(motion + (3 + c) * W);
      select(masses, further, x[c]).store(motion + c * W);
    }
  }

  FINGERTIP_INLINE Force load_force(const Real* from) {
    return {{Pack::load(from), Pack::load(from + W), Pack::load(from + 2 * W)}};
  }

  /// Everything of one slot between its neighbours below and above; then the slot below has all
  /// its forces and moves on.
  template <int Lower, int Upper>
  FINGERTIP_INLINE void slot(const Row& row, std::ptrdiff_t s, Force& below, Force& here,
                             Force& above) {
    if (row.links & 1u) linked<Lower, Upper, 0>(row, s, below, here, above);
    if (row.links & 2u) linked<Lower, Upper, 1>(row, s, below, here, above);
    if (row.links & 4u) linked<Lower, Upper, 2>(row, s, below, here, above);
    if (row.links & 8u) linked<Lower, Upper, 3>(row, s, below, here, above);
    if constexpr (Upper == 1) along_row(row, s, here, above);
    if constexpr (Lower == 1) integrate(row, s - 1, below);
  }

  /// What the rows before left in the seam slots belongs to the masses at the other end.
  FINGERTIP_INLINE void gather_seams(const Row& row, std::ptrdiff_t slots) {
    Real* first = row.force;
    Real* last = first + (slots - 1) * force_slot;
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      Real* before = first - force_slot + c * W;
      Real* after = last + force_slot + c * W;
      (Pack::load(first + c * W) + previous_lane(Pack::load(after))).store(first + c * W);
      (Pack::load(last + c * W) + next_lane(Pack::load(before))).store(last + c * W);
      Pack::all(0).store(before);
      Pack::all(0).store(after);
    }
  }

  /// The springs along the row from its last slot to the first one, a lane further.
  FINGERTIP_INLINE void close_row(const Row& row, std::ptrdiff_t slots) {
    Force here = load_force(row.force + (slots - 1) * force_slot);
    Force above{{Pack::all(0), Pack::all(0), Pack::all(0)}};
    along_row(row, slots - 1, here, above);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) here.along[c].store(
        row.force + (slots - 1) * force_slot + c * W);
    FINGERTIP_UNROLL for (int c = 0; c < 3;
                          ++c)(Pack::load(row.force + c * W) + previous_lane(above.along[c]))
        .store(row.force + c * W);
  }

  FINGERTIP_INLINE void copy_seams(const Row& row, std::ptrdiff_t slots) {
    Real* first = row.motion;
    Real* last = first + (slots - 1) * motion_slot;
    FINGERTIP_UNROLL for (int c = 0; c < axes_per_slot; ++c) {
      previous_lane(Pack::load(last + c * W)).store(first - motion_slot + c * W);
      next_lane(Pack::load(first + c * W)).store(last + motion_slot + c * W);
    }
  }

  static void sweep_row(const Row& row, std::ptrdiff_t slots) {
    gather_seams(row, slots);
    close_row(row, slots);
    Force below{}, here = load_force(row.force), above{};
    beyond<-1>(row, 0, here);
    if (slots == 1) {
      slot<0, 0>(row, 0, below, here, above);
    } else {
      above = load_force(row.force + force_slot);
      slot<0, 1>(row, 0, below, here, above);
      for (std::ptrdiff_t s = 1; s < slots - 1; ++s) {
        below = here;
        here = above;
        above = load_force(row.force + (s + 1) * force_slot);
        slot<1, 1>(row, s, below, here, above);
      }
      below = here;
      here = above;
      slot<1, 0>(row, slots - 1, below, here, above);
    }
    beyond<1>(row, slots - 1, here);
    integrate(row, slots - 1, here);
    copy_seams(row, slots);
  }

  static void sweep_plane(const LaneGrid<Real>& grid, int plane, Real* forces) {
    const std::ptrdiff_t slots = grid.slots, rows = grid.rows;
    const std::ptrdiff_t motion_row = (slots + 2) * motion_slot, motion_plane = rows * motion_row;
    const std::ptrdiff_t force_row = (slots + 2) * force_slot, force_plane = rows * force_row;
    Real* this_plane = forces + (plane & 1) * force_plane + force_slot;
    Real* next_plane = forces + (~plane & 1) * force_plane + force_slot;
    for (std::ptrdiff_t y = 0; y < rows; ++y) {
      const unsigned links = grid.links[plane * rows + y];
      if (links == 0) continue;
      Row row;
      row.motion = grid.motion + plane * motion_plane + y * motion_row + motion_slot;
      row.force = this_plane + y * force_row;
      row.masks = grid.masks + (plane * rows + y) * slots * masks_per_slot;
      row.links = links;
      row.to_motion[0] = motion_row;
      row.to_motion[1] = motion_plane - motion_row;
      row.to_motion[2] = motion_plane;
      row.to_motion[3] = motion_plane + motion_row;
      row.linked_force[0] = row.force + force_row;
      row.linked_force[1] = next_plane + (y - 1) * force_row;
      row.linked_force[2] = next_plane + y * force_row;
      row.linked_force[3] = next_plane + (y + 1) * force_row;
      row.constants = &grid.constants;
      sweep_row(row, slots);
    }
  }
};

#undef FINGERTIP_INLINE
#undef FINGERTIP_UNROLL

}  // namespace fingertip::lattice::springs
