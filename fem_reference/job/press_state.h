/// What a press yields and on which mesh, of one sample. Free of deal.II.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fem_reference/job/job.h"
#include "meshes/press/contact_field.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"

namespace fingertip::fem_reference::inline job {

/// What a sample cost.
struct PressEffort {
  int steps = 0, newton_iterations = 0, active_set_iterations = 0, cg_iterations = 0;
};

/// What one sample yields, and what it cost.
struct PressState : meshes::PressSample, PressEffort {
  std::vector<meshes::ContactPoint> contact;  ///< nodes, with their images, that are pushed
  std::vector<meshes::MarkerRow> markers;     ///< of the protocol
  double node_spacing = 0.0;  ///< of the candidate nodes around the contact edge [m]
  double peak_spacing = 0.0;  ///< of the nodes where pressure is largest [m]
  /// Whether the contact ends within the surface that may touch, so that its edge moves; a pad's
  /// ends where the face does.
  bool free_edge = true;
  double min_jacobian = 1.0;  ///< smallest det F at a quadrature point; 1 at small strain
  /// Stored in the rubber; if it relaxes, after long times of this strain [J].
  double energy = 0.0;
  /// About the energy that the mesh stores in excess: G times the sum of the squared error
  /// indicators (refine()), 2.5 times that on a meridian, up to a factor of order one that meshes
  /// share [J].
  double indicator = 0.0;
  int active_nodes = 0;
  int sliding_nodes = 0;           ///< Coulomb's friction only
  double wall_time = 0.0;          ///< [s]
  std::string convergence;         ///< how forces on the meshes approach a limit, once it is known
  double order = meshes::unknown;  ///< of that convergence
};
/// An entry of summary.json.
consteval auto fields_of(const PressState*) {
  return FINGERTIP_MEMBERS(PressState, indentation, lateral_displacement, normal_force,
                           contact_radius, max_pressure, force_error, convergence, order,
                           min_jacobian, energy, steps, newton_iterations, active_set_iterations,
                           cg_iterations, active_nodes, sliding_nodes, node_spacing, wall_time)
      .newer("lateral_displacement energy sliding_nodes node_spacing");
}

/// The same of a press at speed.
struct TransientState : PressState {};
consteval auto fields_of(const TransientState*) {
  return FINGERTIP_MEMBERS(TransientState, indentation, time, normal_force, contact_radius,
                           max_pressure, force_error, energy, steps, active_set_iterations,
                           cg_iterations, active_nodes, wall_time);
}

/// The mesh on which a press is computed.
struct MeshSummary {
  std::size_t cells = 0;
  std::size_t unknowns = 0;
  std::size_t contact_unknowns = 0;
  LinearSolver solver = LinearSolver::automatic;
};
FINGERTIP_FIELDS(MeshSummary, cells, unknowns, contact_unknowns, solver);

}  // namespace fingertip::fem_reference::inline job
