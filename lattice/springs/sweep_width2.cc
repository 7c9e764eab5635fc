// The sweep for every x86-64: compiled with that instruction set's flags (CMakeLists.txt).
#include "lattice/springs/pack_sse2.h"
#include "lattice/springs/sweep_body.h"

namespace fingertip::lattice::springs {

SweepOffer sweep_width2() {
  return {Sweep<Pack2d, true>::sweep_plane, Sweep<Pack2d, false>::sweep_plane,
          Sweep<Pack4f, true>::sweep_plane, Sweep<Pack4f, false>::sweep_plane};
}

}  // namespace fingertip::lattice::springs
