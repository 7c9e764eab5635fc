/// Interface of the vectorised sweep: raw arrays only, so that the same source can be compiled for
/// several instruction sets (no inline function of a library is shared with them).
///
/// A row of n masses lies in `slots` = ceil(n / lanes) registers, lane l holding the masses
/// l slots ... (l + 1) slots - 1 in its slots 0, 1, ... (README.md has a drawing). Before slot 0
/// and after the last one come two seam slots, copies of the last and the first one shifted by a
/// lane.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace fingertip::lattice::springs {

/// One bit per lane.
template <typename Real>
using LaneMask = std::conditional_t<std::is_same_v<Real, float>, std::uint16_t, std::uint8_t>;

inline constexpr int axes_per_slot = 6;    ///< position and velocity
inline constexpr int masks_per_slot = 16;  ///< 13 directions (`half_stencil`), `mass_mask`, unused
inline constexpr int mass_mask = 13;

/// Rows that half a stencil leads to from (y, z): (y+1, z), (y-1, z+1), (y, z+1), (y+1, z+1).
/// Their three directions are half_stencil[1 + 3 r], ..., from dx = -1 to 1.
inline constexpr int linked_rows = 4;
inline constexpr unsigned all_rows_linked = 0xf;
inline constexpr unsigned row_has_masses = 0x10;

/// Constants of one class of springs. With s = sqrt(mu) (undamped: 1) the kernel forms
/// y = s/|d| and the force k + y (y w·d - k l0/s) times d.
template <typename Real>
struct ClassConstants {
  Real stiffness;  ///< k
  Real pull;       ///< k l0/s (undamped: k l0)
  Real one;        ///< 1: read when needed, as it must not occupy a register
  Real series[4];  ///< s times 1, 1/2, 3/8, 5/16: (1 - e)^(-1/2)
};

template <typename Real>
struct SweepConstants {
  ClassConstants<Real> family[3];
  Real gain;             ///< dt/m
  Real step;             ///< dt
  Real gravity_step[3];  ///< dt g
  Real normal[3], height, plane_stiffness, plane_damping;
};

/// A lattice in lanes; the owner keeps the arrays.
template <typename Real>
struct LaneGrid {
  int slots, rows, planes;
  Real* motion;                 ///< [planes][rows][slots + 2][axes_per_slot][lanes], aligned to 64
  const LaneMask<Real>* masks;  ///< [planes][rows][slots][masks_per_slot]
  const std::uint8_t* links;    ///< [planes][rows]: bit r: linked row r; row_has_masses
  SweepConstants<Real> constants;
};

/// Takes one plane of masses through a time step: springs among them and to the next plane, then
/// integration. `forces` [2][rows][slots + 2][3][lanes] rolls along: its half plane % 2 holds what
/// the plane before left for this one, the other half receives what this one leaves for the next;
/// all zeros before plane 0, and again after the last.
template <typename Real>
using SweepPlane = void (*)(const LaneGrid<Real>& grid, int plane, Real* forces);

/// What one compilation offers (sweep_widths.cc), `width` doubles per register.
struct SweepOffer {
  SweepPlane<double> damped64, undamped64;
  SweepPlane<float> damped32, undamped32;
};
template <int width>
SweepOffer sweep_at();

}  // namespace fingertip::lattice::springs
