/// A static press along the axis computed on the meridian alone: an independent cross-check of the
/// three-dimensional continuum. Shares no code with it.
#pragma once

#include <vector>

#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"
#include "tests/verification/axisymmetric/meridian.h"

namespace fingertip::verification {

struct AxisymmetricJob {
  meshes::Geometry geometry;
  meshes::Rubber rubber;
  /// Stick or frictionless.
  meshes::ContactMode contact = meshes::ContactMode::frictionless;
  bool finite = false;  ///< law A, W = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)²; else Hooke
  std::vector<double> samples;  ///< indentations, increasing, > 0 [m]
  double longest_step = 0.005;  ///< where the path matters, over R - r
  MeridianOptions mesh;
};

struct AxisymmetricSample {
  double indentation = 0.0;     ///< [m]
  double force = 0.0;           ///< [N]
  double contact_radius = 0.0;  ///< at rest for small strain, deformed for finite [m]
  double max_pressure = 0.0;    ///< true pressure over the deformed area for finite strain [Pa]
  std::vector<double> radii, pressures;  ///< of the nodes that touch, from the pole [m], [Pa]
};

/// Quadratic elements, 3 x 3 Gauss points, weights 2 pi r; u = 0 on the rod, u_r = 0 on the axis.
/// A node touches while its gap closes and the plane pushes; with stick it keeps the radius at
/// which it first touched, interpolated within the step. Small strain: the plane's forces from the
/// compliance of the outer nodes; finite strain: Newton's method with the set of touching nodes
/// updated in every iteration. Throws meshes::NotConverged.
std::vector<AxisymmetricSample> press_axisymmetric(const AxisymmetricJob& job);

}  // namespace fingertip::verification
