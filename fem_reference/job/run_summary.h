/// summary.json of the continuum, SI. Free of deal.II.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::fem_reference::inline job {

/// The mesh before refinement, of a meridian its quadrilaterals: Jacobians, of a cube or square 1
/// when scaled, and volume [m³].
struct FirstMeshEntry {
  std::size_t hexahedra = 0, nodes = 0;
  double min_jacobian = meshes::unknown, min_scaled_jacobian = meshes::unknown,
         volume = meshes::unknown;
};
constexpr auto fields_of(const FirstMeshEntry*) {
  using meshes::named, meshes::newer;
  using Whole = FirstMeshEntry;
  return std::tuple_cat(
      named("hexahedra", &Whole::hexahedra),
      newer(named("nodes min_jacobian", &Whole::nodes, &Whole::min_jacobian)),
      named("min_scaled_jacobian volume", &Whole::min_scaled_jacobian, &Whole::volume));
}

/// A mesh of a sequence.
struct MeshEntry {
  std::size_t cells = 0, dofs = 0;
  double wall_time = meshes::unknown;
};
constexpr auto fields_of(const MeshEntry*) {
  using meshes::named;
  using Whole = MeshEntry;
  return named("cells dofs wall_time", &Whole::cells, &Whole::dofs, &Whole::wall_time);
}

/// The same, with the number of samples pressed on it.
struct PressMeshEntry {
  std::size_t cells = 0, dofs = 0, samples = 0;
  double wall_time = meshes::unknown;
};
constexpr auto fields_of(const PressMeshEntry*) {
  using meshes::named;
  using Whole = PressMeshEntry;
  return named("cells dofs samples wall_time", &Whole::cells, &Whole::dofs, &Whole::samples,
               &Whole::wall_time);
}

/// A sample on the finest mesh that computed it.
struct SampleEntry {
  double indentation = meshes::unknown, lateral_displacement = meshes::unknown,
         normal_force = meshes::unknown, contact_radius = meshes::unknown,
         max_pressure = meshes::unknown, force_error = meshes::unknown;
  std::string convergence;
  double order = meshes::unknown, min_jacobian = meshes::unknown, energy = meshes::unknown;
  long steps = 0, newton_iterations = 0, active_set_iterations = 0, cg_iterations = 0,
       active_nodes = 0, sliding_nodes = 0;
  double node_spacing = meshes::unknown, wall_time = meshes::unknown;
};
constexpr auto fields_of(const SampleEntry*) {
  using meshes::named, meshes::newer;
  using Whole = SampleEntry;
  return std::tuple_cat(
      named("indentation", &Whole::indentation),
      newer(named("lateral_displacement", &Whole::lateral_displacement)),
      named("normal_force contact_radius max_pressure force_error convergence order min_jacobian",
            &Whole::normal_force, &Whole::contact_radius, &Whole::max_pressure, &Whole::force_error,
            &Whole::convergence, &Whole::order, &Whole::min_jacobian),
      newer(named("energy", &Whole::energy)),
      named("steps newton_iterations active_set_iterations cg_iterations active_nodes",
            &Whole::steps, &Whole::newton_iterations, &Whole::active_set_iterations,
            &Whole::cg_iterations, &Whole::active_nodes),
      newer(named("sliding_nodes node_spacing", &Whole::sliding_nodes, &Whole::node_spacing)),
      named("wall_time", &Whole::wall_time));
}

/// A sample of a press at speed.
struct TransientSampleEntry : SampleEntry {
  double time = meshes::unknown;
};
constexpr auto fields_of(const TransientSampleEntry*) {
  using Whole = TransientSampleEntry;
  return meshes::named(
      "indentation time normal_force contact_radius max_pressure force_error energy steps "
      "active_set_iterations cg_iterations active_nodes wall_time",
      &Whole::indentation, &Whole::time, &Whole::normal_force, &Whole::contact_radius,
      &Whole::max_pressure, &Whole::force_error, &Whole::energy, &Whole::steps,
      &Whole::active_set_iterations, &Whole::cg_iterations, &Whole::active_nodes,
      &Whole::wall_time);
}

