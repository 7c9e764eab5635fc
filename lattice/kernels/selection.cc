// Which compilation of each kernel serves.
#include "lattice/kernels/bond_kernel.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/cell_kernel.h"
#include "lattice/kernels/contact_kernel.h"
#include "lattice/kernels/kernel.h"

namespace fingertip::lattice::inline kernels::kernel {

SpringForces select(const Variant& variant, int width) {
  return by_width(width, [](auto w) { return springs_at<w()>; })(variant);
}

MoveParticles select_move(int width) {
  return by_width(width, [](auto w) { return move_at<w()>; })();
}

CellSweep select_cells(CellLawKind law, CellTask task, int width) {
  return by_width(width, [](auto w) { return cells_at<w()>; })(law, task);
}

CellEnergy select_cell_energy(CellLawKind law, int width) {
  return by_width(width, [](auto w) { return cell_energy_at<w()>; })(law);
}

const BondKernels& select_bond(int width) {
  return by_width(width, [](auto w) { return bond_at<w()>; })();
}

const ContactKernels& select_contact(int width) {
  return by_width(width, [](auto w) { return contact_at<w()>; })();
}

}  // namespace fingertip::lattice::inline kernels::kernel
