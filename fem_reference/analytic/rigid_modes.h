/// The six displacements that strain nothing.
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// Small rigid-body motions about a centre c: u = t + w × (x - c). Modes 0, 1, 2 are the unit
/// translations along x, y, z [m/m], modes 3, 4, 5 the unit rotations about x, y, z [m/rad].
/// A stiffness matrix without constraints must map all six to zero, and loads in equilibrium do
/// no work on any of them.
class RigidModes {
 public:
  static constexpr int count = 6;
  using Basis = Eigen::Matrix<double, 3, count>;

  /// `centre` c [m], finite. Throws meshes::InvalidInput otherwise.
  explicit RigidModes(const Vector3& centre = Vector3::Zero());

  /// Displacement of `mode` at x. Throws meshes::InvalidInput unless 0 <= mode < 6.
  Vector3 displacement(int mode, const Vector3& x) const;
  /// du_i/dx_j of `mode`, skew and constant. Throws meshes::InvalidInput unless 0 <= mode < 6.
  Matrix3 gradient(int mode) const;
  /// All modes at x, one per column.
  Basis basis(const Vector3& x) const;

 private:
  Vector3 centre_;
};

}  // namespace fingertip::fem_reference::analytic
