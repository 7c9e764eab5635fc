/// The rows of the continuum's tables. Free of deal.II.
#pragma once

#include <array>
#include <string>

#include "meshes/tables/file_fields.h"

namespace fingertip::fem_reference::inline job {

/// convergence.csv: a sample on a mesh, meshes counted from 1, SI.
struct ConvergenceRow {
  int mesh = 0;
  std::size_t cells = 0;
  std::size_t unknowns = 0;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double contact_radius = meshes::unknown;
  double max_pressure = meshes::unknown;
  double node_spacing = meshes::unknown;
  double energy = meshes::unknown;
  double indicator = meshes::unknown;
  double lateral_displacement = meshes::unknown;
};
consteval auto fields_of(const ConvergenceRow*) {
  return FINGERTIP_ALL_MEMBERS(ConvergenceRow, mesh, cells, unknowns, indentation, normal_force,
                               contact_radius, max_pressure, node_spacing, energy, indicator,
                               lateral_displacement)
      .in("m", "indentation contact_radius node_spacing lateral_displacement")
      .in("N", "normal_force")
      .in("Pa", "max_pressure")
      .in("J", "energy indicator")
      .newer("indicator lateral_displacement");
}

/// section.csv: a mesh edge in the plane y = 0, or of a whole solid where its surface crosses it,
/// as (x1, z1, x2, z2) in plane axes [m].
struct SectionRow {
  std::array<double, 4> undeformed{};
  std::array<double, 4> deformed{};
};
consteval auto fields_of(const SectionRow*) {
  return FINGERTIP_ALL_MEMBERS(SectionRow, undeformed, deformed)
      .in("m", "undeformed deformed")
      .called("undeformed", "x1,z1,x2,z2")
      .called("deformed", "deformed_x1,deformed_z1,deformed_x2,deformed_z2");
}

/// The state of the whole tip at the end of a time step; transient.csv tells the forces.
struct TransientStep {
  double time = 0.0;            ///< since first touch [s]
  double indentation = 0.0;     ///< [m]
  double normal_force = 0.0;    ///< of the bond on the rod, against the plane's normal [N]
  double contact_force = 0.0;   ///< of the plane on the rubber [N]
  double momentum = 0.0;        ///< of the rubber away from the plane, in the rod's frame [kg m/s]
  double kinetic_energy = 0.0;  ///< in the rod's frame [J]
  double elastic_energy = 0.0;  ///< of the branches, too [J]
  double work = 0.0;  ///< on the rubber so far, of the plane and where the frame accelerates [J]
  double dissipated_energy = 0.0;  ///< by damping and relaxation so far [J]
};
consteval auto fields_of(const TransientStep*) {
  return FINGERTIP_MEMBERS(TransientStep, time, indentation, normal_force, contact_force)
      .in("s", "time")
      .in("m", "indentation")
      .in("N", "normal_force contact_force");
}

/// modes.csv: symmetry as `name` of a SymmetryClass has it.
struct ModeRow {
  int mode = 0;
  double frequency = meshes::unknown;
  double frequency_error = meshes::unknown;
  std::string symmetry;
  int multiplicity = 0;
};
consteval auto fields_of(const ModeRow*) {
  return FINGERTIP_ALL_MEMBERS(ModeRow, mode, frequency, frequency_error, symmetry, multiplicity)
      .in("Hz", "frequency frequency_error");
}

}  // namespace fingertip::fem_reference::inline job
