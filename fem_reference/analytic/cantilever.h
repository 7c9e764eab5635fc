/// End-loaded beams as exact three-dimensional solutions: the round bar of Saint-Venant and the
/// rectangular plate in plane strain. Both displacements are cubic polynomials without any
/// singularity, so that a finite element method must converge at its full order, and elements of
/// degree 3 on a mesh with straight faces must reproduce them to round-off.
///
/// (The rectangular bar with free sides is left out on purpose: its Saint-Venant flexure is a
/// Fourier series whose second displacement derivatives grow like log(distance) at the four edges.)
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

/// Round bar, axis along x from x = 0 to L, y² + z² <= R², I = pi R⁴/4, load P in +z at x = L:
///   sigma_xx = -P (L - x) z / I
///   sigma_xz = P (3 + 2 nu)/(8 (1 + nu) I) (R² - z² - (1 - 2 nu)/(3 + 2 nu) y²)
///   sigma_xy = -P (1 + 2 nu)/(4 (1 + nu) I) y z,      sigma_yy = sigma_zz = sigma_yz = 0
///   u_x = P/(E I) (-z (L x - x²/2) + F - s z)
///   u_y = P/(E I) nu (L - x) y z
///   u_z = P/(E I) (L x²/2 - x³/6 + nu (L - x)(z² - y²)/2 + s x)
///   F = z ((3 + 2 nu) R² - y² - z²)/4,  s = (7 + 6 nu) R²/12.
/// Derivation: with sigma_xx from the bending moment, Hooke's law leaves one unknown F(y, z) with
/// Laplace(F) = -2 z and dF/dn given by the free side; on the circle it is the cubic above. The
/// stresses are those of Timoshenko & Goodier, Theory of Elasticity, section "circular
/// cross-section" of the chapter on bending of bars.
///
/// Boundary conditions: side y² + z² = R² free; traction(x, ±e_x) on the two ends, of which the one
/// at x = L is the shear with resultant P and no bending moment. The root x = 0 warps (F - s z), as
/// it must in an exact solution: prescribe displacement() there, or the traction and six pins. The
/// rigid-body motion is chosen such that mean displacement and mean rotation ∫ z u_x dA / I of the
/// root vanish. As the polynomials satisfy equilibrium everywhere, any other body, e.g. a box, may
/// be loaded by their traction() as well.
class Cantilever : public ElasticField {
 public:
  struct Parameters {
    double radius = 0.0;  ///< R [m], > 0
    double length = 0.0;  ///< L [m], > 0, of any ratio to R
    double load = 0.0;    ///< P [N], finite
  };

  /// Throws meshes::InvalidInput for an invalid rubber or parameters outside their ranges.
  Cantilever(const meshes::Rubber& rubber, const Parameters& parameters);

  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;

  /// I = pi R⁴/4 [m⁴]
  double second_moment() const;
  /// kappa = 6 (1 + nu)/(7 + 6 nu), Cowper, J. Appl. Mech. 33 (1966) 335
  double shear_coefficient() const;
  /// Mean of u_z over the section x = L [m], by Timoshenko's beam P L³/(3 E I) + P L/(kappa G A);
  /// with Cowper's coefficient this is exact for the field above.
  double tip_deflection() const;

 private:
  meshes::Rubber rubber_;
  Parameters parameters_;
};

/// Plate of height h in z and any width along y between two smooth rigid walls (u_y = 0), from
/// x = 0 to L, -h/2 <= z <= h/2, load q per unit width in +z at x = L, J = h³/12,
/// E' = E/(1 - nu²), nu' = nu/(1 - nu):
///   sigma_xx = -q (L - x) z / J,  sigma_xz = q (h²/4 - z²)/(2 J),  sigma_yy = nu sigma_xx
///   u_x = q/(E' J) (-z (L x - x²/2) + F - s z),  u_y = 0
///   u_z = q/(E' J) (L x²/2 - x³/6 + nu' ((L - x) z²/2 - L h²/24) + s x)
///   F = nu' z³/6 + (1 + nu')(h² z/4 - z³/3),  s = (8 + 9 nu') h²/40.
/// Source: the plane-stress beam of Timoshenko & Goodier, section 21, which becomes an exact
/// three-dimensional solution once its constants are those of plane strain.
///
/// Boundary conditions: faces z = ±h/2 free; u_y = 0 and no shear on two faces y = const;
/// traction(x, ±e_x) on the ends. The rigid-body motion is chosen as for Cantilever: mean
/// displacement and mean rotation ∫ z u_x dz / J of the root vanish.
class PlaneStrainCantilever : public ElasticField {
 public:
  struct Parameters {
    double height = 0.0;          ///< h [m], > 0
    double length = 0.0;          ///< L [m], > 0, of any ratio to h
    double load_per_width = 0.0;  ///< q [N/m], finite
  };

  /// Throws meshes::InvalidInput for an invalid rubber or parameters outside their ranges.
  PlaneStrainCantilever(const meshes::Rubber& rubber, const Parameters& parameters);

  Vector3 displacement(const Vector3& x) const override;
  Matrix3 gradient(const Vector3& x) const override;
  Matrix3 stress(const Vector3& x) const override;

  /// J = h³/12, per unit width [m³]
  double second_moment() const;
  /// kappa = 10 (1 + nu')/(12 + 11 nu'), Cowper's coefficient of the rectangle in plane strain
  double shear_coefficient() const;
  /// Mean of u_z over the section x = L [m]: q L³/(3 E' J) + q L/(kappa G h), exact
  double tip_deflection() const;

 private:
  double plane_modulus() const;  ///< E' [Pa]
  double plane_ratio() const;    ///< nu'

  meshes::Rubber rubber_;
  Parameters parameters_;
};

}  // namespace fingertip::fem_reference::analytic
