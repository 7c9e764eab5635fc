/// The lattice of the tip as it is built once and then only read: where particles and cells are,
/// what they weigh, how stiff and how viscous their connections are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/constants.h"
#include "lattice/settings.h"
#include "lattice/stencil.h"
#include "meshes/cubic_grid.h"
#include "meshes/geometry.h"
#include "meshes/rubber.h"

namespace fingertip::lattice {

/// A ligament: an isotropic spring with zero force at rest between a particle and the point of the
/// rigid rod (extended beyond its surface) that coincides with the particle at rest.
/// Energy ½ k |x_p - T(X_p)|², T the rod's pose (README: bond).
struct Ligament {
  std::size_t particle = 0;                        ///< grid index
  meshes::Vector3 rest = meshes::Vector3::Zero();  ///< X_p [m]
  double stiffness = 0.0;                          ///< k [N/m]
  double damping = 0.0;                            ///< mu [N s/m]
};

/// Immutable after construction. All arrays named "per point" run over the grid's points, x
/// fastest, plus `lanes` padding zeros at the end; the grid keeps one layer of empty points around
/// the particles, so that every neighbour index of a particle exists.
struct LatticeModel {
  ModelKind kind = ModelKind::hookean;
  Kinematics kinematics = Kinematics::small;
  SpringConstants constants;
  meshes::CubicGrid grid;

  std::vector<std::uint8_t> is_particle;  ///< per point: 1 where a particle sits
  std::vector<double> mass;               ///< per point [kg], 0 where there is no particle
  std::vector<double> inverse_mass;       ///< per point [1/kg], 0 where there is no particle
  /// Per direction of the half stencil and point: how much of the spring from the point to its
  /// neighbour exists (1 = a full spring k of its class, 0 = none).
  std::array<std::vector<double>, directions> weight;
  /// Per point: 1 if the cell whose lowest corner is the point is part of the body; empty for
  /// models without cells.
  std::vector<double> cell_weight;

  std::array<double, 3> stiffness{};  ///< k per class [N/m]
  std::array<double, 3> damping{};    ///< mu per class [N s/m]
  double volume_stiffness = 0.0;      ///< kappa [Pa]
  double volume_damping = 0.0;        ///< viscous counterpart of kappa [Pa s]
  /// tau = mu/k [s] where it is the same for springs and cells (Kelvin-Voigt); else 0, and the
  /// dampers are per class.
  double retardation_time = 0.0;
  bool proportional_damping = false;  ///< whether mu = tau k throughout

  std::vector<std::uint32_t> particles;    ///< grid indices of the particles, increasing
  std::vector<std::uint32_t> cells;        ///< grid indices of the cells' lowest corners
  std::vector<std::uint32_t> blocks;       ///< first points of the runs of `lanes` points that
                                           ///< cover every particle once
  std::vector<std::uint32_t> cell_blocks;  ///< the same for the cells
  std::vector<Ligament> ligaments;
  /// Particles of the outer skin: fewer than 26 neighbours and nearer to the outer surface than
  /// to the rod. Candidates for contact.
  std::vector<std::uint32_t> boundary;

  std::size_t points() const { return is_particle.size(); }  ///< including the padding
  double spacing() const { return grid.spacing; }            ///< a [m]
  double rest_length(Family family) const;                   ///< l0 [m]
  meshes::Vector3 rest_position(std::size_t point) const;    ///< X [m]
  double total_mass() const;                                 ///< [kg]
  std::size_t spring_count() const;
  bool has_volume_term() const { return volume_stiffness != 0.0; }
};

/// The tip's lattice. Particles and cells by the model's rule (README: sampling). Throws
/// InvalidInput for a spacing or offset outside their ranges or constants that are not finite.
LatticeModel build_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                       const LatticeSettings& settings);

/// A free block of cells[0] x cells[1] x cells[2] whole cells with its lowest corner at the
/// origin, without ligaments and boundary. `retardation_time` gives the Kelvin-Voigt dampers of
/// central and hookean; published takes the paper's rule.
LatticeModel build_block(ModelKind kind, Kinematics kinematics, const SpringConstants& constants,
                         double spacing, const std::array<int, 3>& cells, double density,
                         double retardation_time);

}  // namespace fingertip::lattice
