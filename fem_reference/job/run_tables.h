/// The rows of the continuum's tables. Free of deal.II.
#pragma once

#include <array>
#include <string>

#include "meshes/press/press_response.h"
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
constexpr auto fields_of(const ConvergenceRow*) {
  using meshes::field, meshes::Presence;
  using Row = ConvergenceRow;
  return std::tuple{field("mesh", &Row::mesh),
                    field("cells", &Row::cells),
                    field("unknowns", &Row::unknowns),
                    field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("contact_radius [m]", &Row::contact_radius),
                    field("max_pressure [Pa]", &Row::max_pressure),
                    field("node_spacing [m]", &Row::node_spacing),
                    field("energy [J]", &Row::energy),
                    field("indicator [J]", &Row::indicator, Presence::newer),
                    field("lateral_displacement [m]", &Row::lateral_displacement, Presence::newer)};
}

/// pressure.csv: a node that is pushed.
struct PressureRow {
  double indentation = meshes::unknown;
  double radius = meshes::unknown;
  double pressure = meshes::unknown;
  double lateral_displacement = meshes::unknown;
};
constexpr auto fields_of(const PressureRow*) {
  using meshes::field, meshes::Presence;
  using Row = PressureRow;
  return std::tuple{field("indentation [m]", &Row::indentation), field("radius [m]", &Row::radius),
                    field("pressure [Pa]", &Row::pressure),
                    field("lateral_displacement [m]", &Row::lateral_displacement, Presence::newer)};
}

/// section.csv: a mesh edge in the plane y = 0, or of a whole solid where its surface crosses it,
/// as (x1, z1, x2, z2) in plane axes [m].
struct SectionRow {
  std::array<double, 4> undeformed{};
  std::array<double, 4> deformed{};
};
constexpr auto fields_of(const SectionRow*) {
  using meshes::field;
  using Row = SectionRow;
  return std::tuple{
      field("x1 [m],z1 [m],x2 [m],z2 [m]", &Row::undeformed),
      field("deformed_x1 [m],deformed_z1 [m],deformed_x2 [m],deformed_z2 [m]", &Row::deformed)};
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
constexpr auto fields_of(const TransientStep*) {
  using meshes::field;
  using Row = TransientStep;
  return std::tuple{field("time [s]", &Row::time), field("indentation [m]", &Row::indentation),
                    field("normal_force [N]", &Row::normal_force),
                    field("contact_force [N]", &Row::contact_force)};
}

/// modes.csv: symmetry as `name` of a SymmetryClass has it.
struct ModeRow {
  int mode = 0;
  double frequency = meshes::unknown;
  double frequency_error = meshes::unknown;
  std::string symmetry;
  int multiplicity = 0;
};
constexpr auto fields_of(const ModeRow*) {
  using meshes::field;
  using Row = ModeRow;
  return std::tuple{field("mode", &Row::mode), field("frequency [Hz]", &Row::frequency),
                    field("frequency_error [Hz]", &Row::frequency_error),
                    field("symmetry", &Row::symmetry), field("multiplicity", &Row::multiplicity)};
}

}  // namespace fingertip::fem_reference::inline job
