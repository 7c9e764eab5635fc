// The multiply-add probe for every x86-64: a multiplication and an addition each (flags:
// CMakeLists.txt).
#include "multiply_add_body.h"
#include "probes.h"

namespace kernel_probes {

double multiply_add_width2(long rounds) {
  return multiply_add_rounds<2>(rounds);
}

}  // namespace kernel_probes
