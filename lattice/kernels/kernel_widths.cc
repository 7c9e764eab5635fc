// The kernels of springs and particles, compiled once per instruction set (lattice/CMakeLists.txt).
#include "lattice/kernels/kernel_body.h"

namespace fingertip::lattice::inline kernels::kernel {

using Pack = std::experimental::native_simd<double>;

template <int width>
SpringForces springs_at(const Variant& variant) {
  return Body<Pack>::select(variant);
}
template SpringForces springs_at<int(Pack::size())>(const Variant&);

template <int width>
MoveParticles move_at() {
  return Body<Pack>::move;
}
template MoveParticles move_at<int(Pack::size())>();

}  // namespace fingertip::lattice::inline kernels::kernel
