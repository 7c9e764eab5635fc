#include "lattice/statics/cut_lattice.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lattice/statics/grid_cells.h"
#include "lattice/statics/tied_points.h"
#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::lattice {

using meshes::CubicGrid;
using meshes::CutCell;
using meshes::Geometry;
using meshes::Rubber;
using meshes::Surface;
using meshes::SurfacePoint;
using meshes::Vector3;
using meshes::Violation;

namespace {

/// Surface points lie a third of a spacing apart.
constexpr double points_per_spacing = 3.0;
/// The finest lattice: beyond, surface_points has none that near, and the grid would not fit.
constexpr double smallest_spacing = 3.1e-3;  // of R

void check_material(std::vector<Violation>& found, const Rubber& rubber,
                    const LatticeSettings& settings) {
  const std::vector<Violation> of_rubber = rubber.violations();
  found.insert(found.end(), of_rubber.begin(), of_rubber.end());
  if (settings.model == ModelKind::published) {
    found.push_back({"lattice.model", "published", "the published lattice has no cells to cut",
                     "choose central, hookean or network"});
  }
  if (settings.model == ModelKind::network) {
    // The margin keeps round-off in other units than the user's from refusing nu = 0.
    if (settings.kinematics == Kinematics::finite && rubber.poissons_ratio() < -1e-12) {
      found.push_back({"rubber.youngs_modulus", meshes::to_text(rubber.youngs_modulus) + " Pa",
                       "the network at finite strain needs nu >= 0, that is E >= 2G: with a "
                       "negative Lame constant lambda the energy falls without bound as J -> 0",
                       "raise youngs_modulus to 2 shear_modulus or more, or take kinematics "
                       "small"});
    }
    return;
  }
  const SpringConstants& k = settings.constants;
  const auto not_negative = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!(not_negative(k.k1) && not_negative(k.k2) && not_negative(k.k3) && k.k2 + k.k3 > 0.0 &&
        std::isfinite(k.kappa))) {
    found.push_back({"lattice.constants",
                     "k1 " + meshes::to_text(k.k1) + ", k2 " + meshes::to_text(k.k2) + ", k3 " +
                         meshes::to_text(k.k3) + " N/m",
                     "spring constants must be finite and not negative, and some diagonal must "
                     "resist shear",
                     "use the model's closed form or a calibration"});
  }
}

void check_rotation(std::vector<Violation>& found, const Eigen::Matrix3d& axes) {
  const Eigen::Matrix3d defect = axes.transpose() * axes - Eigen::Matrix3d::Identity();
  if (axes.allFinite() && defect.cwiseAbs().maxCoeff() < 1e-9 && axes.determinant() > 0.0) return;
  found.push_back({"lattice.rotation", "",
                   "the grid's directions must be orthonormal and right-handed",
                   "give a rotation matrix"});
}

/// 4, 2 or 1: into how many mirror images the grid's planes through x = 0 and y = 0 divide the tip.
int grid_symmetry(const LatticeSettings& settings) {
  if (!settings.axes.isIdentity(0.0) || settings.offset.y() != 0.0) return 1;
  return settings.offset.x() == 0.0 ? 4 : 2;
}