/// summary.json, by the job's `analysis`: static, transient, modes, verification.
struct RunSummary {
  std::string program, status, message, analysis;
  long degree = 0;
  std::string volumetric;
  double reached = meshes::unknown, refinement = meshes::unknown, tolerance = meshes::unknown;
  long ranks = 0;
  std::string contact, strain, law;
  double speed = meshes::unknown, worst_relative_error = meshes::unknown;
  FirstMeshEntry mesh;
  std::vector<PressMeshEntry> meshes;
  std::vector<MeshEntry> plain_meshes;
  std::string solver;
  std::size_t cells = 0, dofs = 0, contact_unknowns = 0, time_steps = 0;
  double transient_wall_time = meshes::unknown;
  std::vector<MeshEntry> static_meshes;
  std::optional<std::size_t> static_mesh_of_transient;
  double contact_node_spacing = meshes::unknown;
  std::vector<SampleEntry> samples;
  std::vector<TransientSampleEntry> transient_samples;
  std::size_t checks = 0, failed_checks = 0;
  double wall_time = meshes::unknown, peak_memory = meshes::unknown;

  bool empty() const { return status.empty(); }
  bool is_static() const { return analysis == "static"; }
  bool is_transient() const { return analysis == "transient"; }
  bool is_modes() const { return analysis == "modes"; }
  bool is_verification() const { return analysis == "verification"; }
  bool presses() const { return is_static() || is_transient(); }
  bool has_pressed() const { return is_transient() || !meshes.empty(); }
  bool has_mesh() const { return has_pressed() || !plain_meshes.empty(); }
  bool tells_error() const { return is_static() || !plain_meshes.empty(); }
};
constexpr auto fields_of(const RunSummary*) {
  using meshes::if_known, meshes::named, meshes::only;
  using Whole = RunSummary;
  return std::tuple_cat(
      named("program status", &Whole::program, &Whole::status),
      if_known(named("message", &Whole::message)), if_known(named("reached", &Whole::reached)),
      named("analysis degree volumetric refinement tolerance ranks", &Whole::analysis,
            &Whole::degree, &Whole::volumetric, &Whole::refinement, &Whole::tolerance,
            &Whole::ranks),
      only(&Whole::presses, named("contact strain", &Whole::contact, &Whole::strain)),
      if_known(named("law", &Whole::law)),
      only(&Whole::is_transient, named("speed", &Whole::speed)),
      only(&Whole::tells_error, named("worst_relative_error", &Whole::worst_relative_error)),
      only(&Whole::presses, named("mesh", &Whole::mesh)),
      only(&Whole::is_static, named("meshes", &Whole::meshes)),
      only(&Whole::is_modes, named("meshes", &Whole::plain_meshes)),
      only(&Whole::has_pressed, named("solver", &Whole::solver)),
      only(&Whole::has_mesh, named("cells dofs", &Whole::cells, &Whole::dofs)),
      only(&Whole::has_pressed, named("contact_unknowns", &Whole::contact_unknowns)),
      only(&Whole::is_transient,
           named("time_steps transient_wall_time static_meshes static_mesh_of_transient",
                 &Whole::time_steps, &Whole::transient_wall_time, &Whole::static_meshes,
                 &Whole::static_mesh_of_transient)),
      only(&Whole::is_static,
           named("contact_node_spacing samples", &Whole::contact_node_spacing, &Whole::samples)),
      only(&Whole::is_transient, named("samples", &Whole::transient_samples)),
      only(&Whole::is_verification,
           named("checks failed_checks", &Whole::checks, &Whole::failed_checks)),
      named("wall_time peak_memory", &Whole::wall_time, &Whole::peak_memory));
}

}  // namespace fingertip::fem_reference::inline job
