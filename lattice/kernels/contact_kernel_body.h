/// The kernels of the contact, compiled once per instruction set (contact_kernel_widths.cc).
/// Included by that file only.
#pragma once

#include <array>

#include "lattice/kernels/contact_kernel.h"
#include "lattice/kernels/pack_algebra.h"
#include "lattice/kernels/packs.h"

namespace fingertip::lattice::inline kernels::kernel {

/// What takes or returns packs is inlined by force, for calls would hand them on through memory:
/// worth a quarter of the time.
template <typename Pack>
struct ContactBody : Packs<Pack> {
  using Base = Packs<Pack>;
  using Vector = typename Base::Vector;
  using Mask = typename Pack::mask_type;
  using Base::gather, Base::load, Base::parts, Base::store, Base::width;

  /// Trilinear in a point's place in its cell: the term `n` takes the factors whose bits n has [m].
  struct Trilinear {
    double term[3][lanes];
  };
  /// What eight ties do, as in ContactLoad.
  struct Pulls {
    double force[3][lanes];
    double stiffness[6][lanes];
  };

  [[gnu::always_inline]] static Vector load(const Lanes* field, std::size_t lane) {
    return {Base::load(field[0].at + lane), Base::load(field[1].at + lane),
            Base::load(field[2].at + lane)};
  }
  [[gnu::always_inline]] static void store(Lanes* field, std::size_t lane, const Vector& value) {
    Base::store(field[0].at + lane, value.x);
    Base::store(field[1].at + lane, value.y);
    Base::store(field[2].at + lane, value.z);
  }
  [[gnu::always_inline]] static Pack load(const Lanes& field, std::size_t lane) {
    return Base::load(field.at + lane);
  }
  [[gnu::always_inline]] static void store(Lanes& field, std::size_t lane, const Pack& value) {
    Base::store(field.at + lane, value);
  }
  static Vector broadcast(const double* v) { return {v[0], v[1], v[2]}; }
  [[gnu::always_inline]] static Pack choose(const Mask& mask, const Pack& yes, const Pack& no) {
    return meshes::choose(mask, yes, no);
  }
  [[gnu::always_inline]] static Vector choose(const Mask& mask, const Vector& yes,
                                              const Vector& no) {
    return {choose(mask, yes.x, no.x), choose(mask, yes.y, no.y), choose(mask, yes.z, no.z)};
  }

  static double closing(const double* const* velocity, const double* normal,
                        const std::uint32_t* particles, std::size_t count) {
    Pack fastest = 0.0;
    std::size_t i = 0;
    for (; i + width <= count; i += width) {
      const Vector v = gather(velocity, particles + i);
      fastest = std::experimental::max(fastest, -dot(broadcast(normal), v));
    }
    double result = std::experimental::hmax(fastest);
    for (; i < count; ++i) {
      const std::uint32_t p = particles[i];
      const double speed =
          -(normal[0] * velocity[0][p] + normal[1] * velocity[1][p] + normal[2] * velocity[2][p]);
      result = speed > result ? speed : result;
    }
    return result;
  }

  /// The displacement inside the cell of a group.
  [[gnu::always_inline]] static Trilinear displacement(const ContactArrays& a,
                                                       const ContactGroup& group, double ahead) {
    Trilinear result;
    for (std::size_t lane = 0; lane < lanes; lane += width) {
      const Vector u = gather(a.displacement, group.corner + lane);
      const Vector v = gather(a.velocity, group.corner + lane);
      const Vector moved = u + Pack(ahead) * v;
      Base::store(result.term[0] + lane, moved.x);
      Base::store(result.term[1] + lane, moved.y);
      Base::store(result.term[2] + lane, moved.z);
    }
    for (auto& term : result.term) {  // from values at the corners
      for (std::size_t bit = 1; bit < lanes; bit *= 2) {
        for (std::size_t n = 0; n < lanes; ++n) {
          if ((n & bit) != 0) term[n] -= term[n - bit];
        }
      }
    }
    return result;
  }
  [[gnu::always_inline]] static Pack at(const double* term, const Vector& local) {
    const Pack low = (term[0] + term[1] * local.x) + (term[2] + term[3] * local.x) * local.y;
    const Pack high = (term[4] + term[5] * local.x) + (term[6] + term[7] * local.x) * local.y;
    return low + high * local.z;
  }