void check_tip(const Geometry& geometry, const Rubber& rubber, const LatticeSettings& settings,
               int sectors) {
  std::vector<Violation> found = geometry.violations();
  check_material(found, rubber, settings);
  if (settings.spacing < smallest_spacing * geometry.tip_radius) {
    found.push_back({"lattice.spacing", meshes::to_text(settings.spacing) + " m",
                     "the spacing of a static lattice must be at least R/320",
                     "choose a coarser lattice"});
  }
  if (!(std::isfinite(settings.ligament_stiffness) && settings.ligament_stiffness > 0.0)) {
    found.push_back({"lattice.ligament_stiffness", meshes::to_text(settings.ligament_stiffness),
                     "the factor on the ligaments must be finite and positive",
                     "1 is the standard ligament"});
  }
  if (!(std::isfinite(settings.contact_stiffness) && settings.contact_stiffness > 0.0)) {
    found.push_back({"lattice.contact_stiffness", meshes::to_text(settings.contact_stiffness),
                     "the factor on the ties to the plane must be finite and positive",
                     "1 is the standard tie"});
  }
  if ((sectors != 1 && sectors != 2 && sectors != 4) || sectors > grid_symmetry(settings)) {
    found.push_back({"sectors", std::to_string(sectors),
                     "the tip divides into 1, 2 or 4 parts, and into several only along planes "
                     "of grid points",
                     "compute the whole tip, or remove offset and rotation"});
  }
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// The material in terms of what a LatticeBody stores.
struct Recipe {
  double fibre = 0.0;               ///< stiffness of a whole edge's fibre [N/m]
  std::array<double, 3> central{};  ///< of whole central springs, per family [N/m]
  CellLaw law;
  bool finite = false;
  double shear = 0.0;  ///< C44 [Pa]
};

Recipe recipe_for(const Rubber& rubber, const LatticeSettings& settings) {
  const double a = settings.spacing;
  Recipe recipe;
  recipe.finite = settings.kinematics == Kinematics::finite;
  SpringConstants k = settings.constants;
  if (settings.model == ModelKind::network) k = hookean_constants(rubber, a);
  if (settings.model == ModelKind::central) k.kappa = 0.0;
  recipe.shear = (k.k2 + 4.0 / 3.0 * k.k3) / a;
  if (settings.model == ModelKind::network && recipe.finite) {
    recipe.fibre = fibre_share * rubber.shear_modulus * a;
    recipe.law = CellLaw::network(rubber, fibre_share);
  } else if (settings.model == ModelKind::central || recipe.finite) {
    recipe.central = {k.k1, k.k2, k.k3};
    if (settings.model == ModelKind::hookean) recipe.law = CellLaw::volume(k.kappa, true);
  } else {
    recipe.fibre = fibre_share * recipe.shear * a;
    recipe.law = CellLaw::cubic(k, a, fibre_share, settings.axes);
  }
  return recipe;
}

/// What the cells own of the springs that start at a particle, per direction of the half stencil.
using SpringShares = std::array<double, directions>;

void add_shares(const GridCells& cells, const CutCell& cell, const CornerMoments& moments,
                std::vector<SpringShares>& shares) {
  const std::array<std::uint32_t, 8> corners = cells.corners(cell);
  for (std::size_t s = 0; s < half_stencil.size(); ++s) {
    const Direction& d = half_stencil[s];
    for (int c = 0; c < 8; ++c) {
      const int x = (c & 1) + d.dx, y = (c >> 1 & 1) + d.dy, z = (c >> 2 & 1) + d.dz;
      if ((x | y | z) & ~1) continue;  // the spring would leave the cell
      shares[corners[std::size_t(c)]][s] += spring_share(moments, c, d);
    }
  }
}

void add_springs(const GridCells& cells, const std::vector<SpringShares>& shares,
                 const Recipe& recipe, LatticeBody& body) {
  for (std::uint32_t p = 0; p < shares.size(); ++p) {
    for (std::size_t s = 0; s < half_stencil.size(); ++s) {
      const double share = shares[p][s];
      if (share == 0.0) continue;
      const Family family = half_stencil[s].family;
      const std::ptrdiff_t step = neighbour_offset(cells.grid().size, int(s));
      const std::uint32_t q = cells.particle_at(cells.point(p) + std::size_t(step));
      const double central = share * recipe.central[family];
      if (central > 0.0) body.springs.push_back({{p, q}, central});
      const double fibre = family == axis ? share * recipe.fibre : 0.0;
      if (fibre > 0.0) body.fibres.push_back({{p, q}, fibre});
    }
  }
}

/// Particles, springs and cells; no bond, no outer points, nothing held.
LatticeBody elastic_body(const GridCells& cells, const Recipe& recipe, double density) {
  LatticeBody body;
  body.finite = recipe.finite;
  body.law = recipe.law;
  body.mass.assign(cells.particles(), 0.0);
  body.fixed.assign(3 * cells.particles(), 0);
  for (std::size_t p = 0; p < cells.particles(); ++p) body.rest.push_back(cells.rest_position(p));
  const double spacing = cells.grid().spacing, cube = spacing * spacing * spacing;
  std::vector<SpringShares> shares(cells.particles(), SpringShares{});
  for (const CutCell& cell : cells.cells()) {
    const CornerMoments moments = corner_moments(cell);
    add_shares(cells, cell, moments, shares);
    const auto corners = cells.corners(cell);
    for (std::size_t c = 0; c < 8; ++c) body.mass[corners[c]] += density * cube * moments[c];
    body.cells.push_back(
        {corners, mean_gradients(moments, spacing, cells.grid().axes), cell.fraction() * cube});
  }
  add_springs(cells, shares, recipe, body);
  return body;
}

/// Leaves the cells of the sector alone.
void keep_sector(const CubicGrid& grid, int sectors, std::vector<CutCell>& cells) {
  if (sectors == 1) return;
  std::erase_if(cells, [&](const CutCell& cell) {
    // Cells lie on one side of the mirror planes, so any point within tells.
    const Vector3 at = grid.position(cell.index[0], cell.index[1], cell.index[2]) +
                       Vector3::Constant(0.5 * grid.spacing);
    return at.y() < 0.0 || (sectors == 4 && at.x() < 0.0);
  });
}

/// Mirror planes hold the displacement across them.
void hold_mirror_planes(double spacing, int sectors, LatticeBody& body) {
  const double tolerance = 1e-6 * spacing;
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    if (sectors == 4 && std::abs(body.rest[p].x()) < tolerance) body.fixed[3 * p] = 1;
    if (sectors > 1 && std::abs(body.rest[p].y()) < tolerance) body.fixed[3 * p + 1] = 1;
  }
}

