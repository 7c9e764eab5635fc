#include "multiply_rate.h"

#include <algorithm>
#include <ctime>

namespace spring_peers {

namespace {

constexpr int chains = 16;  // more than latency (4) times pipes (2)
constexpr int rounds = 4000;

// Written out, as a compiler may see through anything else. What is in the registers does not
// matter: multiplication takes as long for all numbers that it can meet here (zeros at the start).
#define FINGERTIP_CHAINS(op)                                                                     \
  op(0) op(1) op(2) op(3) op(4) op(5) op(6) op(7) op(8) op(9) op(10) op(11) op(12) op(13) op(14) \
      op(15)

void multiply_sse2() {
#define FINGERTIP_MULTIPLY(n) "mulpd %%xmm" #n ", %%xmm" #n "\n"
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_CHAINS(FINGERTIP_MULTIPLY)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MULTIPLY
}

[[gnu::target("avx2,fma")]] void multiply_avx2() {
#define FINGERTIP_MULTIPLY(n) "vfmadd213pd %%ymm" #n ", %%ymm" #n ", %%ymm" #n "\n"
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_CHAINS(FINGERTIP_MULTIPLY)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MULTIPLY
}

[[gnu::target("avx512f")]] void multiply_avx512() {
#define FINGERTIP_MULTIPLY(n) "vfmadd213pd %%zmm" #n ", %%zmm" #n ", %%zmm" #n "\n"
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_CHAINS(FINGERTIP_MULTIPLY)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MULTIPLY
}

#undef FINGERTIP_CHAINS

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace

double multiply_rate(int width, fingertip::lattice::springs::Precision precision) {
  void (*const multiply)() = width == 8   ? multiply_avx512
                             : width == 4 ? multiply_avx2
                                          : multiply_sse2;
  double best = 1e300;
  for (int i = 0; i < 60; ++i) {
    const double start = thread_seconds();
    multiply();
    best = std::min(best, thread_seconds() - start);
  }
  const int lanes =
      precision == fingertip::lattice::springs::Precision::float32 ? 2 * width : width;
  return double(rounds) * chains * lanes / best;
}

}  // namespace spring_peers
