// The sweep for AVX2 with FMA: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/springs/pack_avx2.h"
#include "lattice/springs/sweep_body.h"

namespace fingertip::lattice::springs {

SweepOffer sweep_width4() {
  return {Sweep<Pack4d, true>::sweep_plane, Sweep<Pack4d, false>::sweep_plane,
          Sweep<Pack8f, true>::sweep_plane, Sweep<Pack8f, false>::sweep_plane};
}

}  // namespace fingertip::lattice::springs
