#include "lattice/model/tie_layer.h"

#include <algorithm>
#include <cmath>

#include "meshes/rubber/law_terms.h"

namespace fingertip::lattice::inline model {

TieLaw layer_law(const meshes::StrainEnergy& energy, double spacing) {
  const double stretch = 1.0 - layer_depth, across = 1.0 / std::sqrt(stretch);
  const meshes::PrincipalResponse<double> pressed =
      meshes::principal_response(energy, {stretch, across, across});
  const double stress = (pressed.kirchhoff[1] - pressed.kirchhoff[0]) / stretch;  // over G
  const double largest = (stiffest_tie - 1.0) / (3.0 * layer_depth * layer_depth);
  // A law beyond its limit stores infinite energy.
  const double growth = std::isfinite(pressed.energy)
                            ? (stress / (3.0 * layer_depth) - 1.0) / (layer_depth * layer_depth)
                            : largest;
  const double thickness = 3.0 * spacing / tie_stiffness;
  return {std::clamp(growth, 0.0, largest) / (thickness * thickness), layer_depth * thickness};
}

}  // namespace fingertip::lattice::inline model
