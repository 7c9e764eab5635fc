/// Long hollow cylinder under pressure inside and outside, held at constant length (Lamé 1852).
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// Body a <= r <= b, r² = x² + y², any length along the axis z, plane strain (u_z = 0):
///   u_r = A r + B/r
///   sigma_rr = 2 (lambda + G) A - 2 G B/r²,  sigma_tt = 2 (lambda + G) A + 2 G B/r²,
///   sigma_zz = 2 lambda A (constant),
///   A = (p_i a² - p_o b²) / (2 (lambda + G)(b² - a²)),
///   B = (p_i - p_o) a² b² / (2 G (b² - a²)).
/// Derivation as for the sphere, with r and 1/r as radial solutions; also Timoshenko & Goodier,
/// Theory of Elasticity, section "stress distribution symmetrical about an axis".
///
/// Boundary conditions: traction -p_i n on r = a, -p_o n on r = b; u_z = 0 and no shear on the two
/// ends z = const; no body force. x = 0 and y = 0 are planes of symmetry.
class ThickCylinder : public ElasticField {
 public:
  struct Parameters {
    double inner_radius = 0.0;    ///< a [m], > 0
    double outer_radius = 0.0;    ///< b [m], > a
    double inner_pressure = 0.0;  ///< p_i [Pa], finite, positive pushes
    double outer_pressure = 0.0;  ///< p_o [Pa], finite, positive pushes
  };

  /// Throws meshes::InvalidInput for an invalid rubber or parameters outside their ranges.
  ThickCylinder(const meshes::Rubber& rubber, const Parameters& parameters);

  /// x off the axis, which the body does not contain
  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;

  /// u_r at radius r > 0 [m]
  double radial_displacement(double r) const;
  /// sigma_rr at radius r > 0 [Pa]
  double radial_stress(double r) const;
  /// sigma_tt at radius r > 0 [Pa]
  double hoop_stress(double r) const;
  /// sigma_zz [Pa]
  double axial_stress() const;

 private:
  double lambda_, shear_modulus_;
  double dilation_ = 0.0;  ///< A [-]
  double source_ = 0.0;    ///< B [m²]
};

}  // namespace fingertip::fem_reference::analytic
