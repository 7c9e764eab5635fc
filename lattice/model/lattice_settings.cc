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

double coarsest_spacing(const meshes::Geometry& geometry, ModelKind model) {
  return std::min(geometry.coarsest_spacing(), coarsest_for_bond(geometry, model));
}

std::vector<Violation> LatticeSettings::grid_violations(const meshes::Geometry& geometry) const {
  std::vector<Violation> found;
  if (!(positive(spacing) && spacing <= geometry.coarsest_spacing()))
    found.push_back(meshes::too_coarse(geometry, spacing));
  if (!(offset.allFinite() && offset.cwiseAbs().maxCoeff() <= 1.0)) {
    found.push_back({"lattice.offset", "",
                     "every component of the offset must lie between -1 and 1 spacing",
                     "shift the grid by less"});
  }
  add_ties(found, *this, geometry);
  return found;
}

std::vector<Violation> LatticeSettings::material_violations(const meshes::Rubber& rubber) const {
  std::vector<Violation> found;
  if (model == ModelKind::published && is_rotated(*this))
    found.push_back({"lattice.rotation", "", "the published lattice is aligned with the rod",
                     "leave the rotation at 0, or take another model"});
  const Eigen::Matrix3d defect = axes.transpose() * axes - Eigen::Matrix3d::Identity();
  if (!(axes.allFinite() && defect.cwiseAbs().maxCoeff() < 1e-9 && axes.determinant() > 0.0))
    found.push_back({"lattice.rotation", "",
                     "the grid's directions must be orthonormal and right-handed",
                     "give three angles, or a rotation matrix"});
  if (model == ModelKind::network) {  // takes G and lambda from the rubber
    const double nu = rubber.poissons_ratio();
    if (kinematics == Kinematics::finite && nu < -1e-12)
      found.push_back({"rubber.youngs_modulus", "Poisson's ratio " + meshes::to_text(nu),
                       "the network at finite strain needs Poisson's ratio >= 0: below, its energy "
                       "falls without bound as a cell collapses",
                       "take lattice.kinematics = small, or another rubber"});
    return found;
  }
  const SpringConstants& k = constants;
  const double needed = model == ModelKind::published ? k.k1 + k.k2 + k.k3 : k.k2 + k.k3;
  if (!(not_negative(k.k1) && not_negative(k.k2) && not_negative(k.k3) && needed > 0.0 &&
        std::isfinite(k.kappa))) {
    found.push_back({"lattice.constants",
                     "k1 " + meshes::to_text(k.k1) + ", k2 " + meshes::to_text(k.k2) + ", k3 " +
                         meshes::to_text(k.k3) + " N/m",
                     "spring constants must be finite and not negative, and some diagonal must "
                     "resist shear",
                     "use the model's closed form or a calibration"});
  }
  return found;
}

std::vector<Violation> LatticeSettings::violations(const meshes::Geometry& geometry,
                                                   const meshes::Rubber& rubber) const {
  std::vector<Violation> found = grid_violations(geometry);
  append(found, material_violations(rubber));
  if (model == ModelKind::hookean && kinematics == Kinematics::finite && constants.kappa < 0.0)
    found.push_back({"lattice.kinematics", "finite",
                     "hookean at finite strain needs kappa >= 0 (Poisson's ratio >= 1/4): below, a "
                     "cell gains energy by any change of volume",
                     "take the model network, or lattice.kinematics = small"});
  return found;
}

}  // namespace fingertip::lattice::inline model
