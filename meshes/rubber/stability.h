/// Which laws are a rubber's: the rules of a strain energy, and where it stops being stable.
#pragma once

#include <optional>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/names.h"
#include "meshes/rubber/strain_energy.h"

namespace fingertip::meshes::inline rubber {

/// Broken rules of a shape: numbers finite, exponents not 0, Jm > 0, shares that sum to 1, stable
/// between the stretches 0.5 and 2.
std::vector<Violation> violations(const StrainEnergy& energy);

/// Tests on sheets: one, two, or one of two directions pulled.
enum class SheetTest { uniaxial, equibiaxial, planar };
constexpr auto names_of(SheetTest) {
  using enum SheetTest;
  return names<SheetTest>(
      {{uniaxial, "uniaxial"}, {equibiaxial, "equibiaxial"}, {planar, "planar"}});
}

/// Where an incompressible law stops being stable (Drucker): dsigma:d(ln l) > 0 for every change
/// fails.
struct Instability {
  SheetTest test = SheetTest::uniaxial;
  double stretch = 1.0;  ///< along the first direction
};
/// The one nearest to rest between the stretches `shortest` < 1 and `longest` > 1.
std::optional<Instability> first_instability(const StrainEnergy& energy, double shortest,
                                             double longest);

}  // namespace fingertip::meshes::inline rubber
