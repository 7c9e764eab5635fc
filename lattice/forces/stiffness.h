/// The lattice's small-strain stiffness as a sparse matrix, for statics, spectra and tests.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "lattice/model/model.h"

namespace fingertip::lattice::inline forces {

/// Symmetric K [N/m] of the springs (no ligaments), and of whole cells that resist changes of
/// volume (build_block): force = -K u about the rest state. Degree of freedom 3 p + c is axis c of
/// the p-th entry of model.particles.
Eigen::SparseMatrix<double> small_strain_stiffness(const LatticeModel& model);

}  // namespace fingertip::lattice::inline forces
