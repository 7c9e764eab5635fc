/// Loads and supports of a problem of elasticity.
#pragma once

#include <functional>
#include <vector>

#include "fem_reference/analytic/elastic_field.h"
#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::inline verification {

/// A displacement component (0, 1, 2) prescribed on a boundary. A meridian has no component 1.
struct Prescribed {
  int boundary = 0;
  int component = 0;
};

/// All three components on each boundary of the list.
std::vector<Prescribed> whole(const std::vector<int>& boundaries);

/// Loads and supports. Functions that are not set are zero. A component of the traction that is
/// prescribed as a displacement has no effect.
struct Loading {
  using Field = std::function<meshes::Vector3(const meshes::Vector3& position)>;
  using Traction = std::function<meshes::Vector3(int boundary, const meshes::Vector3& position,
                                                 const meshes::Vector3& outward_normal)>;
  std::vector<Prescribed> prescribed;
  Field displacement;  ///< [m]
  Field body_force;    ///< [N/m³]
  Traction traction;   ///< [Pa]
};

/// The loading under which `exact` is the solution: its displacement on what is prescribed, its
/// traction on all other boundaries, its body force. Keeps a reference to `exact`.
Loading loading_of(const analytic::ElasticField& exact, std::vector<Prescribed> prescribed);

}  // namespace fingertip::fem_reference::inline verification
