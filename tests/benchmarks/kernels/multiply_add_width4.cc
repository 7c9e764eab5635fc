// The multiply-add probe for AVX2 with FMA (flags: CMakeLists.txt).
#include "multiply_add_body.h"
#include "probes.h"

namespace kernel_probes {

double multiply_add_width4(long rounds) {
  return multiply_add_rounds<4>(rounds);
}

}  // namespace kernel_probes
