#include "lattice/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "meshes/files.h"

namespace fingertip::lattice {

using meshes::CubicGrid;
using meshes::Geometry;
using meshes::Vector3;

double LatticeModel::rest_length(Family family) const {
  return grid.spacing * std::sqrt(double(family) + 1.0);
}

Vector3 LatticeModel::rest_position(std::size_t point) const {
  const std::size_t nx = std::size_t(grid.size[0]), ny = std::size_t(grid.size[1]);
  return grid.position(int(point % nx), int(point / nx % ny), int(point / (nx * ny)));
}

double LatticeModel::total_mass() const {
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}

std::size_t LatticeModel::spring_count() const {
  std::size_t count = 0;
  for (const auto& w : weight) {
    count += std::size_t(std::count_if(w.begin(), w.end(), [](double x) { return x > 0.0; }));
  }
  return count;
}

namespace {

/// Empty points at the end of every row, so that a block that starts at a row's last particle
/// does not reach the particles of the next row.
constexpr int row_margin = int(lanes) - 1;

void require_finite(const SpringConstants& k) {
  for (const double value : {k.k1, k.k2, k.k3, k.kappa}) {
    if (std::isfinite(value)) continue;
    throw meshes::InvalidInput({"lattice.constants", meshes::to_text(value),
                                "spring and volume constants must be finite",
                                "use the model's closed form or a calibration"});
  }
}

/// Where the body's cells are: those whose centre is rubber (README: sampling).
std::vector<std::uint8_t> whole_cells(const Geometry& geometry, const CubicGrid& grid) {
  const double tolerance = 1e-9 * geometry.tip_radius;
  const Vector3 to_centre = Vector3::Constant(0.5 * grid.spacing);
  std::vector<std::uint8_t> cells(grid.points(), 0);
  for (int k = 0; k + 1 < grid.size[2]; ++k) {
    for (int j = 0; j + 1 < grid.size[1]; ++j) {
      for (int i = 0; i + 1 < grid.size[0]; ++i) {
        cells[grid.index(i, j, k)] =
            geometry.contains(grid.position(i, j, k) + to_centre, tolerance);
      }
    }
  }
  return cells;
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
  for (const std::size_t i : model.particles) {
    model.mass[i] = mass / double(model.particles.size());
    for (int s = 0; s < directions; ++s) {
      const std::size_t j = i + std::size_t(neighbour_offset(model.grid.size, s));
      if (model.is_particle[j]) model.weight[std::size_t(s)][i] = 1.0;
    }
  }
}

/// Central and hookean: every cell adds its share of springs and mass.
void assemble_cells(LatticeModel& model, const std::vector<std::uint8_t>& is_cell, double density) {
  allocate(model);
  model.cells = marked_points(is_cell);
  const double corner_mass = density * std::pow(model.spacing(), 3) / 8.0;
  for (const std::size_t cell : model.cells) {
    for (int c = 0; c < 8; ++c) {
      const std::size_t i = cell_corner(model.grid.size, cell, c);
      model.is_particle[i] = 1;
      model.mass[i] += corner_mass;
    }
    for (int s = 0; s < directions; ++s) {
      const Direction& d = half_stencil[std::size_t(s)];
      // The spring starts at each corner from which the neighbour is still a corner of this cell.
      for (int c = 0; c < 8; ++c) {
        const int x = (c & 1) + d.dx, y = (c >> 1 & 1) + d.dy, z = (c >> 2 & 1) + d.dz;
        if ((x | y | z) & ~1) continue;
        model.weight[std::size_t(s)][cell_corner(model.grid.size, cell, c)] += cell_share[d.family];
      }
    }
  }
  model.particles = marked_points(model.is_particle);
  if (model.constants.kappa != 0.0) {
    model.cell_weight.assign(model.points(), 0.0);
    for (const std::size_t cell : model.cells) model.cell_weight[cell] = 1.0;
    model.cell_blocks = covering_blocks(model.grid, is_cell);
  }
}

/// Constants per class, dampers by the model's rule, and the kernel's traversal order.
void finish(LatticeModel& model, double retardation_time) {
  model.stiffness = {model.constants.k1, model.constants.k2, model.constants.k3};
  model.blocks = covering_blocks(model.grid, model.is_particle);
  for (const std::size_t i : model.particles) model.inverse_mass[i] = 1.0 / model.mass[i];
  if (model.kind == ModelKind::published) {
    const double reduced_mass = 0.5 * model.mass[model.particles.front()];  // the paper's m'
    for (std::size_t f = 0; f < 3; ++f) {
      model.damping[f] = 2.0 * std::sqrt(reduced_mass * model.stiffness[f]);
    }
    return;
  }
  model.proportional_damping = true;
  model.retardation_time = retardation_time;
  for (std::size_t f = 0; f < 3; ++f) model.damping[f] = retardation_time * model.stiffness[f];
  model.volume_stiffness = model.constants.kappa;
  model.volume_damping = retardation_time * model.constants.kappa;
}

std::size_t neighbour_count(const LatticeModel& model, std::size_t i) {
  std::size_t count = 0;
  for (int s = 0; s < directions; ++s) {
    const std::size_t step = std::size_t(neighbour_offset(model.grid.size, s));
    count += std::size_t(model.is_particle[i + step]) + std::size_t(model.is_particle[i - step]);
  }
  return count;
}

void find_boundary(LatticeModel& model, const Geometry& geometry) {
  const double middle = 0.5 * (geometry.tip_radius + geometry.rod_radius);
  for (const std::uint32_t i : model.particles) {
    if (neighbour_count(model, i) < 26 &&
        Geometry::radial_distance(model.rest_position(i)) > middle) {
      model.boundary.push_back(i);
    }
  }
}

/// Published: every particle within one spacing of the rod hangs on a ligament k = E a, critically
/// damped by the paper's rule. The rod is thousands of times heavier, so the equivalent mass of
/// the pair is the particle's.
void hang_on_ligaments(LatticeModel& model, const Geometry& geometry, double layer_stiffness) {
  const double reach = geometry.rod_radius + model.spacing() + 1e-9 * geometry.tip_radius;
  for (const std::uint32_t i : model.particles) {
    if (Geometry::radial_distance(model.rest_position(i)) > reach) continue;
    model.ligaments.push_back({i, model.rest_position(i), layer_stiffness,
                               2.0 * std::sqrt(model.mass[i] * layer_stiffness)});
  }
}

/// Central and hookean: the staircase that stands for the rod's surface, i.e. the particles that
/// touch a cell whose centre lies in the rod, bonded nearly rigidly (README: bond).
void bond_inner_skin(LatticeModel& model, const Geometry& geometry, double stiffness,
                     double damping) {
  const CubicGrid& grid = model.grid;
  const Vector3 to_centre = Vector3::Constant(0.5 * grid.spacing);
  const double reach = geometry.rod_radius + 1e-9 * geometry.tip_radius;
  const std::size_t last_corner = cell_corner(grid.size, 0, 7);
  for (const std::uint32_t i : model.particles) {
    const std::size_t lowest = i - last_corner;
    for (int c = 0; c < 8; ++c) {
      const Vector3 centre = model.rest_position(cell_corner(grid.size, lowest, c)) + to_centre;
      if (Geometry::radial_distance(centre) > reach) continue;
      model.ligaments.push_back({i, model.rest_position(i), stiffness, damping});
      break;
    }
  }
}

void attach_to_rod(LatticeModel& model, const Geometry& geometry, const meshes::Rubber& rubber,
                   double scale) {
  const double layer = scale * rubber.youngs_modulus * model.spacing();
  if (model.kind == ModelKind::published) {
    hang_on_ligaments(model, geometry, layer);
    return;
  }
  constexpr double nearly_rigid = 4.0;
  bond_inner_skin(model, geometry,
                  nearly_rigid * scale * rubber.longitudinal_modulus() * model.spacing(),
                  rubber.retardation_time * layer);
}

}  // namespace

LatticeModel build_tip(const Geometry& geometry, const meshes::Rubber& rubber,
                       const LatticeSettings& settings) {
  require_finite(settings.constants);
  LatticeModel model;
  model.kind = settings.model;
  model.kinematics = settings.kinematics;
  model.constants = settings.constants;
  if (settings.model != ModelKind::hookean) model.constants.kappa = 0.0;
  model.grid = meshes::covering_grid(geometry, settings.spacing, settings.offset, 1);
  model.grid.size[0] += row_margin;
  if (settings.model == ModelKind::published) {
    connect_particles(model, meshes::sample_particles(geometry, model.grid),
                      rubber.density * geometry.tip_volume());
  } else {
    assemble_cells(model, whole_cells(geometry, model.grid), rubber.density);
  }
  finish(model, rubber.retardation_time);
  find_boundary(model, geometry);
  attach_to_rod(model, geometry, rubber, settings.ligament_stiffness);
  return model;
}

LatticeModel build_block(ModelKind kind, Kinematics kinematics, const SpringConstants& constants,
                         double spacing, const std::array<int, 3>& cells, double density,
                         double retardation_time) {
  require_finite(constants);
  if (!(std::isfinite(spacing) && spacing > 0.0) ||
      *std::min_element(cells.begin(), cells.end()) < 1) {
    throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(spacing) + " m",
                                "a block needs a positive spacing and at least one cell each way",
                                "give a positive spacing and cell count"});
  }
  LatticeModel model;
  model.kind = kind;
  model.kinematics = kinematics;
  model.constants = constants;
  if (kind != ModelKind::hookean) model.constants.kappa = 0.0;
  model.grid.spacing = spacing;
  model.grid.origin = Vector3::Constant(-spacing);
  model.grid.size = {cells[0] + 3 + row_margin, cells[1] + 3, cells[2] + 3};
  std::vector<std::uint8_t> is_cell(model.grid.points(), 0), is_particle(is_cell);
  for (int k = 1; k <= cells[2] + 1; ++k) {
    for (int j = 1; j <= cells[1] + 1; ++j) {
      for (int i = 1; i <= cells[0] + 1; ++i) {
        is_particle[model.grid.index(i, j, k)] = 1;
        is_cell[model.grid.index(i, j, k)] = i <= cells[0] && j <= cells[1] && k <= cells[2];
      }
    }
  }
  if (kind == ModelKind::published) {
    const double volume = std::pow(spacing, 3) * cells[0] * cells[1] * cells[2];
    connect_particles(model, std::move(is_particle), density * volume);
  } else {
    assemble_cells(model, is_cell, density);
  }
  finish(model, retardation_time);
  return model;
}

}  // namespace fingertip::lattice
