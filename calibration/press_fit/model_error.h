/// What a lattice is known to miss of the continuum, as a covariance of the forces it answers for.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/base/names.h"

namespace fingertip::calibration::inline press_fit {

/// Covariance of the relative errors of the static lattice's forces against the continuum of its
/// own kinematics, for all `presses` in order: a row and a column per sample of
/// PressProtocol::samples. The sizes are those of lattice::ForceEstimator, which cover 95 %,
/// halved:
///   contact  of masses where they touch, correlated over xi = sqrt(R d)/a, the cells under the
///            contact's radius, by exp(-|xi - xi'|/0.5): the patch grows by rings of cells, so that
///            the error swings once per cell and has kinks where ties begin to touch; common to
///            presses of one spacing, geometry and direction, on the same cells,
///   inside   across the wall, and of the ties: one number for all.
/// Of `central` they are those of cells, for what its springs cannot be is fitted. Nothing of
/// `published`. They are errors of known size and unknown value: their signs, mostly positive, are
/// not used.
Eigen::MatrixXd lattice_covariance(const std::vector<lattice::PressSetup>& presses);

/// By how much forces of law A exceed those of small strain under `press`, relative, at every
/// sample: by static lattices of five cells through the thickness, whose own errors nearly cancel
/// in the ratio (within 1.3 % of the force at 0.05 cm of the default finger, from 0.1 cm on within
/// 1 % of the force and 4 % of the excess). Between at most eight computed depths linear. Poisson's
/// ratio is the setup's rubber's, but at least 0. Throws as run_static_press does.
Eigen::VectorXd excess_of_finite_strain(lattice::PressSetup press);

/// By how much forces under the other contact exceed those under `press`'s own, relative, at every
/// sample, in the same way by its own theory of strain: sticking instead of frictionless or of
/// Coulomb's, and frictionless instead of sticking.
Eigen::VectorXd excess_of_other_contact(lattice::PressSetup press);

/// A number that a press is described by and that is known within a tolerance.
enum class Described {
  scale,  ///< of the whole finger, 1 as described
  tip_radius,
  rod_radius,
  obstacle_radius,
  obstacle_offset,
  tilt,
  poissons_ratio,
};
constexpr auto names_of(Described) {
  using enum Described;
  return meshes::names<Described>({{scale, "scale"},
                                   {tip_radius, "tip_radius"},
                                   {rod_radius, "rod_radius"},
                                   {obstacle_radius, "obstacle_radius"},
                                   {obstacle_offset, "obstacle_offset"},
                                   {tilt, "tilt"},
                                   {poissons_ratio, "poissons_ratio"}});
}
using meshes::name, meshes::values;

/// SI.
constexpr const char* unit_of(Described what) {
  switch (what) {
    case Described::scale:
    case Described::poissons_ratio: return "1";
    case Described::tilt: return "rad";
    default: return "m";
  }
}

/// Whether the press has it: radii of the finger are a dome's, the obstacle's those of what is
/// curved.
bool has(const lattice::PressSetup& press, Described what);
/// As described [m, rad, 1].
double value_of(const lattice::PressSetup& press, Described what);
/// By how much the forces of `press` at E as described change where the number, which it has, goes
/// from `low` to `high`, over those as described, at every sample: by coarse lattices as above, at
/// small or large strain and so many depths, before the first constant. A scaled finger is the
/// finger under scaled depths and obstacles, F = s² F(d/s). Of a ball of 8 mm on the default
/// finger, 0.5 to 1.5 mm deep, within 26 % of what continua say, of Poisson's ratio 10 %. Throws as
/// run_static_press does, InvalidInput for a press that cannot be.
Eigen::VectorXd change_between(lattice::PressSetup press, Described what, double low, double high,
                               lattice::Kinematics kinematics = lattice::Kinematics::small,
                               std::size_t depths = 3);

}  // namespace fingertip::calibration::inline press_fit
