/// Which lattice the tip is made of.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lattice/model/constants.h"
#include "meshes/base/errors.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

/// The lattice of the tip.
struct LatticeSettings {
  ModelKind model = ModelKind::hookean;
  Kinematics kinematics = Kinematics::small;
  double spacing = 0.01 / 12.0;                      ///< a [m], at most (R - r)/2
  meshes::Vector3 offset = meshes::Vector3::Zero();  ///< shift of the grid in units of a
  /// Columns: the grid's axes in the tip's frame, a rotation.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  SpringConstants constants;        ///< for this spacing
  double ligament_stiffness = 1.0;  ///< multiplies the stiffness of the bond to the rod
  double contact_stiffness = 1.0;   ///< multiplies the penalty stiffness of true surfaces

  /// What this geometry and this rubber cannot be built of.
  std::vector<meshes::Violation> violations(const meshes::Geometry& geometry,
                                            const meshes::Rubber& rubber) const;
  /// The parts of that: of spacing, offset and ties; of axes, constants and rubber, but for what an
  /// energy without a bound leaves to chance (kappa < 0).
  std::vector<meshes::Violation> grid_violations(const meshes::Geometry& geometry) const;
  std::vector<meshes::Violation> material_violations(const meshes::Rubber& rubber) const;
};

/// The coarsest spacing that a model of this geometry can be built with: through the thinnest wall,
/// and for the bond to a dome's rod [m].
double coarsest_spacing(const meshes::Geometry& geometry, ModelKind model);

}  // namespace fingertip::lattice::inline model
