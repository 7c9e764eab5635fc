// The sweep, compiled once per instruction set (lattice/CMakeLists.txt).
#include "tests/benchmarks/springs/engine/pack.h"
#include "tests/benchmarks/springs/engine/sweep_body.h"

namespace fingertip::lattice::springs {

using Doubles = Pack<std::experimental::native_simd<double>>;
using Floats = Pack<std::experimental::native_simd<float>>;

template <int width>
SweepOffer sweep_at() {
  return {Sweep<Doubles, true>::sweep_plane, Sweep<Doubles, false>::sweep_plane,
          Sweep<Floats, true>::sweep_plane, Sweep<Floats, false>::sweep_plane};
}
template SweepOffer sweep_at<Doubles::width>();

}  // namespace fingertip::lattice::springs
