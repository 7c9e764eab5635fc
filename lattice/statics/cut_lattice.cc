#include "lattice/statics/cut_lattice.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lattice/model/cut_tip.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline statics {

using meshes::CubicGrid;
using meshes::CutCell;
using meshes::Geometry;
using meshes::Rubber;
using meshes::Vector3;
using meshes::Violation;

namespace {

void add_springs(const GridCells& cells, const Formulation& formulation, LatticeBody& body) {
  const std::array<std::vector<double>, directions> shares = spring_shares(cells);
  const std::array<double, 3> k{formulation.constants.k1, formulation.constants.k2,
                                formulation.constants.k3};
  const bool apart = !formulation.material.holds_fibres();
  const double whole_fibre =
      apart ? formulation.material.hourglass_modulus * cells.grid().spacing : 0.0;
  for (std::uint32_t p = 0; p < cells.particles(); ++p) {
    for (std::size_t s = 0; s < half_stencil.size(); ++s) {
      const double share = shares[s][cells.point(p)];
      if (share == 0.0) continue;
      const Family family = half_stencil[s].family;
      const std::ptrdiff_t step = neighbour_offset(cells.grid().size, int(s));
      const std::uint32_t q = cells.particle_at(cells.point(p) + std::size_t(step));
      const double central = formulation.central_springs ? share * k[family] : 0.0;
      if (central > 0.0) body.springs.push_back({{p, q}, central});
      const double fibre = family == axis ? share * whole_fibre : 0.0;
      if (fibre > 0.0) body.fibres.push_back({{p, q}, fibre});
    }
  }
}

/// How displacements of the corners make the bilinear modes yz, zx, xy, xyz [1/m].
Eigen::Matrix<double, 4, 8> mode_weights(double spacing) {
  Eigen::Matrix<double, 4, 8> weights;
  for (int c = 0; c < 8; ++c) {
    const double x = (c & 1) != 0 ? 1.0 : -1.0, y = (c & 2) != 0 ? 1.0 : -1.0,
                 z = (c & 4) != 0 ? 1.0 : -1.0;
    weights.col(c) << y * z, z * x, x * y, x * y * z;
  }
  return weights / (4.0 * spacing);
}

GridPlace place_of(const CubicGrid& grid, std::size_t point) {
  const auto [i, j, k] = grid.place(point);
  const std::array<int, 3> origin = grid.nearest(Vector3::Zero());
  return {i - origin[0], j - origin[1], k - origin[2]};
}

/// Particles, springs and cells; no bond, no outer points, nothing held.
LatticeBody elastic_body(const GridCells& cells, const Formulation& formulation, double density) {
  LatticeBody body;
  body.finite = formulation.finite;
  if (formulation.cell_law) body.law = {formulation.material, cells.grid().axes};
  body.mass.assign(cells.particles(), 0.0);
  body.fixed.assign(3 * cells.particles(), 0);
  for (std::size_t p = 0; p < cells.particles(); ++p) {
    body.rest.push_back(cells.rest_position(p));
    body.places.push_back(place_of(cells.grid(), cells.point(p)));
  }
  const double spacing = cells.grid().spacing, cube = spacing * spacing * spacing;
  for (const CutCell& cell : cells.cells()) {
    const CornerMoments moments = corner_moments(cell);
    const auto corners = cells.corners(cell);
    for (std::size_t c = 0; c < 8; ++c) body.mass[corners[c]] += density * cube * moments[c];
    body.cells.push_back(
        {corners, mean_gradients(moments, spacing, cells.grid().axes), cell.fraction() * cube});
    if (body.law.material.holds_fibres())
      body.cells.back().modes = std::sqrt(fibre_share) * mode_root(moments) * mode_weights(spacing);
  }
  add_springs(cells, formulation, body);
  return body;
}

/// Mirror planes hold the displacement across them.
void hold_mirror_planes(double spacing, int sectors, LatticeBody& body) {
  const double tolerance = 1e-6 * spacing;
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    if (sectors == 4 && std::abs(body.rest[p].x()) < tolerance) body.fixed[3 * p] = 1;
    if (sectors > 1 && std::abs(body.rest[p].y()) < tolerance) body.fixed[3 * p + 1] = 1;
  }
}

