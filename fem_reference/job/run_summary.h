/// summary.json of the continuum, SI. Free of deal.II.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fem_reference/job/press_state.h"
#include "meshes/volume_mesh/volume_mesh.h"

namespace fingertip::fem_reference::inline job {

/// A mesh of a sequence.
struct MeshEntry {
  std::size_t cells = 0, dofs = 0;
  std::optional<std::size_t> samples;  ///< pressed on it, of a static press
  double wall_time = meshes::unknown;
};
constexpr auto fields_of(const MeshEntry*) {
  return std::tuple_cat(FINGERTIP_FIELDS(MeshEntry, cells, dofs),
                        meshes::if_known(FINGERTIP_FIELDS(MeshEntry, samples)),
                        FINGERTIP_FIELDS(MeshEntry, wall_time));
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
  meshes::MeshQuality mesh;  ///< the first one
  std::vector<MeshEntry> meshes;
  std::string solver;
  std::size_t cells = 0, dofs = 0, contact_unknowns = 0, time_steps = 0;
  double transient_wall_time = meshes::unknown;
  std::vector<MeshEntry> static_meshes;
  std::optional<std::size_t> static_mesh_of_transient;
  double contact_node_spacing = meshes::unknown;
  std::vector<PressState> samples;
  std::vector<TransientState> transient_samples;
  std::size_t checks = 0, failed_checks = 0;
  double wall_time = meshes::unknown, peak_memory = meshes::unknown;

  bool empty() const { return status.empty(); }
  bool is_static() const { return analysis == "static"; }
  bool is_transient() const { return analysis == "transient"; }
  bool is_modes() const { return analysis == "modes"; }
  bool is_verification() const { return analysis == "verification"; }
  bool presses() const { return is_static() || is_transient(); }
  bool refines() const { return is_static() || is_modes(); }
  bool has_pressed() const { return is_transient() || (is_static() && has_mesh()); }
  bool has_mesh() const { return is_transient() || !meshes.empty(); }
  bool tells_error() const { return is_static() || (is_modes() && has_mesh()); }
};
constexpr auto fields_of(const RunSummary*) {
  using meshes::if_known, meshes::only;
  using Whole = RunSummary;
  return std::tuple_cat(
      FINGERTIP_FIELDS(Whole, program, status), if_known(FINGERTIP_FIELDS(Whole, message, reached)),
      FINGERTIP_FIELDS(Whole, analysis, degree, volumetric, refinement, tolerance, ranks),
      only(&Whole::presses, FINGERTIP_FIELDS(Whole, contact, strain)),
      if_known(FINGERTIP_FIELDS(Whole, law)),
      only(&Whole::is_transient, FINGERTIP_FIELDS(Whole, speed)),
      only(&Whole::tells_error, FINGERTIP_FIELDS(Whole, worst_relative_error)),
      only(&Whole::presses, FINGERTIP_FIELDS(Whole, mesh)),
      only(&Whole::refines, FINGERTIP_FIELDS(Whole, meshes)),
      only(&Whole::has_pressed, FINGERTIP_FIELDS(Whole, solver)),
      only(&Whole::has_mesh, FINGERTIP_FIELDS(Whole, cells, dofs)),
      only(&Whole::has_pressed, FINGERTIP_FIELDS(Whole, contact_unknowns)),
      only(&Whole::is_transient, FINGERTIP_FIELDS(Whole, time_steps, transient_wall_time,
                                                  static_meshes, static_mesh_of_transient)),
      only(&Whole::is_static, FINGERTIP_FIELDS(Whole, contact_node_spacing, samples)),
      only(&Whole::is_transient, meshes::named("samples", &Whole::transient_samples)),
      only(&Whole::is_verification, FINGERTIP_FIELDS(Whole, checks, failed_checks)),
      FINGERTIP_FIELDS(Whole, wall_time, peak_memory));
}

}  // namespace fingertip::fem_reference::inline job
