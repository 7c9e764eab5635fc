/// What the processor can do at best, to be compared with what the spring engine does.
#pragma once

#include "tests/benchmarks/springs/engine/spring_lattice.h"

namespace spring_peers {

/// Multiply-pipe operations that the damped kernel executes per spring at full precision: |d|² 3,
/// w·d 3, the inverse root from its estimate 6, coefficient 2, force 3. Additions have pipes of
/// their own.
inline constexpr double multiply_operations_per_spring = 17.0;

/// Fused multiply-adds (without AVX2: multiplications) per second of one thread, counted lane by
/// lane, with independent operands in registers of `width` doubles: the roof over the kernel of
/// that width. Takes some milliseconds of processor time.
double multiply_rate(int width, fingertip::lattice::springs::Precision precision);

/// Operations per second of one thread that does as many multiplications as additions, unfused, in
/// double precision: the roof over kernels that are compiled without contraction. Up to twice the
/// multiply rate where additions have pipes of their own.
double arithmetic_rate(int width);

}  // namespace spring_peers
