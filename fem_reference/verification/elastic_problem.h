/// A linear elastic boundary value problem on a test body, solved with the parts of which a press
/// is made: Body, HookeKernel, assemble, the condensed solver.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "fem_reference/analytic/elastic_field.h"
#include "fem_reference/job/job.h"
#include "fem_reference/verification/body_mesh.h"
#include "fem_reference/verification/loading.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::fem_reference::inline verification {

/// Polynomial degree and volumetric treatment.
struct ElementType {
  int degree = 2;
  Volumetric volumetric = Volumetric::mean_dilatation;
};

/// Relative errors over the body: of the displacement in L2 and of its gradient in L2 (the H1
/// seminorm).
struct FieldError {
  double l2 = 0.0, h1 = 0.0;
};

class ElasticModel;

/// A solid, or a body of revolution on its meridian (`revolved`): fields are then taken in the
/// plane y = 0, and forces along x are zero. One process solves it by itself, whatever their
/// number.
class ElasticProblem {
 public:
  ElasticProblem(const BodyMesh& body, const ElementType& element, const meshes::Rubber& rubber);
  ~ElasticProblem();
  ElasticProblem(const ElasticProblem&) = delete;
  ElasticProblem& operator=(const ElasticProblem&) = delete;

  std::size_t unknowns() const;
  double volume() const;  ///< of the meshed body [m³]

  /// Throws NotConverged when the supports leave a rigid motion free.
  void solve(const Loading& loading);

  // Of the last solution:
  FieldError error(const analytic::ElasticField& exact) const;
  /// The same of the stress, in L2; its lambda div u is projected where the element projects it.
  double stress_error(const analytic::ElasticField& exact) const;
  /// Largest nodal distance from `exact` over the largest nodal |exact|; hanging nodes included.
  double nodal_error(const Loading::Field& exact) const;
  meshes::Vector3 mean_displacement(int boundary) const;  ///< over its area [m]
  /// Force of the supports on the boundary's nodes, loads on them deducted; forces of hanging nodes
  /// are passed on to those they follow [N].
  meshes::Vector3 reaction(int boundary) const;
  double energy() const;  ///< stored [J]

  /// Stiffness of all unknowns but hanging ones, without supports, dense; rows and columns in the
  /// order of nodes(): 3 a + i, of a meridian 2 a + i for r and z [N/m].
  Eigen::MatrixXd stiffness() const;
  /// Places of the nodes that do not hang [m].
  std::vector<meshes::Vector3> nodes() const;

 private:
  std::unique_ptr<ElasticModel> model_;
};

}  // namespace fingertip::fem_reference::inline verification
