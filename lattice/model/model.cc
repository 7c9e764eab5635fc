#include "lattice/model/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lattice/model/cut_tip.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

using meshes::CubicGrid;
using meshes::Geometry;
using meshes::Vector3;

double LatticeModel::rest_length(Family family) const {
  return grid.spacing * std::sqrt(double(family) + 1.0);
}

std::array<int, 3> LatticeModel::place(std::size_t point) const {
  return grid.place(point);
}

Vector3 LatticeModel::rest_position(std::size_t point) const {
  const auto [i, j, k] = place(point);
  return grid.position(i, j, k);
}

double LatticeModel::total_mass() const {
  return sector.count() * std::accumulate(mass.begin(), mass.end(), 0.0);
}

std::size_t LatticeModel::spring_count() const {
  std::size_t count = fibres;
  if (!has_springs()) return count;
  for (const auto& w : weight) {
    count += std::size_t(std::count_if(w.begin(), w.end(), [](double x) { return x > 0.0; }));
  }
  return count;
}

namespace {

void require_finite(const SpringConstants& k) {
  for (const double value : {k.k1, k.k2, k.k3, k.kappa}) {
    if (std::isfinite(value)) continue;
    throw meshes::InvalidInput({"lattice.constants", meshes::to_text(value),
                                "spring and volume constants must be finite",
                                "use the model's closed form or a calibration"});
  }
}

/// Runs of `lanes` points, row by row, that cover every marked point once.
template <typename Mask>
std::vector<std::uint32_t> covering_blocks(const CubicGrid& grid, const Mask& marked) {
  std::vector<std::uint32_t> blocks;
  const std::size_t row = std::size_t(grid.size[0]);
  for (std::size_t begin = 0; begin < grid.points(); begin += row) {
    for (std::size_t i = begin; i < begin + row; ++i) {
      if (marked[i] == 0) continue;
      blocks.push_back(std::uint32_t(i));
      i += lanes - 1;
    }
  }
  return blocks;
}

template <typename Mask>
std::vector<std::uint32_t> marked_points(const Mask& marked) {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i] != 0) points.push_back(std::uint32_t(i));
  }
  return points;
}

void allocate(LatticeModel& model) {
  const std::size_t points = model.grid.points() + lanes;
  model.is_particle.resize(points, 0);
  model.mass.assign(points, 0.0);
  model.inverse_mass.assign(points, 0.0);
  for (auto& w : model.weight) w.assign(points, 0.0);
}

/// Published: a full spring between every two neighbouring particles, equal masses adding up to
/// `mass`.
void connect_particles(LatticeModel& model, std::vector<std::uint8_t> is_particle, double mass) {
  model.is_particle = std::move(is_particle);
  allocate(model);
  model.particles = marked_points(model.is_particle);
  double count = 0.0;  // of the whole tip's
  for (const std::size_t i : model.particles)
    count += model.sector.count() * model.sector.share(model.place(i));
  for (const std::size_t i : model.particles) {
    model.mass[i] = mass / count;
    for (int s = 0; s < directions; ++s) {
      const std::size_t j = i + std::size_t(neighbour_offset(model.grid.size, s));
      if (model.is_particle[j]) model.weight[std::size_t(s)][i] = 1.0;
    }
  }
}

/// Masses and springs of cells: every cell gives what of them lies in its rubber.
void connect_cells(LatticeModel& model, const GridCells& cells, bool central_springs,
                   double density) {
  const double cube = std::pow(model.spacing(), 3);
  for (const meshes::CutCell& cell : cells.cells()) {
    const CornerMoments moments = corner_moments(cell);
    const auto corners = cells.corners(cell);
    for (std::size_t c = 0; c < 8; ++c) {
      const std::size_t i = cells.point(corners[c]);
      model.is_particle[i] = 1;
      model.mass[i] += density * cube * moments[c];
    }
    model.cells.push_back(std::uint32_t(cells.point(corners[0])));
  }
  model.particles = marked_points(model.is_particle);
  const auto shares = spring_shares(cells);
  for (std::size_t s = 0; s < directions; ++s) {
    if (central_springs) {
      std::copy(shares[s].begin(), shares[s].end(), model.weight[s].begin());
    } else if (half_stencil[s].family == axis) {
      model.fibres += std::size_t(
          std::count_if(shares[s].begin(), shares[s].end(), [](double w) { return w > 0.0; }));
    }
  }
}

