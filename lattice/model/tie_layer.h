/// What a tie to the plane is made of: a layer of the rubber.
#pragma once

#include "lattice/kernels/tie_law.h"
#include "meshes/rubber/strain_energy.h"

namespace fingertip::lattice::inline model {

/// Stiffness of the ties to rod and plane per area over C44/a. Softer ties are felt, stiffer ones
/// lock the lattice (lattice/MEASUREMENTS.md).
inline constexpr double tie_stiffness = 160.0;
/// Depth of a tie's layer at which its law is measured, over its thickness; also the deepest
/// compression at which laws are known to be stable (meshes::StrainEnergy::violations).
inline constexpr double layer_depth = 0.5;
/// Largest stiffness of a tie over that at rest: stiffer ones would lock the lattice where a law
/// has a limit.
inline constexpr double stiffest_tie = 16.0;

/// The law of ties that are layers of an incompressible rubber in uniaxial compression, as thick
/// as their stiffness of rest says: E = 3 G of a layer L makes E/L = tie_stiffness G/a per area, so
/// L = 3 a/tie_stiffness, whatever the moduli. With t(l) the nominal stress at the stretch l
///
///   t(1 - x) ~ E x (1 + b x²),  x = d/L,  b such that it is exact at x = layer_depth,
///
/// for the neo-Hookean law b = 16/3, which is within 6 % of it before that. Deeper the tangent of x
/// = layer_depth, 5 E, is kept, so that no trial step meets a wall and the inertia that bounds a
/// tie has a bound itself. `spacing` a > 0 [m].
TieLaw layer_law(const meshes::StrainEnergy& energy, double spacing);

}  // namespace fingertip::lattice::inline model