  /// Relative to the plane, of points from `lane` on.
  [[gnu::always_inline]] static Vector places(const ContactGroup& group, const Trilinear& u,
                                              const PlaneFrame& frame, std::size_t lane) {
    const Vector local = load(group.local, lane);
    return in_frame(frame,
                    load(group.rest, lane) +
                        Vector{at(u.term[0], local), at(u.term[1], local), at(u.term[2], local)});
  }
  [[gnu::always_inline]] static Vector in_frame(const PlaneFrame& frame, const Vector& x) {
    const double* t = frame.turn;
    return broadcast(frame.shift) + Vector{t[0] * x.x + t[1] * x.y + t[2] * x.z,
                                           t[3] * x.x + t[4] * x.y + t[5] * x.z,
                                           t[6] * x.x + t[7] * x.y + t[8] * x.z};
  }

  /// A vector of the frame's, along the grid's axes.
  [[gnu::always_inline]] static Vector along_grid(const PlaneFrame& frame, const Vector& v) {
    const double* t = frame.turn;
    return {t[0] * v.x + t[3] * v.y + t[6] * v.z, t[1] * v.x + t[4] * v.y + t[7] * v.z,
            t[2] * v.x + t[5] * v.y + t[8] * v.z};
  }

  [[gnu::always_inline]] static bool has_feet(const ContactArrays& a) {
    return !a.obstacle.flat && !a.exact;
  }
  /// Along t1 or t2 of the obstacle.
  [[gnu::always_inline]] static Pack along(const ContactArrays& a, std::size_t axis,
                                           const Vector& v) {
    return dot(broadcast(a.tangent[axis]), v);
  }
  static void stand(const ContactArrays& a, std::size_t number) {
    for (std::size_t lane = 0; lane < lanes; lane += width) {
      const Vector rest = in_frame(a.carried, load(a.groups[number].rest, lane));
      for (std::size_t axis = 0; axis < 2; ++axis) {
        store(a.memory[number].rest[axis], lane, along(a, axis, rest));
        store(a.memory[number].foot[axis], lane, along(a, axis, rest));
      }
    }
  }
  /// Moves feet on to where they are when the points have come to `place`, before that is noted.
  [[gnu::always_inline]] static void move_feet(const ContactArrays& a, const ContactGroup& group,
                                               const Vector& place, std::size_t lane,
                                               ContactMemory& memory) {
    if (!has_feet(a)) return;
    const Vector rest = in_frame(a.carried, load(group.rest, lane)),
                 own = place - load(memory.place, lane);
    const Pack x = along(a, 0, rest), y = along(a, 1, rest);
    const Pack rx = x - load(memory.rest[0], lane), ry = y - load(memory.rest[1], lane);
    const Pack share =
        a.follows ? meshes::share_passed(along(a, 0, own), along(a, 1, own), rx, ry) : Pack(1.0);
    store(memory.rest[0], lane, x);
    store(memory.rest[1], lane, y);
    store(memory.foot[0], lane, load(memory.foot[0], lane) + share * rx);
    store(memory.foot[1], lane, load(memory.foot[1], lane) + share * ry);
  }

  /// The gap of points at `place`, and its gradient.
  struct GapAndNormal {
    Pack gap;
    Vector normal;
  };
  [[gnu::always_inline]] static GapAndNormal gap_and_normal(const ContactArrays& a,
                                                            const ContactMemory& memory,
                                                            const Vector& place, std::size_t lane) {
    const Vector n = broadcast(a.normal);
    const Pack over = dot(n, place);
    if (a.obstacle.flat) return {over, n};
    if (has_feet(a))
      return {over - meshes::obstacle_height(a.obstacle, load(memory.foot[0], lane),
                                             load(memory.foot[1], lane)),
              n};
    const Vector t1 = broadcast(a.tangent[0]), t2 = broadcast(a.tangent[1]);
    const auto hit = meshes::obstacle_hit(a.obstacle, dot(t1, place), dot(t2, place), over);
    return {hit.gap, hit.normal[0] * t1 + hit.normal[1] * t2 + hit.normal[2] * n};
  }

