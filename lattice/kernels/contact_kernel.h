/// Interface of the vectorised kernels of the contact: raw arrays only, as in kernel.h.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lattice/kernels/lanes.h"
#include "lattice/kernels/tie_law.h"
#include "meshes/press/obstacle_surface.h"

namespace fingertip::lattice::inline kernels::kernel {

/// What ties of the plane do to one particle.
struct ContactLoad {
  double force[3];  ///< along the grid's axes [N]
  /// Σ_j |w_i w_j| K of the ties that act, K of a tie, w the weights of the corners: xx, yy, zz,
  /// xy, xz, yz, along the grid's axes [N/m].
  double stiffness[6];
};

/// What the ties of a group do to the corners of its cell.
struct alignas(64) GroupLoads {
  ContactLoad corner[lanes];
};

/// What is remembered of the eight points of a group. Places are relative to the plane, in axes
/// that are fixed to it; flags are 0 or 1.
struct ContactMemory {
  Lanes place[3];   ///< at the end of the last step looked at [m]
  Lanes anchor[3];  ///< where the point is held [m]
  /// Of an obstacle at small strain (statics/static_contact.h), along its t1 and t2 [m]: the point
  /// at rest then, and its foot.
  Lanes rest[2], foot[2];
  Lanes gap;  ///< at the end of the last step looked at [m]
  Lanes anchored;
  Lanes sliding;   ///< slipped in the last step (coulomb)
  Lanes push;      ///< along the normal, in the last apply() [N]
  Lanes force[3];  ///< then, on the tip [N]
};

/// Eight points of one cell of the grid. A group of fewer repeats its first point, without
/// stiffness.
struct ContactGroup {
  std::uint32_t corner[lanes];    ///< grid indices of the cell's corners
  std::uint32_t particle[lanes];  ///< the same as numbers of contact particles
  Lanes local[3];                 ///< of the points in the cell, 0 to 1 along each of its edges
  Lanes rest[3];                  ///< along the grid's axes [m]
  Lanes stiffness;                ///< at rest [N/m]
  Lanes inertia;                  ///< stiffness times Σ |weight| [N/m]
  Lanes facing[3];  ///< outward normal times the surface it stands for, along the grid's axes [m²]
};

/// From a place along the grid's axes to one fixed to the plane: turn x + shift.
struct PlaneFrame {
  double turn[9];
  double shift[3];
};

struct ContactArrays {
  const double* displacement[3];  ///< per grid point, along the grid's axes [m]
  const double* velocity[3];      ///< [m/s]
  const ContactGroup* groups;
  ContactMemory* memory;  ///< per group
  GroupLoads* loads;      ///< per group; of those that touch
  PlaneFrame now, then;   ///< at the start and at the end of the step
  double normal[3];       ///< of the plane, in its own axes
  double ahead;           ///< length of the step [s]
  double friction;        ///< Coulomb's coefficient
  TieLaw law;             ///< of all ties
  /// What gaps are told from: a plane, or else an obstacle, by the distance from it (`exact`) or
  /// the distance from the plane less its height at the point's foot (statics/static_contact.h).
  meshes::ObstacleForm obstacle;
  bool exact;
  bool follows;          ///< whether feet do: not without friction
  double tangent[2][3];  ///< t1 and t2 of the obstacle, in the plane's own axes
  PlaneFrame carried;    ///< of a point at rest as the rod carries it
};

enum class Grip { frictionless, stick, coulomb };

/// What apply() found in a group.
struct GroupFindings {
  double energy = 0.0;  ///< of its ties [J]
  int touching = 0;
  int sliding = 0;            ///< of these (coulomb)
  double smallest_gap = 0.0;  ///< [m]
  bool anchored = false;      ///< any point
};

/// How a contact's patch is looked at.
struct PatchView {
  /// Two tangents of the plane, in its own axes; or, where displacements are small and points seen
  /// at rest, along the grid's.
  double tangent[2][3];
  bool at_rest;
  double normal[3];  ///< along the grid's axes
};

/// Sums of forces along the normal over loaded points, times powers of the places x and y along the
/// tangents: 1; x, y; xx, xy, yy; … yyyy.
struct PatchSums {
  double power[15] = {};
  double area = 0.0;     ///< times the surface that a point stands for, projected on the plane
  double touched = 0.0;  ///< that surface alone, of points that are pushed
};

/// Two calls at a time write the same place only if they are for the same group.
struct ContactKernels {
  /// Largest speed along -normal (grid's axes) among particles with these grid indices, at least
  /// 0 [m/s].
  double (*closing)(const double* const* velocity, const double* normal,
                    const std::uint32_t* particles, std::size_t count);
  /// Puts the feet of a group where its points are at rest; the first of all.
  void (*stand)(const ContactArrays&, std::size_t group);
  /// The smallest gap of a group at the end of the step. Notes where its points will be unless that
  /// is below `margin`.
  double (*look)(const ContactArrays&, double margin, std::size_t group);
  /// Notes where the points of a group will be, brings anchors up to date and, if any tie acts,
  /// sets the group's loads.
  GroupFindings (*apply)(const ContactArrays&, Grip grip, std::size_t group);
  /// Adds a group as it was in the last apply().
  void (*add_up)(const ContactGroup&, const ContactMemory&, const PatchView&, PatchSums&);
};

/// For 2, 4 or 8 doubles per register, the caller makes sure that the processor has it, or 0 for
/// the widest that it has.
const ContactKernels& select_contact(int width);

/// That of one compilation (contact_kernel_widths.cc).
template <int width>
const ContactKernels& contact_at();

}  // namespace fingertip::lattice::inline kernels::kernel
