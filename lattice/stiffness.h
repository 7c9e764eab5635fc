/// The lattice's small-strain stiffness as a sparse matrix, for statics, spectra and tests.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lattice/model.h"

namespace fingertip::lattice {

/// Symmetric K [N/m] of springs and cells (no ligaments): force = -K u about the rest state. Degree
/// of freedom 3 p + c is axis c of the p-th entry of model.particles.
Eigen::SparseMatrix<double> small_strain_stiffness(const LatticeModel& model);

/// The diagonal of the mass matrix [kg], in the same order.
Eigen::VectorXd mass_vector(const LatticeModel& model);

/// Stiffness (24 x 24) of one cell with its shares of springs and its volume term; corner c (as in
/// cell_corner) owns rows 3 c .. 3 c + 2.
Eigen::Matrix<double, 24, 24> cell_stiffness(const SpringConstants& constants, double spacing);

}  // namespace fingertip::lattice
