/// The numbers that turn a cubic grid into rubber: spring constants per class and volume constant.
#pragma once

#include "meshes/base/names.h"
#include "meshes/rubber/rubber.h"

namespace fingertip::lattice::inline model {

/// What a cell of the lattice is (README of model/: physics of each).
enum class ModelKind {
  published,  ///< Reznik & Laugier 1996 as printed: central springs k = E/l0, each counted fully
  central,    ///< central springs fitted to the moduli, weighted by the cells that share them
  hookean,    ///< a cell with a strain energy of its mean displacement gradient, and fibres along
              ///< its edges against hourglass modes; at small strain it has the moduli of central
              ///< springs k1, k2, k3 with a volume constant kappa: exact E, G, nu
  network,    ///< the same at finite strain, with a neo-Hookean energy
};
using meshes::name, meshes::values;
constexpr auto names_of(ModelKind) {
  using enum ModelKind;
  return meshes::names<ModelKind>(
      {{published, "published"}, {central, "central"}, {hookean, "hookean"}, {network, "network"}});
}

/// How deformation is measured.
enum class Kinematics {
  small,   ///< springs and cells see the displacement, linearised about the rest state
  finite,  ///< springs see their true length, cells their true volume
};
constexpr auto names_of(Kinematics) {
  using enum Kinematics;
  return meshes::names<Kinematics>({{small, "small"}, {finite, "finite"}});
}

/// Stiffness per class of neighbour. Axis springs have rest length a, face diagonals a√2, body
/// diagonals a√3.
struct SpringConstants {
  double k1 = 0.0;     ///< axis springs [N/m]
  double k2 = 0.0;     ///< face diagonals [N/m]
  double k3 = 0.0;     ///< body diagonals [N/m]
  double kappa = 0.0;  ///< volume constant of a cell, U = kappa (V - V0)²/(2 V0) [Pa]
};

/// The published rule k = E/l0 in its lattice reading, k = E a²/l0: read literally it is a
/// stiffness per area, and the effective modulus would grow like 1/a². `spacing` a > 0 [m].
SpringConstants published_constants(const meshes::Rubber& rubber, double spacing);

/// Constants of the hookean model: kappa = lambda - G, k1 = aG + 4/3 k3, k2 = aG - 4/3 k3, exact
/// and isotropic for every -1 < nu < 1/2 and 0 <= k3 < 3aG/4 [N/m] (derivation:
/// calibration/material/README.md). `spacing` a > 0 [m]; the rubber must be valid, which is not
/// checked.
SpringConstants hookean_constants(const meshes::Rubber& rubber, double spacing, double k3 = 0.0);

/// C44 of the infinite lattice, (k2 + 4/3 k3)/a [Pa] (calibration/material/README.md). `spacing` a
/// > 0 [m].
double shear_stiffness(const SpringConstants& constants, double spacing);

}  // namespace fingertip::lattice::inline model