  static double look(const ContactArrays& a, double margin, std::size_t number) {
    const ContactGroup& group = a.groups[number];
    const Trilinear then = displacement(a, group, a.ahead);
    std::array<Vector, parts> place;
    std::array<Pack, parts> gap;
    double least = 1e300;
    for (std::size_t part = 0; part < parts; ++part) {
      place[part] = places(group, then, a.then, part * width);
      move_feet(a, group, place[part], part * width, a.memory[number]);
      gap[part] = gap_and_normal(a, a.memory[number], place[part], part * width).gap;
      const double smallest = std::experimental::hmin(gap[part]);
      least = smallest < least ? smallest : least;
    }
    if (least < margin) return least;
    for (std::size_t part = 0; part < parts; ++part) {
      store(a.memory[number].place, part * width, place[part]);
      store(a.memory[number].gap, part * width, gap[part]);
    }
    return least;
  }

  static void add_up(const ContactGroup& group, const ContactMemory& memory, const PatchView& view,
                     PatchSums& sums) {
    std::array<std::array<Vector, parts>, 5> powers;
    std::array<Pack, parts> area, touched;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t lane = part * width;
      const Vector at = load(view.at_rest ? group.rest : memory.place, lane);
      const Pack x = dot(broadcast(view.tangent[0]), at), y = dot(broadcast(view.tangent[1]), at),
                 push = load(memory.push, lane);
      const Pack xx = push * x * x, xy = push * x * y, yy = push * y * y;
      powers[0][part] = {push, push * x, push * y};
      powers[1][part] = {xx, xy, yy};
      powers[2][part] = {xx * x, xx * y, xy * y};
      powers[3][part] = {yy * y, xx * x * x, xx * x * y};
      powers[4][part] = {xx * y * y, xy * y * y, yy * y * y};
      const Pack own =
          std::experimental::abs(dot(broadcast(view.normal), load(group.facing, lane)));
      area[part] = push * own;
      touched[part] = choose(push > Pack(0.0), own, Pack(0.0));
    }
    for (std::size_t k = 0; k < powers.size(); ++k) {
      double three[3];
      Base::total(powers[k], three);
      for (std::size_t i = 0; i < 3; ++i) sums.power[3 * k + i] += three[i];
    }
    sums.area += Base::total(area);
    sums.touched += Base::total(touched);
  }

  /// The part of a tie in the plane, not longer than `longest`; its share of what it was.
  struct Clipped {
    Vector tangential;
    Pack share;
  };
  [[gnu::always_inline]] static Clipped clip(const Vector& stretch, const Vector& normal,
                                             const Pack& longest) {
    const Vector tangential = stretch - dot(stretch, normal) * normal;
    const Pack length = std::experimental::sqrt(dot(tangential, tangential));
    const Pack share = choose(length > longest, longest / length, Pack(1.0));
    return {share * tangential, share};
  }

  /// Brings anchors to where slip has left them by the start of the step.
  static void return_mapping(const ContactArrays& a, const Vector& place, const GapAndNormal& now,
                             std::size_t lane, ContactMemory& memory) {
    const Vector anchor = load(memory.anchor, lane);
    const Pack depth = -now.gap;
    const Vector stretch = anchor - place;
    const Clipped kept = clip(stretch, now.normal, a.friction * TiePush<Pack>(a.law, depth).length);
    // Points not yet there are anchored where they will be.
    const Mask anchored = load(memory.anchored, lane) != 0.0;
    const Mask slips = anchored && depth > 0.0 && kept.share < 1.0;
    const Vector dragged = place + depth * now.normal + kept.tangential;
    store(memory.anchor, lane, choose(slips, dragged, anchor));
    store(memory.sliding, lane, choose(slips, Pack(1.0), Pack(0.0)));
  }

