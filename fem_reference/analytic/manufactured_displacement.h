/// Smooth displacements, and the body forces under which they are in equilibrium: one without any
/// symmetry, one of a body of revolution.
#pragma once

#include <array>
#include <vector>

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// f(t) = sin(rate t + phase) or exp(rate t), a factor of a product.
struct Factor {
  enum class Kind { sine, exponential };
  Kind kind = Kind::sine;
  double rate = 0.0;
  double phase = 0.0;

  /// n-th derivative at t, n >= 0
  double derivative(int n, double t) const;
};

/// f(x) g(y) h(z), and its mixed derivatives.
using Product = std::array<Factor, 3>;

/// Method of manufactured solutions: u is chosen and the load follows from it. With products v_i
/// and Psi_i of sines and exponentials, each of its own wave number,
///   general:              u = v
///   nearly_solenoidal:    u = curl Psi + G/(lambda + G) v
/// with body force
///   f = -div sigma(u) = -G Laplace(u) - (lambda + G) grad div u.
/// In the second variant lambda div u and f stay bounded and do not vanish as nu -> 1/2, so that
/// errors which grow are the method's (locking), not the problem's; the limit is a Stokes flow with
/// pressure. lambda div u is computed from v alone, without cancellation.
///
/// Boundary conditions: whatever displacement() or traction() say on the surface of any body. Use
/// on bodies whose size is of the order of `length`; wave numbers are 0.25 to 1.9 per length.
/// Source: Roache, J. Fluids Eng. 124 (2002) 4, for the method; the fields are the project's.
class ManufacturedDisplacement : public ElasticField {
 public:
  enum class Variant { general, nearly_solenoidal };

  /// `length` [m] > 0 stretches the field, `amplitude` [m], finite, is the size of u.
  /// Throws meshes::InvalidInput for an invalid rubber or arguments outside their ranges.
  ManufacturedDisplacement(const meshes::Rubber& rubber, double length, double amplitude,
                           Variant variant = Variant::general);

  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;
  Vector3 body_force(const Vector3& x) const override;

  /// div u [-]
  double dilatation(const Vector3& x) const;

 private:
  using Orders = std::array<int, 3>;
  /// Derivative of u_i / amplitude with respect to x / length, `orders` times along each axis.
  double partial(int i, const Orders& orders, const Vector3& x) const;

  meshes::Rubber rubber_;
  double length_, amplitude_;
  bool solenoidal_part_;      ///< curl Psi is present
  double compressible_part_;  ///< factor of v
};

/// A smooth displacement that leaves every meridian in its plane, and its body force. With
/// s = (x² + y²)/length² and t = z/length,
///   u_r = amplitude r/length sin(1.3 t + 0.4) exp(-0.6 s),
///   u_z = amplitude sin(1.7 t + 0.2) exp(0.5 s).
/// Arguments and use as above.
class ManufacturedRevolution : public ElasticField {
 public:
  ManufacturedRevolution(const meshes::Rubber& rubber, double length, double amplitude);

  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;
  Vector3 body_force(const Vector3& x) const override;

 private:
  meshes::Rubber rubber_;
  double length_, amplitude_;
};

}  // namespace fingertip::fem_reference::analytic
