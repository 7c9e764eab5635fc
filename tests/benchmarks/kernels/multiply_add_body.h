/// The multiply-add probe itself, compiled once per instruction set; included by
/// multiply_add_width*.cc.
#pragma once

namespace kernel_probes {

template <int Width>
struct Register {
  using Type [[gnu::vector_size(Width * sizeof(double))]] = double;
};

/// `rounds` times 16 independent multiply-adds on registers of `Width` doubles: enough in flight
/// for two pipes with a latency of up to eight cycles. Returns a sum, so that nothing can be left
/// out.
template <int Width>
double multiply_add_rounds(long rounds) {
  using Pack = typename Register<Width>::Type;
  constexpr int chains = 16;
  Pack sum[chains];
  for (int c = 0; c < chains; ++c) sum[c] = Pack{} + (1.0 + 1e-3 * c);
  Pack factor = Pack{} + 0.999, term = Pack{} + 1e-3;
  asm volatile("" : "+m"(factor), "+m"(term));  // unknown to the compiler
  const Pack f = factor, t = term;
  for (long n = 0; n < rounds; ++n) {
#pragma GCC unroll 16
    for (int c = 0; c < chains; ++c) sum[c] = sum[c] * f + t;
  }
  Pack total{};
  for (int c = 0; c < chains; ++c) total += sum[c];
  double result = 0.0;
  for (int lane = 0; lane < Width; ++lane) result += total[lane];
  return result;
}

}  // namespace kernel_probes
