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

/// section.csv: ends of a mesh edge in y = 0: x1, z1, x2, z2 [m].
struct SectionRow {
  std::array<double, 4> undeformed{};
  std::array<double, 4> deformed{};
};
constexpr auto fields_of(const SectionRow*) {
  using meshes::field, meshes::Presence;
  using Row = SectionRow;
  return std::tuple{
      field("x1 [m],z1 [m],x2 [m],z2 [m]", &Row::undeformed),
      field("deformed_x1 [m],deformed_z1 [m],deformed_x2 [m],deformed_z2 [m]", &Row::deformed)};
}

/// transient.csv: forces on rod and plane.
struct TransientRow {
  double time = meshes::unknown;
  double indentation = meshes::unknown;
  double normal_force = meshes::unknown;
  double contact_force = meshes::unknown;
};
constexpr auto fields_of(const TransientRow*) {
  using meshes::field, meshes::Presence;
  using Row = TransientRow;
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
  using meshes::field, meshes::Presence;
  using Row = ModeRow;
  return std::tuple{field("mode", &Row::mode), field("frequency [Hz]", &Row::frequency),
                    field("frequency_error [Hz]", &Row::frequency_error),
                    field("symmetry", &Row::symmetry), field("multiplicity", &Row::multiplicity)};
}

}  // namespace fingertip::fem_reference::inline job
