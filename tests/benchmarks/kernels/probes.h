/// What this processor's memory can do at best, for rooflines. (Its multiply-adds: multiply_rate.h
/// of tests/benchmarks/springs.)
#pragma once

#include <cstddef>

namespace kernel_probes {

/// to[i] = from[i] + factor: a read and a write per element.
void stream(const double* from, double* to, std::size_t count, double factor);

/// What Linux says of the largest cache of that level of core 0 [bytes]; `otherwise` without it.
std::size_t cache_bytes(int level, std::size_t otherwise);

}  // namespace kernel_probes
