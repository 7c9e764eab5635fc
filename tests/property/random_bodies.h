/// Random bodies of the lattice at equilibrium, free blocks and tips of every shape cut at R/6, of
/// every model.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <random>

#include "lattice/model/model.h"
#include "lattice/statics/cut_lattice.h"
#include "tests/fingers.h"
#include "tests/property/random_numbers.h"

namespace fingertip::random {

using Eigen::VectorXd;
using lattice::Kinematics;
using lattice::LatticeBody;
using lattice::LatticeSettings;
using lattice::ModelKind;
using meshes::Geometry;
using meshes::Rubber;
using meshes::Vector3;

/// Any Poisson's ratio that the model stands.
inline Rubber random_rubber_for(const LatticeSettings& settings) {
  const bool bounded =
      settings.model == ModelKind::network && settings.kinematics == Kinematics::finite;
  return random_rubber(bounded ? 0.0 : -0.95);
}

inline LatticeSettings random_model() {
  LatticeSettings settings;
  settings.model = *rc::gen::element(ModelKind::published, ModelKind::central, ModelKind::hookean,
                                     ModelKind::network);
  settings.kinematics = *rc::gen::element(Kinematics::small, Kinematics::finite);
  return settings;
}

/// Springs that are not isotropic as a rule; kappa of either sign.
inline void give_constants(LatticeSettings& settings, const Rubber& rubber, double spacing) {
  settings.spacing = spacing;
  const double unit = rubber.shear_modulus * spacing;
  settings.constants = lattice::hookean_constants(rubber, spacing, uniform(0.0, 0.74) * unit);
  settings.constants.k1 *= uniform(0.5, 2.0);
  if (settings.model == ModelKind::published)
    settings.constants = lattice::published_constants(rubber, spacing);
}

inline LatticeBody block_of(const Rubber& rubber, const LatticeSettings& settings,
                            const std::array<int, 3>& cells) {
  if (settings.model != ModelKind::published)
    return lattice::build_free_block(rubber, settings, cells);
  return lattice::body_of(
      lattice::build_block(settings.model, settings.kinematics, settings.constants,
                           settings.spacing, cells, rubber.density, 0.0),
      Geometry(), rubber);
}

/// Thick and thin layers, short sleeves (long ones have more of the same cells).
inline Geometry random_dome(double size) {
  Geometry geometry;
  geometry.tip_radius = size;
  geometry.rod_radius = uniform(0.1, 0.666) * size;
  geometry.sleeve_length = std::max(0.0, uniform(-0.1, 0.5)) * size;
  geometry.rod_length = 2.0 * size;
  return geometry;
}

/// A cylinder, glued at its base, with a cap that is flat or pointed.
inline Geometry random_profile(double size) {
  using enum meshes::ProfileSurface;
  using enum meshes::ProfileCurve;
  const double height = uniform(0.5, 1.5) * size, top = height + uniform(0.3, 1.0) * size;
  return Geometry::of_profile({{size, 0.0, contact, straight},
                               {size, height, contact, straight},
                               {uniform(0.4, 0.8) * size, 0.5 * (height + top), contact, spline},
                               {0.0, top, axis, straight},
                               {0.0, 0.0, bond, straight}});
}

/// Facets: the same without a curve, oval and aslant.
inline Geometry random_solid(double size) {
  const double height = uniform(0.5, 1.5) * size, top = height + uniform(0.3, 1.0) * size,
               wide = uniform(0.7, 1.0), lean = uniform(-0.2, 0.2);
  auto mesh =
      fingers::revolved({{0.0, 0.0}, {size, 0.0}, {size, height}, {0.0, top}}, integer(4, 12));
  for (Vector3& w : mesh.vertices) w = Vector3(w.x() + lean * w.z(), wide * w.y(), w.z());
  const meshes::Region held{{{2, true, uniform(0.01, 0.3) * height}}};
  return Geometry::of_solid(std::make_shared<meshes::Solid>(mesh, held), -size);
}

inline Geometry random_geometry() {
  const double size = std::pow(10.0, uniform(-3.0, -1.0));
  switch (integer(0, 3)) {
    case 0: return random_dome(size);
    case 1: return random_profile(size);
    default: return random_solid(size);
  }
}

inline LatticeBody tip_of(const Geometry& geometry, const Rubber& rubber,
                          const LatticeSettings& settings) {
  if (settings.model != ModelKind::published)
    return lattice::build_cut_tip(geometry, rubber, settings, 1);
  return lattice::body_of(lattice::build_published_tip(geometry, rubber, settings), geometry,
                          rubber);
}

struct Specimen {
  Geometry geometry;
  double spacing = 0.0;
  LatticeBody body;
};

inline Specimen random_tip(LatticeSettings settings) {
  Specimen specimen;
  specimen.geometry = random_geometry();
  specimen.spacing =
      std::min(specimen.geometry.tip_radius / 6.0, specimen.geometry.coarsest_spacing());
  const Rubber rubber = random_rubber_for(settings);
  give_constants(settings, rubber, specimen.spacing);
  settings.offset = random_vector(1.0);
  // A meridian is cut by a grid along its axis alone.
  const bool may_turn = settings.model != ModelKind::published && specimen.geometry.profile.empty();
  if (may_turn) settings.axes = random_rotation();
  specimen.body = tip_of(specimen.geometry, rubber, settings);
  return specimen;
}

inline std::array<int, 3> random_cells() {
  return {integer(1, 5), integer(1, 4), integer(1, 4)};
}

inline Specimen random_block(LatticeSettings settings) {
  Specimen specimen;
  specimen.spacing = std::pow(10.0, uniform(-4.0, -2.0));
  const Rubber rubber = random_rubber_for(settings);
  give_constants(settings, rubber, specimen.spacing);
  settings.axes = random_rotation();
  specimen.body = block_of(rubber, settings, random_cells());
  return specimen;
}

/// One in three is a tip: these take a hundred times as long.
inline Specimen random_specimen() {
  const LatticeSettings settings = random_model();
  return integer(0, 3) == 2 ? random_tip(settings) : random_block(settings);
}

/// Without the bond nothing holds it.
inline Specimen random_free_specimen() {
  Specimen specimen = random_specimen();
  specimen.body.bond.clear();
  return specimen;
}

/// A vector per particle, components within ± size.
inline VectorXd random_field(const LatticeBody& body, double size) {
  std::mt19937 engine(std::uint32_t(integer(0, 1000000000)));
  std::uniform_real_distribution<double> component(-size, size);
  return VectorXd::NullaryExpr(body.unknowns(), [&] { return component(engine); });
}

/// A strong homogeneous deformation of a body whose particles are shaken by up to a tenth of a
/// spacing. It turns no cell inside out: the columns of a mean gradient in the grid's directions
/// are means of edge differences over a, so the shaking's norm is at most 0.6, and the homogeneous
/// part is diagonally dominant.
inline VectorXd random_displacement(const Specimen& specimen) {
  const LatticeBody& body = specimen.body;
  const Matrix3d F = Matrix3d::Identity() + random_matrix(0.2);
  VectorXd u = random_field(body, 0.1 * specimen.spacing);
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    auto of_particle = u.segment<3>(3 * Eigen::Index(p));
    of_particle = (F * (body.rest[p] + of_particle) - body.rest[p]).eval();
  }
  return u;
}

}  // namespace fingertip::random
