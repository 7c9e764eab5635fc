/// Energy, force and tangent of a lattice body.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "lattice/statics/lattice_body.h"

namespace fingertip::lattice::inline statics {

/// Symmetric; lower triangle, column by column.
using Tangent = Eigen::SparseMatrix<double>;

/// Adds up a LatticeBody's fibres, springs, cells and bond at a displacement. Unknown 3 p + i is
/// component i of particle p. The tangent's pattern is fixed at construction and holds every pair
/// of particles of a cell, of a spring or of an embedded point, so that contact adds to existing
/// entries. What is linear in the displacement is summed once, at construction: fibres and bond
/// always, the rest at small strain.
class ElasticSystem {
 public:
  explicit ElasticSystem(const LatticeBody& body);  // keeps a reference
  ~ElasticSystem();

  /// Energy above that of rest [J]; infinity where a cell is turned inside out and its law forbids
  /// it.
  double energy(const Eigen::VectorXd& displacement) const;
  /// force = -dU/du [N]; tangent = d²U/du² [N/m] if asked for (may be null; else it has the
  /// pattern). Throws meshes::NotConverged where energy() is infinite. Fixed unknowns are not
  /// treated here.
  void assemble(const Eigen::VectorXd& displacement, Eigen::VectorXd& force,
                Tangent* tangent) const;
  /// Whether force is linear in the displacement, so that the tangent never changes.
  bool linear() const;
  /// A zero matrix with the pattern.
  Tangent empty_tangent() const;
  /// Adds weight_a weight_b block to the entries of an embedded point's corners (lower triangle).
  /// `block` is symmetric; the point must be one of the body's bond or outer points.
  void add_embedded(const EmbeddedPoint& point, const Eigen::Matrix3d& block,
                    Tangent& tangent) const;
  /// Smallest det(1 + H) over the cells; 1 without cells.
  double smallest_jacobian(const Eigen::VectorXd& displacement) const;

  const LatticeBody& body() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Displacement of an embedded point [m].
meshes::Vector3 shift(const EmbeddedPoint& point, const Eigen::VectorXd& displacement);

/// Position of an embedded point at a displacement [m].
meshes::Vector3 position(const EmbeddedPoint& point, const Eigen::VectorXd& displacement);

/// Mean displacement gradient of a cell.
Eigen::Matrix3d cell_gradient(const MeanCell& cell, const Eigen::VectorXd& displacement);

}  // namespace fingertip::lattice::inline statics
