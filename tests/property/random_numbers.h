/// Random numbers, vectors, rotations and rubbers for properties.
#pragma once

#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <cmath>

#include "meshes/rubber/rubber.h"

namespace fingertip::random {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// At least `from`, less than `to`; every value equally likely from the first test on (inRange
/// alone begins near `from`).
inline int integer(int from, int to) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(from, to));
}
inline double uniform(double from, double to) {
  return from + (to - from) * 1e-9 * integer(0, 1000000001);
}
inline Vector3d random_vector(double size) {
  return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}
inline Matrix3d random_matrix(double size) {
  Matrix3d m;
  for (int i = 0; i < 3; ++i) m.col(i) = random_vector(size);
  return m;
}
inline Matrix3d random_rotation() {
  const Vector3d axis = (random_vector(1.0) + Vector3d(0.1, 0.2, 1.3)).normalized();
  return Eigen::AngleAxisd(uniform(-3.1, 3.1), axis).toRotationMatrix();
}
inline Matrix3d skew(const Vector3d& w) {
  return (Matrix3d() << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0).finished();
}

inline meshes::Rubber random_rubber(double lowest_nu) {
  meshes::Rubber rubber;
  rubber.youngs_modulus = std::pow(10.0, uniform(2.0, 7.0));
  rubber.shear_modulus = rubber.youngs_modulus / (2.0 + 2.0 * uniform(lowest_nu, 0.4995));
  return rubber;
}

}  // namespace fingertip::random