/// Traversal order, inverse masses and what mirror planes hold.
void finish(LatticeModel& model) {
  model.blocks = covering_blocks(model.grid, model.is_particle);
  for (const std::uint32_t i : model.particles) {
    model.inverse_mass[i] = 1.0 / model.mass[i];
    const std::array<int, 3> at = model.place(i);
    for (std::size_t d = 0; d < 3; ++d)
      if (model.sector.holds(d, at[d])) model.held[d].push_back(i);
  }
}

/// Of whole springs, masses and ligaments on its mirror planes a published part keeps its share.
void share_out(LatticeModel& model) {
  for (const std::size_t i : model.particles) {
    const std::array<int, 3> at = model.place(i);
    model.mass[i] *= model.sector.share(at);
    model.inverse_mass[i] = 1.0 / model.mass[i];
    for (std::size_t s = 0; s < directions; ++s) {
      const Direction& d = half_stencil[s];
      constexpr int leaves = -1;  // the planes across this axis
      model.weight[s][i] *= model.sector.share(
          {d.dx == 0 ? at[0] : leaves, d.dy == 0 ? at[1] : leaves, d.dz == 0 ? at[2] : leaves});
    }
  }
  for (Ligament& ligament : model.ligaments) {
    const double share = model.sector.share(model.place(ligament.particle));
    ligament.stiffness *= share;
    ligament.damping *= share;
  }
}

/// Particles joined as in connect_particles, with the paper's dampers.
LatticeModel published_model(Kinematics kinematics, const SpringConstants& constants,
                             const CubicGrid& grid, std::vector<std::uint8_t> is_particle,
                             double mass, const Sector& sector = {}) {
  require_finite(constants);
  LatticeModel model;
  model.sector = sector;
  model.kind = ModelKind::published;
  model.kinematics = kinematics;
  model.constants = constants;
  model.constants.kappa = 0.0;
  model.grid = grid;
  connect_particles(model, std::move(is_particle), mass);
  model.stiffness = {constants.k1, constants.k2, constants.k3};
  const double reduced_mass = 0.5 * model.mass[model.particles.front()];  // the paper's m'
  for (std::size_t f = 0; f < 3; ++f) {
    model.damping[f] = 2.0 * std::sqrt(reduced_mass * model.stiffness[f]);
  }
  finish(model);
  return model;
}

/// Beyond a mirror plane there is what lies before it.
std::size_t neighbour_count(const LatticeModel& model, std::size_t i) {
  const std::array<int, 3> at = model.place(i);
  const auto mirrored = [&](std::size_t d, int step) {
    return at[d] + (model.sector.holds(d, at[d]) ? std::abs(step) : step);
  };
  std::size_t count = 0;
  for (const Direction& d : half_stencil) {
    for (const int way : {1, -1}) {
      count += model.is_particle[model.grid.index(mirrored(0, way * d.dx), mirrored(1, way * d.dy),
                                                  mirrored(2, way * d.dz))];
    }
  }
  return count;
}

}  // namespace

void find_boundary(LatticeModel& model, const Geometry& geometry) {
  const auto shape = meshes::shape_of(geometry);
  const auto distance = [&](meshes::ProfileSurface surface, std::uint32_t i) {
    return shape->nearest(surface, model.rest_position(i)).distance;
  };
  for (const std::uint32_t i : model.particles)
    if (neighbour_count(model, i) < 26 &&
        distance(meshes::ProfileSurface::contact, i) < distance(meshes::ProfileSurface::bond, i))
      model.boundary.push_back(i);
}

namespace {

/// Published: every particle within one spacing of the bond hangs on a ligament k = E a, critically
/// damped by the paper's rule. The rod is thousands of times heavier, so the equivalent mass of
/// the pair is the particle's.
void hang_on_ligaments(LatticeModel& model, const Geometry& geometry, double layer_stiffness) {
  const double reach = model.spacing() + 1e-9 * geometry.tip_radius;
  const auto shape = meshes::shape_of(geometry);
  for (const std::uint32_t i : model.particles) {
    const meshes::Vector3 rest = model.rest_position(i);
    if (shape->nearest(meshes::ProfileSurface::bond, rest).distance > reach) continue;
    model.ligaments.push_back(
        {i, rest, layer_stiffness, 2.0 * std::sqrt(model.mass[i] * layer_stiffness)});
  }
}

/// Of the other parts.
void leave_layer_before(const CubicGrid& grid, const Sector& sector,
                        std::vector<std::uint8_t>& is_particle) {
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        if (sector.is_before({i, j, k})) is_particle[grid.index(i, j, k)] = 0;
      }
    }
  }
}

}  // namespace

