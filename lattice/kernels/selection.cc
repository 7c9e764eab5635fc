// Which compilation of each kernel serves.
#include "lattice/kernels/bond_kernel.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/cell_kernel.h"
#include "lattice/kernels/contact_kernel.h"
#include "lattice/kernels/kernel.h"

namespace fingertip::lattice::inline kernels::kernel {

SpringForces select(const Variant& variant, int width) {
  return by_width(width, springs_at<2>, springs_at<4>, springs_at<8>)(variant);
}

MoveParticles select_move(int width) {
  return by_width(width, move_at<2>, move_at<4>, move_at<8>)();
}

CellSweep select_cells(CellLawKind law, CellTask task, int width) {
  return by_width(width, cells_at<2>, cells_at<4>, cells_at<8>)(law, task);
}

CellEnergy select_cell_energy(CellLawKind law, int width) {
  return by_width(width, cell_energy_at<2>, cell_energy_at<4>, cell_energy_at<8>)(law);
}

const BondKernels& select_bond(int width) {
  return by_width(width, bond_at<2>, bond_at<4>, bond_at<8>)();
}

const ContactKernels& select_contact(int width) {
  return by_width(width, contact_at<2>, contact_at<4>, contact_at<8>)();
}

}  // namespace fingertip::lattice::inline kernels::kernel
