#include "arithmetic_rate.h"

#include <algorithm>
#include <array>
#include <ctime>

namespace kernel_probes {

namespace {

constexpr int chains = 16;  // more than latency (4) times pipes (2)
constexpr int rounds = 4000;

// Written out with their loop, as a compiler may see through anything else and must not touch the
// registers in between. What stands in them is defined and stays a normal number: an operand below
// the least normal one costs some processors a hundred cycles. r: xmm, ymm or zmm.
// clang-format off
#define FINGERTIP_FIRST(op, r) op(r, 0) op(r, 1) op(r, 2) op(r, 3) op(r, 4) op(r, 5) op(r, 6) op(r, 7)
#define FINGERTIP_SECOND(op, r) op(r, 8) op(r, 9) op(r, 10) op(r, 11) op(r, 12) op(r, 13) op(r, 14) op(r, 15)
#define FINGERTIP_PAIRS(op, r) op(r, 0, 8) op(r, 1, 9) op(r, 2, 10) op(r, 3, 11) op(r, 4, 12) op(r, 5, 13) op(r, 6, 14) op(r, 7, 15)

// Legacy instructions, two operands.
#define FINGERTIP_ONE_2(r, n) "movapd %[one], %%" r #n "\n"
#define FINGERTIP_ZERO_2(r, n) "movapd %[zero], %%" r #n "\n"
#define FINGERTIP_MIX_2(r, m, n) "mulpd %%" r #m ", %%" r #m "\n" "addpd %%" r #n ", %%" r #n "\n"
// AVX, three.
#define FINGERTIP_ONE(r, n) "vbroadcastsd %[one], %%" r #n "\n"
#define FINGERTIP_ZERO(r, n) "vbroadcastsd %[zero], %%" r #n "\n"
#define FINGERTIP_MIX(r, m, n) "vmulpd %%" r #m ", %%" r #m ", %%" r #m "\n" "vaddpd %%" r #n ", %%" r #n ", %%" r #n "\n"

#define FINGERTIP_RUN(start, body, end)                                                          \
  int left = rounds;                                                                             \
  asm volatile(start "1:\n" body "dec %[left]\n" "jnz 1b\n" end                                  \
               : [left] "+r"(left) : [one] "m"(one), [zero] "m"(zero)                             \
               : "cc", "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",   \
                 "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15")
// clang-format on

alignas(16) constexpr double one[] = {1.0, 1.0};   // 1 x 1 stays 1
alignas(16) constexpr double zero[] = {0.0, 0.0};  // 0 + 0 stays 0

// As many multiplications as additions, in registers of their own.
void mix_sse2() {
  FINGERTIP_RUN(FINGERTIP_FIRST(FINGERTIP_ONE_2, "xmm") FINGERTIP_SECOND(FINGERTIP_ZERO_2, "xmm"),
                FINGERTIP_PAIRS(FINGERTIP_MIX_2, "xmm"), "");
}

[[gnu::target("avx2")]] void mix_avx2() {
  FINGERTIP_RUN(FINGERTIP_FIRST(FINGERTIP_ONE, "ymm") FINGERTIP_SECOND(FINGERTIP_ZERO, "ymm"),
                FINGERTIP_PAIRS(FINGERTIP_MIX, "ymm"), "vzeroupper\n");
}

[[gnu::target("avx512f")]] void mix_avx512() {
  FINGERTIP_RUN(FINGERTIP_FIRST(FINGERTIP_ONE, "zmm") FINGERTIP_SECOND(FINGERTIP_ZERO, "zmm"),
                FINGERTIP_PAIRS(FINGERTIP_MIX, "zmm"), "vzeroupper\n");
}

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
  for (double& seconds : spent) {
    const double start = thread_seconds();
    run();
    seconds = thread_seconds() - start;
  }
  const auto middle = spent.begin() + spent.size() / 2;
  std::nth_element(spent.begin(), middle, spent.end());
  return double(rounds) * chains * lanes / *middle;
}

}  // namespace

double arithmetic_rate(int width) {
  return rate_of(width == 8 ? mix_avx512 : width == 4 ? mix_avx2 : mix_sse2, width);
}

}  // namespace kernel_probes