  /// Anchors what crossed the plane in this step, linearly interpolated, and lets go what left it.
  [[gnu::always_inline]] static void look_at(const ContactArrays& a, const Vector& place,
                                             const Pack& gap, std::size_t lane,
                                             ContactMemory& memory) {
    const Pack before = std::experimental::max(load(memory.gap, lane), Pack(0.0));
    const Mask was = load(memory.anchored, lane) != 0.0;
    const Mask crosses = !was && gap < 0.0, leaves = was && gap > 0.0;
    const Pack fraction = choose(crosses, before / (before - gap), Pack(0.0));
    Vector crossing = (1.0 - fraction) * load(memory.place, lane) + fraction * place;
    if (a.exact) {  // not quite on a surface that is curved
      const GapAndNormal left = gap_and_normal(a, memory, crossing, lane);
      crossing += -left.gap * left.normal;
    }
    store(memory.anchor, lane, choose(crosses, crossing, load(memory.anchor, lane)));
    Pack anchored = load(memory.anchored, lane), sliding = load(memory.sliding, lane);
    where(crosses, anchored) = 1.0;
    where(leaves, anchored) = 0.0;
    where(leaves, sliding) = 0.0;
    store(memory.anchored, lane, anchored);
    store(memory.sliding, lane, sliding);
  }

  /// How far ties are stretched, their push by their law, its direction, how much more it is than
  /// that of a linear tie [m], and what share of the stiffness at rest acts in the plane.
  struct Stretch {
    Vector elastic, normal;
    TiePush<Pack> push;
    Pack more, share;
  };
  template <Grip grip>
  [[gnu::always_inline]] static Stretch stretches(const ContactArrays& a, const Vector& place,
                                                  const GapAndNormal& then,
                                                  const ContactMemory& memory, std::size_t lane) {
    const Pack depth = std::experimental::max(-then.gap, Pack(0.0));
    const TiePush<Pack> push(a.law, depth);
    Stretch result{depth * then.normal, then.normal, push, push.length - depth, 0.0};
    if constexpr (grip == Grip::frictionless) return result;
    const Mask anchored = load(memory.anchored, lane) != 0.0;
    const Vector nothing{0.0, 0.0, 0.0};
    result.elastic = load(memory.anchor, lane) - place;
    result.share = 1.0;
    // An anchor says where a point is held across; how deep it is its foot says.
    if (has_feet(a))
      result.elastic = result.elastic - (dot(result.elastic, then.normal) + then.gap) * then.normal;
    if constexpr (grip == Grip::coulomb) {
      const Clipped kept = clip(result.elastic, then.normal, a.friction * push.length);
      result.share = kept.share;
      result.elastic =
          choose(kept.share < 1.0, depth * then.normal + kept.tangential, result.elastic);
    }
    result.elastic = choose(anchored, result.elastic, nothing);
    return result;
  }

  [[gnu::always_inline]] static void note(const ContactArrays& a, const ContactGroup& group,
                                          const Stretch& tie, std::size_t lane,
                                          ContactMemory& memory, Pulls& pulls,
                                          GroupFindings& found) {
    const Pack stiffness = load(group.stiffness, lane);
    const Vector force = stiffness * (tie.elastic + tie.more * tie.normal);
    const Vector on_grid = along_grid(a.then, force), n = along_grid(a.then, tie.normal);
    Base::store(pulls.force[0] + lane, on_grid.x);
    Base::store(pulls.force[1] + lane, on_grid.y);
    Base::store(pulls.force[2] + lane, on_grid.z);
    const Mask acts = force.x != 0.0 || force.y != 0.0 || force.z != 0.0;
    const Pack inertia = choose(acts, load(group.inertia, lane), Pack(0.0));
    // Across the normal a share of it, along it what its law has.
    const Pack across = tie.share * inertia, more = (tie.push.tangent - tie.share) * inertia;
    Base::store(pulls.stiffness[0] + lane, across + more * n.x * n.x);
    Base::store(pulls.stiffness[1] + lane, across + more * n.y * n.y);
    Base::store(pulls.stiffness[2] + lane, across + more * n.z * n.z);
    Base::store(pulls.stiffness[3] + lane, more * n.x * n.y);
    Base::store(pulls.stiffness[4] + lane, more * n.x * n.z);
    Base::store(pulls.stiffness[5] + lane, more * n.y * n.z);
    store(memory.push, lane, dot(force, broadcast(a.normal)));
    store(memory.force, lane, force);
    found.touching += popcount(acts);
    found.sliding += popcount(acts && load(memory.sliding, lane) != 0.0);
    double energy[width];
    const Pack depth = tie.push.length - tie.more;
    Base::store(energy, 0.5 * dot(stiffness * tie.elastic, tie.elastic) +
                            stiffness * (tie.push.energy - 0.5 * depth * depth));
    for (const double e : energy) found.energy += e;
  }

