/// What a press yields and on which mesh, of one sample. Free of deal.II.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fem_reference/job/job.h"
#include "meshes/press/press_response.h"

namespace fingertip::fem_reference::inline press {

/// A node that the plane pushes.
struct ContactPoint {
  /// Distance from the axis, of another shape than the dome from the line through where it touches
  /// first: small strain reference, large strain current [m].
  double radius = 0.0;
  double pressure = 0.0;  ///< nodal force over lumped area (large strain: current area) [Pa]
};

/// What one sample yields, and what it cost.
struct PressState {
  meshes::PressSample sample;
  std::vector<ContactPoint> contact;  ///< by increasing radius
  double node_spacing = 0.0;          ///< of the candidate nodes around the contact edge [m]
  double min_jacobian = 1.0;          ///< smallest det F at a quadrature point; 1 at small strain
  double energy =
      0.0;  ///< stored in the rubber; if it relaxes, after long times of this strain [J]
  /// About the energy that the mesh stores in excess: G times the sum of the squared error
  /// indicators (refine()), 2.5 times that on a meridian, up to a factor of order one that meshes
  /// share [J].
  double indicator = 0.0;
  int steps = 0;
  int newton_iterations = 0;
  int active_set_iterations = 0;
  int cg_iterations = 0;
  int active_nodes = 0;
  int sliding_nodes = 0;   ///< Coulomb's friction only
  double wall_time = 0.0;  ///< [s]
};

/// The mesh on which a press is computed.
struct MeshSummary {
  std::size_t cells = 0;
  std::size_t unknowns = 0;
  std::size_t contact_unknowns = 0;
  LinearSolver solver = LinearSolver::automatic;
};

/// A mesh edge in the plane y = 0, or of a whole solid where its surface crosses it, undeformed and
/// deformed, as (x1, z1, x2, z2) in plane axes [m].
struct SectionEdge {
  std::array<double, 4> undeformed{};
  std::array<double, 4> deformed{};
};

/// Radius of the contact edge [m]. Pressure vanishes there like the square root of the distance, as
/// in Hertz's p² ∝ a² - r²: the zero of a parabola in r² fitted to p² over the outer third of the
/// contact (the outer half where that has few nodes), kept within one node spacing of the outermost
/// node that is pushed. `contact` is sorted by radius; about `nodes_per_ring` of its points share
/// one.
double contact_edge(const std::vector<ContactPoint>& contact, double node_spacing,
                    int nodes_per_ring);

}  // namespace fingertip::fem_reference::inline press
