/// Hollow sphere under pressure inside and outside (Lamé 1852).
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// Body a <= r <= b, r = |x|, of a material with bulk modulus K and shear modulus G:
///   u = (A + B/r³) x
///   sigma_rr = 3 K A - 4 G B/r³,  sigma_tt = 3 K A + 2 G B/r³ (both tangential directions)
///   A = (p_i a³ - p_o b³) / (3 K (b³ - a³)),  B = (p_i - p_o) a³ b³ / (4 G (b³ - a³)).
/// Derivation: a radial u(r) has grad div u = 0, whose solutions are r and 1/r²; the two constants
/// follow from the pressures. Also Timoshenko & Goodier, Theory of Elasticity,
/// section "spherical container under internal or external uniform pressure".
///
/// Boundary conditions: traction -p_i n on r = a and -p_o n on r = b; no body force. The planes
/// x = 0, y = 0, z = 0 are planes of symmetry, so an octant with sliding faces is the same problem.
class ThickSphere : public ElasticField {
 public:
  struct Parameters {
    double inner_radius = 0.0;    ///< a [m], > 0
    double outer_radius = 0.0;    ///< b [m], > a
    double inner_pressure = 0.0;  ///< p_i [Pa], finite, positive pushes
    double outer_pressure = 0.0;  ///< p_o [Pa], finite, positive pushes
  };

  /// Throws meshes::InvalidInput for an invalid rubber or parameters outside their ranges.
  ThickSphere(const meshes::Rubber& rubber, const Parameters& parameters);

  /// x != 0, which the body does not contain
  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;

  /// u_r at radius r > 0 [m]
  double radial_displacement(double r) const;
  /// sigma_rr at radius r > 0 [Pa]
  double radial_stress(double r) const;
  /// sigma_tt at radius r > 0 [Pa]
  double tangential_stress(double r) const;

 private:
  double bulk_modulus_, shear_modulus_;
  double dilation_ = 0.0;  ///< A [-]
  double source_ = 0.0;    ///< B [m³]
};

}  // namespace fingertip::fem_reference::analytic
