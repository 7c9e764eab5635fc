/// End-loaded plate in plane strain as an exact three-dimensional solution. Its displacement is a
/// cubic polynomial without any singularity, so that a finite element method must converge at its
/// full order, and elements of degree 3 on a mesh with straight faces must reproduce it to
/// round-off. It satisfies equilibrium everywhere: any other body, e.g. a box, may be loaded by its
/// traction(), too.
#pragma once

#include "fem_reference/analytic/elastic_field.h"

namespace fingertip::fem_reference::analytic {

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
/// traction(x, ±e_x) on the ends. The root x = 0 warps (F - s z), as it must in an exact solution:
/// prescribe displacement() there, or the traction and six pins. The rigid-body motion is chosen
/// such that mean displacement and mean rotation ∫ z u_x dz / J of the root vanish.
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
