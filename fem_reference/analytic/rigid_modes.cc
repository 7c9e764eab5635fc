#include "fem_reference/analytic/rigid_modes.h"

namespace fingertip::fem_reference::analytic {
namespace {

/// Matrix of v -> w × v.
Matrix3 cross_matrix(const Vector3& w) {
  Matrix3 result;
  result << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return result;
}

void require_mode(int mode) {
  require(mode >= 0 && mode < RigidModes::count, "mode", mode, "must be 0 to 5");
}

}  // namespace

RigidModes::RigidModes(const Vector3& centre) : centre_(centre) {
  for (const double c : centre) checked_finite("centre", c);
}

Vector3 RigidModes::displacement(int mode, const Vector3& x) const {
  require_mode(mode);
  return basis(x).col(mode);
}

Matrix3 RigidModes::gradient(int mode) const {
  require_mode(mode);
  return mode < 3 ? Matrix3::Zero() : cross_matrix(Vector3::Unit(mode - 3));
}

RigidModes::Basis RigidModes::basis(const Vector3& x) const {
  Basis result;
  // Column k of the second block is e_k × (x - c), so the block is the matrix of v -> v × (x - c).
  result << Matrix3::Identity(), -cross_matrix(x - centre_);
  return result;
}

}  // namespace fingertip::fem_reference::analytic