/// Particles and springs of a moving lattice; `number` takes the particle at every grid point.
LatticeBody springs_of(const LatticeModel& model, std::vector<std::uint32_t>& number) {
  number.assign(model.points(), GridCells::none);
  LatticeBody body;
  body.finite = model.kinematics == Kinematics::finite;
  for (const std::uint32_t point : model.particles) {
    number[point] = std::uint32_t(body.rest.size());
    body.rest.push_back(model.rest_position(point));
    body.places.push_back(place_of(model.grid, point));
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
  CutTip tip = cut_tip(geometry, rubber, settings, sectors);
  LatticeBody body = elastic_body(tip.cells, tip.formulation, rubber.density);
  body.sectors = sectors;
  hold_mirror_planes(settings.spacing, sectors, body);
  body.bond = std::move(tip.bond);
  body.outer = std::move(tip.outer);
  body.contact = tip.contact;
  return body;
}

LatticeBody body_of(const LatticeModel& model, const Geometry& geometry, const Rubber& rubber) {
  if (model.kind != ModelKind::published) {
    throw meshes::InvalidInput({"lattice.model", std::string(name(model.kind)),
                                "only the published lattice is pressed as it stands at equilibrium",
                                "take build_cut_tip, which cuts the cells of the other models"});
  }
  std::vector<std::uint32_t> number;
  LatticeBody body = springs_of(model, number);
  const double a = model.spacing();
  const auto shape = meshes::shape_of(geometry);
  const auto normal = [&](meshes::ProfileSurface surface, const Vector3& rest) {
    return shape->nearest(surface, rest).normal;
  };
  for (const Ligament& ligament : model.ligaments) {
    body.bond.push_back(tie_to_particle(number[ligament.particle], ligament.rest,
                                        normal(meshes::ProfileSurface::bond, ligament.rest), a * a,
                                        ligament.stiffness));
  }
  for (const std::uint32_t point : model.boundary) {
    const Vector3 rest = model.rest_position(point);
    if (rest.z() < lowest_contact(geometry)) continue;
    body.outer.push_back(tie_to_particle(number[point], rest,
                                         normal(meshes::ProfileSurface::contact, rest), a * a,
                                         particle_tie * rubber.youngs_modulus * a));
  }
  return body;
}

LatticeBody body_of_block(const LatticeModel& model) {
  std::vector<std::uint32_t> number;
  LatticeBody body = springs_of(model, number);
  if (model.cell_lattice.empty()) return body;
  body.law = {model.cell_lattice.material, model.grid.axes};
  const double a = model.spacing();
  const auto gradients =
      mean_gradients(corner_moments(whole_cells({0, 0, 0}, {1, 1, 1}).front()), a, model.grid.axes);
  for (const std::uint32_t lowest : model.cells) {
    MeanCell cell{{}, gradients, a * a * a};
    for (int c = 0; c < 8; ++c)
      cell.corners[std::size_t(c)] = number[cell_corner(model.grid.size, lowest, c)];
    body.cells.push_back(cell);
  }
  return body;
}

LatticeBody build_free_block(const Rubber& rubber, const LatticeSettings& settings,
                             const std::array<int, 3>& cells) {
  std::vector<Violation> found = cell_violations(rubber, settings);
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
  return elastic_body(GridCells(grid, whole_cells({0, 0, 0}, cells)),
                      formulation_for(rubber, settings), rubber.density);
}

int largest_symmetry(const Geometry& geometry, const LatticeSettings& settings,
                     const meshes::PressProtocol& protocol) {
  if (settings.model == ModelKind::published) return 1;
  return way_symmetry(geometry, settings, protocol);
}

int way_symmetry(const Geometry& geometry, const LatticeSettings& settings,
                 const meshes::PressProtocol& protocol) {
  const int sectors = grid_symmetry(geometry, settings);
  if (!protocol.mirrored(1)) return 1;
  return protocol.mirrored(0) ? sectors : std::min(sectors, 2);
}

}  // namespace fingertip::lattice::inline statics
