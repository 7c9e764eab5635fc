/// What the exact solutions of linear elasticity have in common: a displacement, its gradient, the
/// stress that belongs to it and the body force that keeps it in equilibrium.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::analytic {

using Matrix3 = Eigen::Matrix3d;
using meshes::Vector3;

/// Hooke's law of the isotropic body, sigma = lambda tr(e) I + 2 G e with e the symmetric part of
/// `gradient` [-]; result in Pa, symmetric.
Matrix3 hooke_stress(const meshes::Rubber& rubber, const Matrix3& gradient);

/// An exact small-strain solution, -div sigma = body_force with sigma from Hooke's law. SI, or any
/// consistent units. Positions [m] are Cartesian; outside the body described by the derived class
/// the formulas are continued and remain a solution, so that points on the straight edge of a
/// mesh that cuts a corner may be evaluated.
class ElasticField {
 public:
  virtual ~ElasticField() = default;

  /// u(x) [m]
  virtual Vector3 displacement(const Vector3& x) const = 0;
  /// Row i, column j: du_i/dx_j at x [-]
  virtual Matrix3 gradient(const Vector3& x) const = 0;
  /// sigma(x) [Pa], symmetric, tension positive
  virtual Matrix3 stress(const Vector3& x) const = 0;
  /// Force per volume [N/m³]; zero unless a derived class says otherwise
  virtual Vector3 body_force(const Vector3& x) const;
  /// sigma(x) n, force per area on a surface with outward unit normal n [Pa]
  Vector3 traction(const Vector3& x, const Vector3& normal) const { return stress(x) * normal; }

 protected:
  ElasticField() = default;
  ElasticField(const ElasticField&) = default;
  ElasticField& operator=(const ElasticField&) = default;
};

/// `rubber` itself, if it is valid. Throws meshes::InvalidInput with its violations.
const meshes::Rubber& checked(const meshes::Rubber& rubber);

/// Throws meshes::InvalidInput naming `key`, `value` and `rule` unless `holds`.
void require(bool holds, std::string_view key, double value, std::string_view rule);

/// `value`, if it is finite and positive. Throws meshes::InvalidInput otherwise.
double checked_positive(std::string_view key, double value);

/// `value`, if it is finite. Throws meshes::InvalidInput otherwise.
double checked_finite(std::string_view key, double value);

}  // namespace fingertip::fem_reference::analytic