/// Points of a surface above `lowest` [m], in the sector, tied with `stiffness` [Pa/m].
std::vector<TiedPoint> tied_surface(const GridCells& cells, const Geometry& geometry,
                                    Surface surface, double lowest, int sectors, double stiffness) {
  std::vector<TiedPoint> tied;
  const double apart = cells.grid().spacing / points_per_spacing;
  for (const SurfacePoint& point : meshes::surface_points(geometry, surface, apart)) {
    const Vector3& at = point.position;
    if (at.z() < lowest || (sectors > 1 && at.y() < 0.0) || (sectors == 4 && at.x() < 0.0)) {
      continue;
    }
    tied.push_back(tie(cells, point, stiffness));
  }
  return tied;
}

/// Deepest height at which the outer surface can meet the plane: a sleeve as long as the rubber is
/// thick, since no press goes deeper than that.
double lowest_contact(const Geometry& geometry) {
  return -geometry.thickness();
}

/// Particles and springs of a published lattice; `number` takes the particle at every grid point.
LatticeBody published_springs(const LatticeModel& model, std::vector<std::uint32_t>& number) {
  LatticeBody body;
  body.finite = model.kinematics == Kinematics::finite;
  for (const std::uint32_t point : model.particles) {
    number[point] = std::uint32_t(body.rest.size());
    body.rest.push_back(model.rest_position(point));
    body.mass.push_back(model.mass[point]);
  }
  body.fixed.assign(3 * body.rest.size(), 0);
  for (const std::uint32_t point : model.particles) {
    for (std::size_t s = 0; s < half_stencil.size(); ++s) {
      const double stiffness =
          model.weight[s][point] * model.stiffness[std::size_t(half_stencil[s].family)];
      if (stiffness == 0.0) continue;
      const std::ptrdiff_t step = neighbour_offset(model.grid.size, int(s));
      body.springs.push_back({{number[point], number[point + std::size_t(step)]}, stiffness});
    }
  }
  return body;
}

}  // namespace

