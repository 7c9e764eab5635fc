/// What this processor can do at best, for rooflines: multiply-adds and bandwidth.
#pragma once

#include <cstddef>

namespace kernel_probes {

/// Multiply-adds per lane in one round of `multiply_add`.
inline constexpr long chains = 16;

/// `rounds` rounds of `chains` independent multiply-adds on registers of `width` doubles: 2 (every
/// x86-64; SSE2 has none, a multiplication and an addition stand for one), 4 (AVX2 with FMA) or 8
/// (AVX-512). The caller makes sure that the processor has them. Returns a meaningless sum.
double multiply_add(int width, long rounds);

double multiply_add_width2(long rounds);
double multiply_add_width4(long rounds);
double multiply_add_width8(long rounds);

/// to[i] = from[i] + factor: a read and a write per element.
void stream(const double* from, double* to, std::size_t count, double factor);

/// What Linux says of the largest cache of that level of core 0 [bytes]; `otherwise` without it.
std::size_t cache_bytes(int level, std::size_t otherwise);

}  // namespace kernel_probes
