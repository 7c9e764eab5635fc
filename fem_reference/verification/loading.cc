#include "fem_reference/verification/loading.h"

#include <utility>

namespace fingertip::fem_reference::inline verification {

using meshes::Vector3;

std::vector<Prescribed> whole(const std::vector<int>& boundaries) {
  std::vector<Prescribed> result;
  for (const int b : boundaries)
    for (int component = 0; component < 3; ++component) result.push_back({b, component});
  return result;
}

Loading loading_of(const analytic::ElasticField& exact, std::vector<Prescribed> prescribed) {
  Loading loading;
  loading.prescribed = std::move(prescribed);
  loading.displacement = [&exact](const Vector3& x) { return exact.displacement(x); };
  loading.body_force = [&exact](const Vector3& x) { return exact.body_force(x); };
  loading.traction = [&exact](int, const Vector3& x, const Vector3& n) {
    return exact.traction(x, n);
  };
  return loading;
}

}  // namespace fingertip::fem_reference::inline verification
