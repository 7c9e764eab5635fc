#include "lattice/model/lattice_settings.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline model {
namespace {

using meshes::Violation;

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}
bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

bool is_rotated(const LatticeSettings& settings) {
  return !settings.axes.isIdentity(1e-12);
}

/// Grids and rubbers that a model does not stand.
void add_model(std::vector<Violation>& found, const LatticeSettings& l,
               const meshes::Rubber& rubber) {
  if (l.model == ModelKind::published && is_rotated(l))
    found.push_back({"lattice.rotation", "", "the published lattice is aligned with the rod",
                     "leave the rotation at 0, or take another model"});
  for (const Violation& violation : rotation_violations(l.axes)) found.push_back(violation);
  const double nu = rubber.poissons_ratio();
  if (l.model == ModelKind::network && l.kinematics == Kinematics::finite && nu < -1e-12)
    found.push_back({"rubber.youngs_modulus", "Poisson's ratio " + meshes::to_text(nu),
                     "the network at finite strain needs Poisson's ratio >= 0: below, its energy "
                     "falls without bound as a cell collapses",
                     "take lattice.kinematics = small, or another rubber"});
  if (l.model == ModelKind::hookean && l.kinematics == Kinematics::finite &&
      l.constants.kappa < 0.0)
    found.push_back({"lattice.kinematics", "finite",
                     "hookean at finite strain needs kappa >= 0 (Poisson's ratio >= 1/4): below, a "
                     "cell gains energy by any change of volume",
                     "take the model network, or lattice.kinematics = small"});
}

/// The bond's area shrinks with the rod; a thread through a cell holds nothing.
double coarsest_for_bond(const meshes::Geometry& geometry, ModelKind model) {
  return model != ModelKind::published && geometry.is_dome()
             ? 10.0 * geometry.rod_radius
             : std::numeric_limits<double>::infinity();
}

/// Ties to rod and plane. Within these factors forces are those of nearly rigid or of soft ties;
/// far beyond, round-off of the ties hides what the rubber does.
void add_ties(std::vector<Violation>& found, const LatticeSettings& l,
              const meshes::Geometry& geometry) {
  constexpr double least = 1e-3, most = 1e3;
  const auto within = [](double value) { return value >= least && value <= most; };
  if (!within(l.ligament_stiffness))
    found.push_back({"lattice.ligament_stiffness", meshes::to_text(l.ligament_stiffness),
                     "the factor on the bond must lie between 0.001 and 1000",
                     "1 is the standard bond"});
  if (!within(l.contact_stiffness))
    found.push_back({"lattice.contact_stiffness", meshes::to_text(l.contact_stiffness),
                     "the factor on the ties to the plane must lie between 0.001 and 1000",
                     "1 is the standard tie"});
  if (l.contact_stiffness != 1.0 && l.model == ModelKind::published)
    found.push_back({"lattice.contact_stiffness", meshes::to_text(l.contact_stiffness),
                     "only lattices with true surfaces have penalty contact with the plane",
                     "take another model, or leave it at 1"});
  if (l.spacing > coarsest_for_bond(geometry, l.model))
    found.push_back({"lattice.spacing", meshes::to_text(l.spacing) + " m",
                     "the spacing must be at most ten times the rod's radius, or the bond does not "
                     "hold the rubber",
                     "choose a finer lattice, or a thicker rod"});
}

}  // namespace

std::vector<Violation> rotation_violations(const Eigen::Matrix3d& axes) {
  const Eigen::Matrix3d defect = axes.transpose() * axes - Eigen::Matrix3d::Identity();
  if (axes.allFinite() && defect.cwiseAbs().maxCoeff() < 1e-9 && axes.determinant() > 0.0)
    return {};
  return {{"lattice.rotation", "", "the grid's directions must be orthonormal and right-handed",
           "give three angles, or a rotation matrix"}};
}

double coarsest_spacing(const meshes::Geometry& geometry, ModelKind model) {
  return std::min(geometry.coarsest_spacing(), coarsest_for_bond(geometry, model));
}

std::vector<Violation> LatticeSettings::violations(const meshes::Geometry& geometry,
                                                   const meshes::Rubber& rubber) const {
  const LatticeSettings& l = *this;
  std::vector<Violation> found;
  if (!(positive(l.spacing) && l.spacing <= geometry.coarsest_spacing()))
    found.push_back(meshes::too_coarse(geometry, l.spacing));
  if (!(l.offset.allFinite() && l.offset.cwiseAbs().maxCoeff() <= 1.0)) {
    found.push_back({"lattice.offset", "",
                     "every component of the offset must lie between -1 and 1 spacing",
                     "shift the grid by less"});
  }
  add_model(found, l, rubber);
  const SpringConstants& k = l.constants;
  const double needed = l.model == ModelKind::published ? k.k1 + k.k2 + k.k3 : k.k2 + k.k3;
  const bool springs = not_negative(k.k1) && not_negative(k.k2) && not_negative(k.k3) &&
                       needed > 0.0 && std::isfinite(k.kappa);
  // The network takes G and lambda from the rubber.
  if (l.model != ModelKind::network && !springs) {
    found.push_back(
        {"lattice.constants",
         "k1 " + meshes::to_text(k.k1) + ", k2 " + meshes::to_text(k.k2) + ", k3 " +
             meshes::to_text(k.k3) + " N/m",
         "spring constants must be finite and not negative, and some diagonal must resist "
         "shear",
         "use the model's closed form or a calibration"});
  }
  add_ties(found, l, geometry);
  return found;
}

}  // namespace fingertip::lattice::inline model
