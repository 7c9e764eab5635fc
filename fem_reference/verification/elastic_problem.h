/// A linear elastic boundary value problem on a test body, solved with the parts of which a press
/// is made: Body, HookeKernel, assemble, the condensed solver.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "fem_reference/analytic/elastic_field.h"
#include "fem_reference/job/job.h"
#include "fem_reference/verification/body_mesh.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::fem_reference::inline verification {

/// A displacement component (0, 1, 2) prescribed on a boundary. A meridian has no component 1.
struct Prescribed {
  int boundary = 0;
  int component = 0;
};

/// All three components on each boundary of the list.
std::vector<Prescribed> whole(const std::vector<int>& boundaries);

/// Loads and supports. Functions that are not set are zero. A component of the traction that is
/// prescribed as a displacement has no effect.
struct Loading {
  using Field = std::function<meshes::Vector3(const meshes::Vector3& position)>;
  using Traction = std::function<meshes::Vector3(int boundary, const meshes::Vector3& position,
                                                 const meshes::Vector3& outward_normal)>;
  std::vector<Prescribed> prescribed;
  Field displacement;  ///< [m]
  Field body_force;    ///< [N/m³]
  Traction traction;   ///< [Pa]
};

/// The loading under which `exact` is the solution: its displacement on what is prescribed, its
/// traction on all other boundaries, its body force. Keeps a reference to `exact`.
Loading loading_of(const analytic::ElasticField& exact, std::vector<Prescribed> prescribed);

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

/// A solid, or a body of revolution on its meridian (`revolved`): fields are then taken in the
/// plane y = 0, and forces along x are zero. One process solves it by itself, whatever their
/// number.
class ElasticProblem {
 public:
  static std::unique_ptr<ElasticProblem> on(const BodyMesh& body, const ElementType& element,
                                            const meshes::Rubber& rubber);
  virtual ~ElasticProblem() = default;
  ElasticProblem(const ElasticProblem&) = delete;
  ElasticProblem& operator=(const ElasticProblem&) = delete;

  virtual std::size_t unknowns() const = 0;
  virtual double volume() const = 0;  ///< of the meshed body [m³]

  /// Throws NotConverged when the supports leave a rigid motion free.
  virtual void solve(const Loading& loading) = 0;

  // Of the last solution:
  FieldError error(const analytic::ElasticField& exact) const;
  /// The same of the stress, in L2; its lambda div u is projected where the element projects it.
  double stress_error(const analytic::ElasticField& exact) const;
  /// Largest nodal distance from `exact` over the largest nodal |exact|; hanging nodes included.
  double nodal_error(const Loading::Field& exact) const;
  virtual meshes::Vector3 mean_displacement(int boundary) const = 0;  ///< over its area [m]
  /// Force of the supports on the boundary's nodes, loads on them deducted; forces of hanging nodes
  /// are passed on to those they follow [N].
  virtual meshes::Vector3 reaction(int boundary) const = 0;
  virtual double energy() const = 0;  ///< stored [J]

  /// Stiffness of all unknowns but hanging ones, without supports, dense; rows and columns in the
  /// order of nodes(): 3 a + i, of a meridian 2 a + i for r and z [N/m].
  virtual Eigen::MatrixXd stiffness() const = 0;
  /// Places of the nodes that do not hang [m].
  std::vector<meshes::Vector3> nodes() const;

 protected:
  explicit ElasticProblem(const meshes::Rubber& rubber) : rubber_(rubber) {}

  /// The solution at a quadrature point.
  struct PointState {
    meshes::Vector3 place, displacement;
    analytic::Matrix3 gradient;
    double dilatation = 0.0;  ///< as the element takes it, projected or not
    double volume = 0.0;
  };
  /// Points enough for errors of the elements' order.
  virtual void for_each_point(const std::function<void(const PointState&)>& take) const = 0;
  /// Place and displacement of every node, and whether it hangs.
  using TakeNode = std::function<void(const meshes::Vector3&, const meshes::Vector3&, bool)>;
  virtual void for_each_node(const TakeNode& take) const = 0;

  const meshes::Rubber rubber_;
};

}  // namespace fingertip::fem_reference::inline verification
