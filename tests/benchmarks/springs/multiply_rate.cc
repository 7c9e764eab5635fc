#include "multiply_rate.h"

#include <algorithm>
#include <array>
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

// As many multiplications as additions, in registers of their own.
#define FINGERTIP_PAIRS(op) \
  op(0, 8) op(1, 9) op(2, 10) op(3, 11) op(4, 12) op(5, 13) op(6, 14) op(7, 15)

void mix_sse2() {
#define FINGERTIP_MIX(m, n) "mulpd %%xmm" #m ", %%xmm" #m "\naddpd %%xmm" #n ", %%xmm" #n "\n"
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_PAIRS(FINGERTIP_MIX)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MIX
}

#define FINGERTIP_MIX_IN(r, m, n)          \
  "vmulpd %%" r #m ", %%" r #m ", %%" r #m \
  "\n"                                     \
  "vaddpd %%" r #n ", %%" r #n ", %%" r #n "\n"

[[gnu::target("avx2")]] void mix_avx2() {
#define FINGERTIP_MIX(m, n) FINGERTIP_MIX_IN("ymm", m, n)
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_PAIRS(FINGERTIP_MIX)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MIX
}

[[gnu::target("avx512f")]] void mix_avx512() {
#define FINGERTIP_MIX(m, n) FINGERTIP_MIX_IN("zmm", m, n)
  for (int i = 0; i < rounds; ++i)
    asm volatile(FINGERTIP_PAIRS(FINGERTIP_MIX)::
                     : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                       "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#undef FINGERTIP_MIX
}

#undef FINGERTIP_MIX_IN
#undef FINGERTIP_PAIRS
#undef FINGERTIP_CHAINS

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Of a function that does `rounds` times `chains` operations per lane [1/s]. The median of many
/// runs: registers are all it needs, so it cannot be disturbed for long, while the shortest may be
/// one that the clock of a virtual processor missed.
double rate_of(void (*run)(), int lanes) {
  std::array<double, 61> spent;
  for (double& one : spent) {
    const double start = thread_seconds();
    run();
    one = thread_seconds() - start;
  }
  const auto middle = spent.begin() + spent.size() / 2;
  std::nth_element(spent.begin(), middle, spent.end());
  return double(rounds) * chains * lanes / *middle;
}

}  // namespace

double multiply_rate(int width, fingertip::lattice::springs::Precision precision) {
  const bool half = precision == fingertip::lattice::springs::Precision::float32;
  return rate_of(width == 8   ? multiply_avx512
                 : width == 4 ? multiply_avx2
                              : multiply_sse2,
                 half ? 2 * width : width);
}

double arithmetic_rate(int width) {
  return rate_of(width == 8 ? mix_avx512 : width == 4 ? mix_avx2 : mix_sse2, width);
}

}  // namespace spring_peers
