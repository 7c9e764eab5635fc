// The multiply-add probe for AVX-512 (flags: CMakeLists.txt).
#include "multiply_add_body.h"
#include "probes.h"

namespace kernel_probes {

double multiply_add_width8(long rounds) {
  return multiply_add_rounds<8>(rounds);
}

}  // namespace kernel_probes
