/// Laws of the statics' cells by the constants that make them.
#pragma once

#include "lattice/model/cell_law.h"
#include "lattice/model/formulation.h"

namespace laws {

using namespace fingertip;
using lattice::CellLaw;

inline CellLaw network_law(const meshes::Rubber& rubber, double share) {
  return {
      lattice::network_material(rubber.energy, rubber.shear_modulus, rubber.lame_lambda(), share)};
}
inline CellLaw volume_law(double kappa, bool finite) {
  return {lattice::volume_material(kappa, finite)};
}
inline CellLaw cubic_law(const lattice::SpringConstants& constants, double spacing, double share,
                         const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity()) {
  return {lattice::cubic_material(constants, spacing, share), axes};
}

}  // namespace laws
