#include "lattice/kernels/kernel.h"

#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::kernel {

namespace {

Offer offer(int width) {
  return by_width(width, offer_width2, offer_width4, offer_width8)();
}

}  // namespace

int supported_width() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
    return 8;
  }
  return __builtin_cpu_supports("avx2") ? 4 : 2;
}

GatherForces select(const Variant& variant, int width) {
  return offer(width).select(variant);
}
GatherForces select(const Variant& variant) {
  return select(variant, supported_width());
}
MoveParticles select_move(int width) {
  return offer(width).move;
}
MoveParticles select_move() {
  return select_move(supported_width());
}

}  // namespace fingertip::lattice::kernel
