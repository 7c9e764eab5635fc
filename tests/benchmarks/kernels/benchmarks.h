/// The groups of benchmarks of fingertip-kernels. Every one reports real time and the counters
/// `masses`, `springs` (per step), `steps` (per iteration) and `operations` (per spring, 0
/// where not counted) or, for probes, `rate` [1/s] or `amount` (bytes per iteration); its name is
/// NAME/isa:ISA/precision:PRECISION/threads:N/size:N.
#pragma once

#include <string>

namespace kernel_benchmarks {

struct Scope {
  int widest = 0;        ///< doubles per register of the widest kernels, 2, 4 or 8
  int threads = 1;       ///< besides 1; 1: nothing else
  int per_radius = 12;   ///< R/a of the tips
  double seconds = 0.1;  ///< to spend on each, at least [s]
};

/// "sse2", "avx2", "avx512"
const char* isa_name(int width);

/// NAME/isa:ISA/precision:PRECISION/threads:N/size:N
std::string full_name(const std::string& name, int width, const std::string& precision, int threads,
                      int size);

void register_probes(const Scope& scope);
void register_tips(const Scope& scope);  ///< forces and steps of the product, on the default tip
/// Parts of a step of the default press (network, stick) at three depths, "part scaled|plain DEPTH
/// PART", with the counter `bytes`: the memory that each touches (touched_bytes). It has no
/// `springs`; `amount` is 1.
void register_parts(const Scope& scope);

}  // namespace kernel_benchmarks
