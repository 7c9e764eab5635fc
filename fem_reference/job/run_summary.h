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
consteval auto fields_of(const MeshEntry*) {
  return FINGERTIP_ALL_MEMBERS(MeshEntry, cells, dofs, samples, wall_time).if_known("samples");
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
consteval auto fields_of(const RunSummary*) {
  return FINGERTIP_ALL_MEMBERS(RunSummary, program, status, message, reached, analysis, degree,
                               volumetric, refinement, tolerance, ranks, contact, strain, law,
                               speed, worst_relative_error, mesh, meshes, solver, cells, dofs,
                               contact_unknowns, time_steps, transient_wall_time, static_meshes,
                               static_mesh_of_transient, contact_node_spacing, samples,
                               transient_samples, checks, failed_checks, wall_time, peak_memory)
      .only(&RunSummary::presses, "contact strain mesh")
      .only(&RunSummary::is_transient,
            "speed time_steps transient_wall_time static_meshes static_mesh_of_transient "
            "transient_samples")
      .only(&RunSummary::tells_error, "worst_relative_error")
      .only(&RunSummary::refines, "meshes")
      .only(&RunSummary::is_static, "contact_node_spacing samples")
      .only(&RunSummary::has_pressed, "solver contact_unknowns")
      .only(&RunSummary::has_mesh, "cells dofs")
      .only(&RunSummary::is_verification, "checks failed_checks")
      .if_known("message reached law")
      .called("transient_samples", "samples");
}

}  // namespace fingertip::fem_reference::inline job