LatticeBody build_cut_tip(const Geometry& geometry, const Rubber& rubber,
                          const LatticeSettings& settings, int sectors) {
  check_tip(geometry, rubber, settings, sectors);
  const CubicGrid grid =
      meshes::covering_grid(geometry, settings.spacing, settings.offset, 1, settings.axes);
  std::vector<CutCell> cut = meshes::cut_cells(geometry, grid, smallest_fraction);
  keep_sector(grid, sectors, cut);
  const GridCells cells(grid, largest_piece(grid, cut));
  const Recipe recipe = recipe_for(rubber, settings);
  LatticeBody body = elastic_body(cells, recipe, rubber.density);
  body.sectors = sectors;
  hold_mirror_planes(grid.spacing, sectors, body);
  const double stiffness = tie_stiffness * recipe.shear / grid.spacing;
  body.bond = tied_surface(cells, geometry, Surface::bond, -geometry.sleeve_length, sectors,
                           stiffness * settings.ligament_stiffness);
  body.outer = tied_surface(cells, geometry, Surface::outer, lowest_contact(geometry), sectors,
                            stiffness * settings.contact_stiffness);
  return body;
}

LatticeBody body_of(const LatticeModel& model, const Geometry& geometry, const Rubber& rubber) {
  if (model.kind != ModelKind::published) {
    throw meshes::InvalidInput({"lattice.model", std::string(name(model.kind)),
                                "only the published lattice is pressed as it stands at equilibrium",
                                "take build_cut_tip, which cuts the cells of the other models"});
  }
  std::vector<std::uint32_t> number(model.points(), GridCells::none);
  LatticeBody body = published_springs(model, number);
  const double a = model.spacing();
  for (const Ligament& ligament : model.ligaments) {
    body.bond.push_back(
        tie_to_particle(number[ligament.particle], ligament.rest, a * a, ligament.stiffness));
  }
  for (const std::uint32_t point : model.boundary) {
    const Vector3 rest = model.rest_position(point);
    if (rest.z() < lowest_contact(geometry)) continue;
    body.outer.push_back(
        tie_to_particle(number[point], rest, a * a, particle_tie * rubber.youngs_modulus * a));
  }
  return body;
}

LatticeBody build_free_block(const Rubber& rubber, const LatticeSettings& settings,
                             const std::array<int, 3>& cells) {
  std::vector<Violation> found;
  check_material(found, rubber, settings);
  check_rotation(found, settings.axes);
  if (!(std::isfinite(settings.spacing) && settings.spacing > 0.0) ||
      *std::min_element(cells.begin(), cells.end()) < 1) {
    found.push_back({"lattice.spacing", meshes::to_text(settings.spacing) + " m",
                     "a block needs a positive spacing and at least one cell each way",
                     "give a positive spacing and cell count"});
  }
  if (!found.empty()) throw meshes::InvalidInput(found);
  CubicGrid grid;
  grid.spacing = settings.spacing;
  grid.axes = settings.axes;
  grid.size = {cells[0] + 1, cells[1] + 1, cells[2] + 1};
  std::vector<CutCell> whole;
  for (int k = 0; k < cells[2]; ++k) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int i = 0; i < cells[0]; ++i) {
        whole.push_back({{i, j, k}, {1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125}});
      }
    }
  }
  return elastic_body(GridCells(grid, std::move(whole)), recipe_for(rubber, settings),
                      rubber.density);
}

int largest_symmetry(const LatticeSettings& settings, const meshes::PressProtocol& protocol) {
  if (settings.model == ModelKind::published) return 1;
  const int sectors = grid_symmetry(settings);
  const bool straight = protocol.tilt == 0.0 && protocol.lateral == 0.0;
  return straight ? sectors : std::min(sectors, 2);
}

}  // namespace fingertip::lattice
