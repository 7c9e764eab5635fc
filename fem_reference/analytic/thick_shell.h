/// Hollow sphere, and long hollow cylinder held at constant length, under pressure inside and
/// outside (Lamé 1852).
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// Body a <= r <= b, with d = 3 for the sphere (r = |x|), d = 2 for the cylinder along z
/// (r² = x² + y², plane strain):
///   u_r = A r + B/r^(d-1),  u_z = 0 of the cylinder
///   sigma_rr = (d lambda + 2G) A - 2 (d - 1) G B/r^d,  sigma_tt = (d lambda + 2G) A + 2 G B/r^d,
///   sigma_zz = 2 lambda A of the cylinder (constant),
///   A = (p_i a^d - p_o b^d) / ((d lambda + 2G)(b^d - a^d)),
///   B = (p_i - p_o) a^d b^d / (2 (d - 1) G (b^d - a^d)).
/// Derivation: a radial u(r) has grad div u = 0, whose solutions are r and 1/r^(d-1); the two
/// constants follow from the pressures. Also Timoshenko & Goodier, Theory of Elasticity, sections
/// "spherical container under internal or external uniform pressure" and "stress distribution
/// symmetrical about an axis".
///
/// Boundary conditions: traction -p_i n on r = a and -p_o n on r = b; of the cylinder u_z = 0 and
/// no shear on two ends z = const; no body force. Planes through the centre or the axis are planes
/// of symmetry, so an octant or a quarter with sliding faces is the same problem.
class ThickShell : public ElasticField {
 public:
  struct Parameters {
    double inner_radius = 0.0;    ///< a [m], > 0
    double outer_radius = 0.0;    ///< b [m], > a
    double inner_pressure = 0.0;  ///< p_i [Pa], finite, positive pushes
    double outer_pressure = 0.0;  ///< p_o [Pa], finite, positive pushes
  };

  /// x off the centre or axis, which the body does not contain
  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;

  double radial_displacement(double r) const;  ///< u_r at radius r > 0 [m]
  double radial_stress(double r) const;        ///< sigma_rr [Pa]
  double hoop_stress(double r) const;          ///< sigma_tt [Pa]

 protected:
  /// `dimensions` d. Throws meshes::InvalidInput for an invalid rubber or parameters outside their
  /// ranges.
  ThickShell(int dimensions, const meshes::Rubber& rubber, const Parameters& parameters);

 private:
  Vector3 from_core(const Vector3& x) const;  ///< from the centre or the axis

  int dimensions_;
  Matrix3 across_;  ///< projects on the directions in which the body moves
  double lambda_, shear_modulus_;
  double dilation_ = 0.0;  ///< A [-]
  double source_ = 0.0;    ///< B [m^d]
};

class ThickSphere : public ThickShell {
 public:
  ThickSphere(const meshes::Rubber& rubber, const Parameters& parameters)
      : ThickShell(3, rubber, parameters) {}
};

class ThickCylinder : public ThickShell {
 public:
  ThickCylinder(const meshes::Rubber& rubber, const Parameters& parameters)
      : ThickShell(2, rubber, parameters) {}
};

}  // namespace fingertip::fem_reference::analytic
