/// What this processor's arithmetic can do at best, for rooflines.
#pragma once

namespace kernel_probes {

/// Operations per second of one thread that does as many multiplications as additions, unfused, in
/// double precision, with independent operands in registers of `width` doubles: the roof over
/// kernels that are compiled without contraction. Takes some milliseconds of processor time.
double arithmetic_rate(int width);

}  // namespace kernel_probes
