/// The kernels of the bond, compiled once per instruction set (bond_kernel_widths.cc). Included
/// by that file only.
#pragma once

#include <array>

#include "lattice/kernels/bond_kernel.h"
#include "lattice/kernels/packs.h"

namespace fingertip::lattice::inline kernels::kernel {

template <typename Pack>
struct BondBody : Packs<Pack> {
  using Base = Packs<Pack>;
  using Vector = typename Base::Vector;
  using Base::gather, Base::load, Base::parts, Base::scatter, Base::store, Base::total, Base::width;

  static void find_slips(const BondArrays& a, const Carried& carried, double ahead,
                         std::size_t begin, std::size_t end) {
    for (std::size_t p = begin * lanes; p < end * lanes; p += width) {
      const Vector u = gather(a.displacement, a.point + p), v = gather(a.velocity, a.point + p);
      const Vector rest = load(a.rest, p);
      const std::array<Pack, 3> moved{u.x + ahead * v.x, u.y + ahead * v.y, u.z + ahead * v.z};
      for (std::size_t c = 0; c < 3; ++c) {
        const double* row = carried.turn + 3 * c;
        const Pack there = row[0] * rest.x + row[1] * rest.y + row[2] * rest.z + carried.shift[c];
        store(a.slip[c] + p, moved[c] - there);
      }
    }
  }

  /// K times each of some slips, of a part of a slice; K is read once. Even and odd columns are
  /// summed apart, two chains that do not wait for each other; columns come in pairs.
  template <typename... Slips>
  [[gnu::always_inline]] static auto products(const BondArrays& a, std::size_t slice,
                                              std::size_t part, const Slips&... slips) {
    constexpr std::size_t count = sizeof...(Slips);
    const double* const* const all[] = {slips...};
    std::array<Vector, count> even, odd;
    for (std::size_t n = 0; n < count; ++n) even[n] = odd[n] = {0.0, 0.0, 0.0};
    for (std::size_t e = a.first[slice]; e < a.first[slice + 1]; e += 2) {
      const Pack here = load(a.value[e].at + part * width),
                 next = load(a.value[e + 1].at + part * width);
      for (std::size_t n = 0; n < count; ++n) {
        even[n] += here * at(all[n], a.column[e]);
        odd[n] += next * at(all[n], a.column[e + 1]);
      }
    }
    for (std::size_t n = 0; n < count; ++n) even[n] = even[n] + odd[n];
    return even;
  }
  static Vector at(const double* const* slip, std::uint32_t particle) {
    return {slip[0][particle], slip[1][particle], slip[2][particle]};
  }

  static double energy(const BondArrays& a, std::size_t begin, std::size_t end) {
    std::array<Pack, parts> twice{};
    for (std::size_t slice = begin; slice < end; ++slice) {
      for (std::size_t part = 0; part < parts; ++part)
        twice[part] +=
            dot(load(a.slip, slice * lanes + part * width), products(a, slice, part, a.slip)[0]);
    }
    return 0.5 * Base::total(twice);
  }

  template <bool Stores>
  static Pulled take(const BondArrays& a, double square, std::size_t begin, std::size_t end) {
    std::array<Pack, parts> twice{};
    // Summed lane by lane first, so that the sum does not depend on the register width.
    std::array<Vector, parts> force, moment;
    for (std::size_t part = 0; part < parts; ++part) {
      force[part] = moment[part] = {0.0, 0.0, 0.0};
    }
    for (std::size_t slice = begin; slice < end; ++slice) {
      for (std::size_t part = 0; part < parts; ++part) {
        const std::size_t p = slice * lanes + part * width;
        const Pack mass = load(a.mass + p);
        const Pack share = mass / (mass + square * load(a.sum + p));
        const Vector others = gather(a.force, a.point + p);
        Vector product;
        if constexpr (Stores) {
          const auto both = products(a, slice, part, a.slip, a.still);
          product = both[0];
          twice[part] += dot(load(a.still, p), both[1]);
        } else {
          product = products(a, slice, part, a.slip)[0];
        }
        const Vector taken = share * (others - product);
        const Vector pull = others - taken;
        scatter(a.force, a.point + p, taken);
        force[part] += pull;
        moment[part] += cross(load(a.rest, p) + gather(a.displacement, a.point + p), pull);
      }
    }
    Pulled result;
    total(force, result.force);
    total(moment, result.moment);
    result.energy = Stores ? 0.5 * Base::total(twice) : 0.0;
    return result;
  }

  static constexpr BondKernels kernels{find_slips, energy, take<false>, take<true>};
};

}  // namespace fingertip::lattice::inline kernels::kernel