LatticeModel build_published_tip(const Geometry& geometry, const meshes::Rubber& rubber,
                                 const LatticeSettings& settings, int sectors) {
  if (settings.model != ModelKind::published) {
    throw meshes::InvalidInput({"lattice.model", std::string(name(settings.model)),
                                "only the published lattice has no cells",
                                "take build_cut_model, which cuts the cells of the others"});
  }
  const auto violations = sector_violations(geometry, settings, sectors);
  if (!violations.empty()) throw meshes::InvalidInput(violations);
  LatticeSettings straight = settings;
  straight.axes.setIdentity();
  CubicGrid grid = tip_grid(geometry, straight, sectors);
  grid.size[0] += row_margin;
  const Sector sector(sectors, grid.axes);
  std::vector<std::uint8_t> is_particle = meshes::sample_particles(geometry, grid);
  leave_layer_before(grid, sector, is_particle);
  LatticeModel model =
      published_model(settings.kinematics, settings.constants, grid, std::move(is_particle),
                      rubber.density * geometry.tip_volume(), sector);
  find_boundary(model, geometry);
  hang_on_ligaments(model, geometry,
                    settings.ligament_stiffness * rubber.youngs_modulus * model.spacing());
  share_out(model);
  return model;
}

LatticeModel build_model(const GridCells& cells, ModelKind kind, const Formulation& formulation,
                         double density, const Sector& sector) {
  require_finite(formulation.constants);
  LatticeModel model;
  model.sector = sector;
  model.kind = kind;
  model.kinematics = formulation.finite ? Kinematics::finite : Kinematics::small;
  model.constants = formulation.constants;
  model.grid = cells.grid();
  model.is_particle.assign(model.grid.points(), 0);
  allocate(model);
  connect_cells(model, cells, formulation.central_springs, density);
  model.proportional_damping = true;
  model.retardation_time = formulation.material.retardation_time;
  model.relaxation = formulation.relaxation;
  if (formulation.central_springs) {
    model.stiffness = {formulation.constants.k1, formulation.constants.k2,
                       formulation.constants.k3};
    for (std::size_t f = 0; f < 3; ++f) {
      model.damping[f] = model.retardation_time * model.stiffness[f];
    }
  }
  // Springs at finite strain do not notice when a cell turns inside out; its cells tell.
  if (formulation.cell_law || formulation.finite) {
    model.cell_lattice = lay_out(model.grid, cells.cells(), formulation.material);
  }
  finish(model);
  return model;
}

LatticeModel build_block(ModelKind kind, Kinematics kinematics, const SpringConstants& constants,
                         double spacing, const std::array<int, 3>& cells, double density,
                         double retardation_time) {
  if (!(std::isfinite(spacing) && spacing > 0.0) ||
      *std::min_element(cells.begin(), cells.end()) < 1) {
    throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(spacing) + " m",
                                "a block needs a positive spacing and at least one cell each way",
                                "give a positive spacing and cell count"});
  }
  CubicGrid grid;
  grid.spacing = spacing;
  grid.origin = Vector3::Constant(-spacing);
  grid.size = {cells[0] + 3 + row_margin, cells[1] + 3, cells[2] + 3};
  const GridCells block(grid, whole_cells({1, 1, 1}, cells));
  if (kind != ModelKind::published) {
    return build_model(block, kind,
                       spring_formulation(kind, kinematics, constants, retardation_time), density);
  }
  std::vector<std::uint8_t> is_particle(grid.points(), 0);
  for (std::size_t p = 0; p < block.particles(); ++p) is_particle[block.point(p)] = 1;
  return published_model(kinematics, constants, grid, std::move(is_particle),
                         density * std::pow(spacing, 3) * cells[0] * cells[1] * cells[2]);
}

}  // namespace fingertip::lattice::inline model
