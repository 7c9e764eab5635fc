/// The sweep itself, compiled once per instruction set (sweep_widths.cc). Included by that
/// file only. `Pack` is one of their registers; its type keeps the instantiations apart.
///
/// README.md explains layout and order. In short: a slot's masses and the forces on them stay in
/// registers while it meets its 13 neighbouring slots, whose forces are read, added to and written
/// back; then it moves on in time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tests/benchmarks/springs/engine/sweep.h"

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

  /// Three components of a slot's masses.
  struct Vector {
    Pack along[3];
  };
  struct Own {
    Vector position, velocity, force;
  };

  /// N springs of one slot to other ones: where these are, what belongs to the springs.
  template <int N>
  struct Ends {
    const Real* motion[N];
    Real* force[N];
    const Class* family[N];
    const Mask* mask[N];
  };

  /// N springs on their way to coefficients. The chain of operations is long and each waits for
  /// the one before, so springs take turns; `keep` holds that order against the compiler's own.
  template <int N>
  struct Batch {
    Pack square[N];  ///< |d|², then the error of the root's estimate
    Pack rate[N];    ///< w·d
    Pack root[N];    ///< y = s/|d|, at last the coefficient: force = root d
    Pack series[N];
  };

  template <int C, int N>
  FINGERTIP_INLINE void measure(Batch<N>& b, const Own& own, const Ends<N>& e) {
    FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
      const Pack d = own.position.along[C] - Pack::load(e.motion[q] + C * W);
      b.square[q] = C == 0 ? d * d : multiply_add(d, d, b.square[q]);
      keep(b.square[q]);
      if constexpr (Damped) {
        const Pack w = own.velocity.along[C] - Pack::load(e.motion[q] + (3 + C) * W);
        b.rate[q] = C == 0 ? d * w : multiply_add(d, w, b.rate[q]);
        keep(b.rate[q]);
      }
    }
  }

  /// One of the operations that lead from |d|² and w·d to the coefficient.
  template <int Step>
  FINGERTIP_INLINE void refine_one(Pack& square, Pack& rate, Pack& root, Pack& series,
                                   const Class& c, const Mask* mask) {
    if constexpr (Pack::estimates_roots) {
      constexpr bool cubic = Pack::root_terms == 4;
      if constexpr (Step == 0) root = root_estimate(square);
      if constexpr (Step == 1) square = square * root;
      if constexpr (Step == 2) square = subtract_product(Pack::all(c.one), square, root);
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

  template <int N>
  FINGERTIP_INLINE void measure_all(Batch<N>& b, const Own& own, const Ends<N>& e) {
    measure<0>(b, own, e);
    measure<1>(b, own, e);
    measure<2>(b, own, e);
    refine<0>(b, e);
  }
  template <int N>
  FINGERTIP_INLINE void refine_all(Batch<N>& b, const Ends<N>& e) {
    refine<1>(b, e);
    refine<2>(b, e);
    refine<3>(b, e);
    refine<4>(b, e);
    refine<5>(b, e);
    refine<6>(b, e);
    refine<7>(b, e);
    refine<8>(b, e);
  }

  /// The coefficients of one batch while the lengths of the next are measured.
  template <int N, int M>
  FINGERTIP_INLINE void overlap(Batch<N>& b, const Ends<N>& e, Batch<M>& next, const Own& own,
                                const Ends<M>& f) {
    refine<1>(b, e);
    measure<0>(next, own, f);
    refine<2>(b, e);
    refine<3>(b, e);
    measure<1>(next, own, f);
    refine<4>(b, e);
    refine<5>(b, e);
    measure<2>(next, own, f);
    refine<6>(b, e);
    refine<7>(b, e);
    refine<0>(next, f);
    refine<8>(b, e);
  }

  /// Adds the springs' forces to the slot's, in registers, and to the others', in memory.
  template <int N>
  FINGERTIP_INLINE void apply(const Batch<N>& b, Own& own, const Ends<N>& e) {
    FINGERTIP_UNROLL for (int q = 0; q < N; ++q) {
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
        const Pack t = b.root[q] * (own.position.along[c] - Pack::load(e.motion[q] + c * W));
        own.force.along[c] = own.force.along[c] - t;
        keep(own.force.along[c]);
        (t + Pack::load(e.force[q] + c * W)).store(e.force[q] + c * W);
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
    std::ptrdiff_t to_force[linked_rows];
    const SweepConstants<Real>* constants;
  };

  /// Hides from the compiler where a pointer comes from, so that addresses are formed as this
  /// pointer plus a number instead of kept in a register each.
  template <typename T>
  FINGERTIP_INLINE T* base(T* pointer) {
    asm volatile("" : "+r"(pointer));
    return pointer;
  }

  /// Springs to the three slots of linked row R; with `Along` also the one to the next slot of the
  /// own row.
  template <int R, bool Along>
  FINGERTIP_INLINE Ends<Along ? 4 : 3> ends(const Row& row, std::ptrdiff_t slot, const Mask* masks,
                                            const SweepConstants<Real>* constants) {
    Ends<Along ? 4 : 3> e;
    const Real* motion = base(row.motion + row.to_motion[R] + slot * motion_slot);
    Real* force = base(row.force + row.to_force[R] + slot * force_slot);
    FINGERTIP_UNROLL for (int q = 0; q < 3; ++q) {
      e.motion[q] = motion + (q - 1) * motion_slot;
      e.force[q] = force + (q - 1) * force_slot;
      e.family[q] = &constants->family[(R & 1) + (q != 1 ? 1 : 0)];
      e.mask[q] = masks + 1 + 3 * R + q;
    }
    if constexpr (Along) {
      e.motion[3] = row.motion + (slot + 1) * motion_slot;
      e.force[3] = row.force + (slot + 1) * force_slot;
      e.family[3] = &constants->family[0];
      e.mask[3] = masks;
    }
    return e;
  }
  FINGERTIP_INLINE Ends<1> along_row(const Row& row, std::ptrdiff_t slot) {
    return {{row.motion + (slot + 1) * motion_slot},
            {row.force + (slot + 1) * force_slot},
            {&row.constants->family[0]},
            {row.masks + slot * masks_per_slot}};
  }

  template <int N>
  FINGERTIP_INLINE void one_batch(Own& own, const Ends<N>& e) {
    Batch<N> b;
    measure_all(b, own, e);
    refine_all(b, e);
    apply(b, own, e);
  }

  template <bool Along>
  FINGERTIP_INLINE void all_springs(const Row& row, std::ptrdiff_t slot, Own& own) {
    const Mask* masks = base(row.masks + slot * masks_per_slot);
    const SweepConstants<Real>* constants = base(row.constants);
    const auto e0 = ends<0, false>(row, slot, masks, constants);
    const auto e1 = ends<1, false>(row, slot, masks, constants);
    const auto e2 = ends<2, false>(row, slot, masks, constants);
    const auto e3 = ends<3, Along>(row, slot, masks, constants);
    Batch<3> b0, b1, b2;
    Batch<Along ? 4 : 3> b3;
    measure_all(b0, own, e0);
    overlap(b0, e0, b1, own, e1);
    apply(b0, own, e0);
    overlap(b1, e1, b2, own, e2);
    apply(b1, own, e1);
    overlap(b2, e2, b3, own, e3);
    apply(b2, own, e2);
    refine_all(b3, e3);
    apply(b3, own, e3);
  }
  template <bool Along>
  FINGERTIP_INLINE void some_springs(const Row& row, std::ptrdiff_t slot, Own& own) {
    const Mask* masks = base(row.masks + slot * masks_per_slot);
    const SweepConstants<Real>* constants = base(row.constants);
    if (row.links & 1u) one_batch(own, ends<0, false>(row, slot, masks, constants));
    if (row.links & 2u) one_batch(own, ends<1, false>(row, slot, masks, constants));
    if (row.links & 4u) one_batch(own, ends<2, false>(row, slot, masks, constants));
    if (row.links & 8u) one_batch(own, ends<3, false>(row, slot, masks, constants));
    if constexpr (Along) one_batch(own, along_row(row, slot));
  }

  FINGERTIP_INLINE Vector load(const Real* from) {
    return {{Pack::load(from), Pack::load(from + W), Pack::load(from + 2 * W)}};
  }
  FINGERTIP_INLINE void integrate(const Row& row, std::ptrdiff_t slot, Own own) {
    const SweepConstants<Real>& k = *row.constants;
    Real* motion = row.motion + slot * motion_slot;
    Real* spent = row.force + slot * force_slot;
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) Pack::all(0).store(spent + c * W);
    const Pack* x = own.position.along;
    const Pack* v = own.velocity.along;
    Pack depth = Pack::all(k.height);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) depth =
        subtract_product(depth, Pack::all(k.normal[c]), x[c]);
    const auto touches = greater(depth, Pack::all(0));
    if (Pack::any(touches)) {
      Pack push = Pack::all(k.plane_stiffness) * depth;
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) push =
          subtract_product(push, Pack::all(k.plane_damping * k.normal[c]), v[c]);
      push = where(touches, maximum(push, Pack::all(0)));
      FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) own.force.along[c] =
          multiply_add(push, Pack::all(k.normal[c]), own.force.along[c]);
    }
    const auto masses = Pack::mask(row.masks + slot * masks_per_slot + mass_mask);
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) {
      const Pack faster =
          multiply_add(own.force.along[c], Pack::all(k.gain), v[c]) + Pack::all(k.gravity_step[c]);
      const Pack further = multiply_add(faster, Pack::all(k.step), x[c]);
      select(masses, faster, v[c]).store(motion + (3 + c) * W);
      select(masses, further, x[c]).store(motion + c * W);
    }
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

  /// The springs along the row from its last slot to the first one, a lane further: to the seam
  /// slot after the last, whose masses they are.
  FINGERTIP_INLINE void close_row(const Row& row, std::ptrdiff_t slots) {
    Own last;
    last.position = load(row.motion + (slots - 1) * motion_slot);
    last.velocity = load(row.motion + (slots - 1) * motion_slot + 3 * W);
    last.force = load(row.force + (slots - 1) * force_slot);
    one_batch(last, along_row(row, slots - 1));
    FINGERTIP_UNROLL for (int c = 0; c < 3; ++c) last.force.along[c].store(
        row.force + (slots - 1) * force_slot + c * W);
  }

  FINGERTIP_INLINE void copy_seams(const Row& row, std::ptrdiff_t slots) {
    Real* first = row.motion;
    Real* last = first + (slots - 1) * motion_slot;
    FINGERTIP_UNROLL for (int c = 0; c < axes_per_slot; ++c) {
      previous_lane(Pack::load(last + c * W)).store(first - motion_slot + c * W);
      next_lane(Pack::load(first + c * W)).store(last + motion_slot + c * W);
    }
  }

  /// Calls into the cache what the next row but one will touch of the next plane: rows are too
  /// short, and too many are read at once, for the processor to foresee it.
  FINGERTIP_INLINE void fetch_ahead(const Row& row, std::ptrdiff_t slot) {
    const Real* motion = row.motion + 2 * row.to_motion[0] + row.to_motion[2] + slot * motion_slot;
    const Real* force = row.force + 2 * row.to_force[0] + row.to_force[2] + slot * force_slot;
    constexpr std::ptrdiff_t line = 64 / std::ptrdiff_t(sizeof(Real));
    FINGERTIP_UNROLL for (std::ptrdiff_t i = 0; i < motion_slot; i += line)
        __builtin_prefetch(motion + i, 1);
    FINGERTIP_UNROLL for (std::ptrdiff_t i = 0; i < force_slot; i += line)
        __builtin_prefetch(force + i, 1);
  }

  /// All springs of one slot, then its step in time.
  template <bool Along>
  FINGERTIP_INLINE void sweep_slot(const Row& row, std::ptrdiff_t slot) {
    fetch_ahead(row, slot);
    const Real* motion = row.motion + slot * motion_slot;
    Own own{load(motion), load(motion + 3 * W), load(row.force + slot * force_slot)};
    if ((row.links & all_rows_linked) == all_rows_linked)
      all_springs<Along>(row, slot, own);
    else
      some_springs<Along>(row, slot, own);
    integrate(row, slot, own);
  }

  static void sweep_row(const Row& row, std::ptrdiff_t slots) {
    close_row(row, slots);
    gather_seams(row, slots);
    for (std::ptrdiff_t slot = 0; slot < slots - 1; ++slot) sweep_slot<true>(row, slot);
    sweep_slot<false>(row, slots - 1);
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
      row.to_force[0] = force_row;
      row.to_force[1] = next_plane - this_plane - force_row;
      row.to_force[2] = next_plane - this_plane;
      row.to_force[3] = next_plane - this_plane + force_row;
      row.constants = &grid.constants;
      sweep_row(row, slots);
    }
  }
};

#undef FINGERTIP_INLINE
#undef FINGERTIP_UNROLL

}  // namespace fingertip::lattice::springs