  template <Grip grip>
  static GroupFindings apply_law(const ContactArrays& a, std::size_t number) {
    const ContactGroup& group = a.groups[number];
    ContactMemory& memory = a.memory[number];
    const Trilinear then = displacement(a, group, a.ahead);
    Trilinear now{};
    if constexpr (grip == Grip::coulomb) now = displacement(a, group, 0.0);
    Pulls pulls;
    GroupFindings found{.smallest_gap = 1e300};
    for (std::size_t lane = 0; lane < lanes; lane += width) {
      if constexpr (grip == Grip::coulomb) {
        const Vector place = places(group, now, a.now, lane);
        return_mapping(a, place, gap_and_normal(a, memory, place, lane), lane, memory);
      }
      const Vector place = places(group, then, a.then, lane);
      move_feet(a, group, place, lane, memory);
      const GapAndNormal ahead = gap_and_normal(a, memory, place, lane);
      if constexpr (grip != Grip::frictionless) look_at(a, place, ahead.gap, lane, memory);
      store(memory.place, lane, place);
      store(memory.gap, lane, ahead.gap);
      note(a, group, stretches<grip>(a, place, ahead, memory, lane), lane, memory, pulls, found);
      const double least = std::experimental::hmin(ahead.gap);
      found.smallest_gap = least < found.smallest_gap ? least : found.smallest_gap;
      found.anchored = found.anchored || any_of(load(memory.anchored, lane) != 0.0);
    }
    if (found.touching > 0) load_corners(group, pulls, a.loads[number]);
    return found;
  }

  static void load_corners(const ContactGroup& group, const Pulls& pulls, GroupLoads& loads) {
    for (std::size_t corner = 0; corner < lanes; corner += width) {
      Vector slope, low;  // of the weights' factors, by a point's place in the cell
      for_components([&](auto d) __attribute__((always_inline)) {
        entry<d()>(slope) =
            Pack([&](auto lane) { return (corner + lane) >> d() & 1 ? 1.0 : -1.0; });
        entry<d()>(low) = 0.5 - 0.5 * entry<d()>(slope);
      });
      Vector force{0.0, 0.0, 0.0};
      Pack stiffness[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
      for (std::size_t p = 0; p < lanes; ++p) {
        const Pack share = (low.x + slope.x * group.local[0].at[p]) *
                           (low.y + slope.y * group.local[1].at[p]) *
                           (low.z + slope.z * group.local[2].at[p]);
        const Pack size = std::experimental::abs(share);
        force += share * Vector{pulls.force[0][p], pulls.force[1][p], pulls.force[2][p]};
        for (std::size_t n = 0; n < 6; ++n) stiffness[n] += pulls.stiffness[n][p] * size;
      }
      for (std::size_t lane = 0; lane < width; ++lane) {
        ContactLoad& load = loads.corner[corner + lane];
        load.force[0] = force.x[lane];
        load.force[1] = force.y[lane];
        load.force[2] = force.z[lane];
        for (std::size_t n = 0; n < 6; ++n) load.stiffness[n] = stiffness[n][lane];
      }
    }
  }

  static GroupFindings apply(const ContactArrays& a, Grip grip, std::size_t group) {
    switch (grip) {
      case Grip::frictionless: return apply_law<Grip::frictionless>(a, group);
      case Grip::stick: return apply_law<Grip::stick>(a, group);
      default: return apply_law<Grip::coulomb>(a, group);
    }
  }

  static constexpr ContactKernels kernels{closing, stand, look, apply, add_up};
};

}  // namespace fingertip::lattice::inline kernels::kernel
