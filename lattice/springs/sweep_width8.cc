// The sweep for AVX-512: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/springs/pack_avx512.h"
#include "lattice/springs/sweep_body.h"

namespace fingertip::lattice::springs {

SweepOffer sweep_width8() {
  return {Sweep<Pack8d, true>::sweep_plane, Sweep<Pack8d, false>::sweep_plane,
          Sweep<Pack16f, true>::sweep_plane, Sweep<Pack16f, false>::sweep_plane};
}

}  // namespace fingertip::lattice::springs
