/// Cells, fields and sums for the tests of the cells' forces.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "lattice/forces/cell_forces.h"
#include "lattice/kernels/stencil.h"
#include "lattice/model/grid_cells.h"
#include "tests/lattice/reference.h"

namespace cell_scenes {

using namespace fingertip;
using Eigen::Matrix3d;
using lattice::CellExtremes;
using lattice::CellLattice;
using lattice::CellLawKind;
using lattice::CellMaterial;
using lattice::VectorField;
using meshes::CubicGrid;
using meshes::CutCell;
using meshes::Vector3;
using reference::cell_energy;

inline constexpr double tau = 3e-4;

/// A grid and its cells.
struct Scene {
  CubicGrid grid;
  std::vector<CutCell> cells;

  lattice::GridCells numbered() const { return {grid, cells}; }
  CellLattice of(const CellMaterial& material) const { return lay_out(grid, cells, material); }
};

/// Whole cells; a block of ten along x has full lanes and absent ones.
inline Scene block(int nx, int ny, int nz) {
  Scene scene;
  scene.grid.spacing = 1e-3;
  scene.grid.origin = Vector3(-2e-3, 1e-3, 5e-4);
  scene.grid.size = {nx + 9, ny + 3, nz + 3};
  for (int k = 1; k <= nz; ++k) {
    for (int j = 1; j <= ny; ++j) {
      for (int i = 1; i <= nx; ++i) {
        scene.cells.push_back({{i, j, k}, {1.0, 0.5, 0.5, 0.25, 0.5, 0.25, 0.25, 0.125}});
      }
    }
  }
  return scene;
}

/// The default tip, cut out of a grid that is aligned with nothing.
inline Scene tip(double spacing = 2.5e-3, const Vector3& offset = Vector3(0.3, -0.2, 0.1)) {
  Scene scene{meshes::covering_grid({}, spacing, offset, 1), {}};
  scene.grid.size[0] += int(lattice::lanes) - 1;
  scene.cells = lattice::largest_piece(scene.grid, meshes::cut_cells({}, scene.grid, 1e-6));
  return scene;
}

/// Laws of cells; of the hyperelastic ones two, whose energies can be written without principal
/// stretches (tests/lattice/reference.h).
enum class Law { cubic, volume, network, mooney_rivlin, ogden };

inline CellMaterial material(Law law, double retardation_time = 0.0) {
  CellMaterial m;
  m.kind = CellLawKind(std::min(int(law), int(CellLawKind::hyperelastic)));
  m.c11 = 3.1e3, m.c12 = 1.7e3, m.c44 = 1.2e3;
  m.kappa = 7.7e3;
  m.shear = 1.4e3, m.lambda = 9.1e3;
  m.hourglass_modulus = 450.0;
  m.retardation_time = retardation_time;
  using meshes::RubberLaw, meshes::VolumetricLaw;
  if (law == Law::mooney_rivlin) {
    m.energy = {RubberLaw::mooney_rivlin, VolumetricLaw::quadratic, {0.3}};
    m.volumetric = 1e4;
  }
  if (law == Law::ogden) {
    m.energy = {RubberLaw::ogden, VolumetricLaw::logarithmic, {0.2, 4.0, 0.8, -2.0}};
    m.volumetric = 9.1e3;
  }
  return m;
}

inline constexpr Law all_laws[] = {Law::cubic, Law::volume, Law::network, Law::mooney_rivlin,
                                   Law::ogden};
inline constexpr Law finite_laws[] = {Law::volume, Law::network, Law::mooney_rivlin, Law::ogden};

/// A field on the particles, given by their rest positions.
template <typename Function>
inline VectorField on_particles(const Scene& scene, const Function& function) {
  const lattice::GridCells cells = scene.numbered();
  VectorField field(scene.grid.points());
  for (std::size_t p = 0; p < cells.particles(); ++p) {
    field.set(cells.point(p), function(cells.rest_position(p)));
  }
  return field;
}

inline VectorField random_field(const Scene& scene, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  return on_particles(scene, [&](const Vector3&) {
    return Vector3(uniform(generator), uniform(generator), uniform(generator));
  });
}

/// Smooth and large, so that cells cut to slivers keep their orientation, and roughened.
inline VectorField strained(const Scene& scene, unsigned seed) {
  const VectorField rough = random_field(scene, 0.05 * scene.grid.spacing, seed);
  VectorField u = on_particles(scene, [](const Vector3& x) {
    const Vector3 q = 100.0 * x;
    return Vector3(1e-3 * Vector3(std::sin(q.y() + 0.3), q.x() * q.z() - 0.4 * q.y(),
                                  std::cos(q.x()) + 0.3 * q.z()));
  });
  for (std::size_t p = 0; p < scene.grid.points(); ++p) u.add(p, rough.at(p));
  return u;
}

inline VectorField sum(const VectorField& a, double factor, const VectorField& b) {
  VectorField result = a;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t p = 0; p < a.component[c].size(); ++p) {
      result.component[c][p] += factor * b.component[c][p];
    }
  }
  return result;
}

inline double product(const VectorField& a, const VectorField& b) {
  double result = 0.0;
  for (std::size_t p = 0; p < a.component[0].size(); ++p) result += a.at(p).dot(b.at(p));
  return result;
}

inline double largest(const VectorField& field) {
  double result = 0.0;
  for (std::size_t p = 0; p < field.component[0].size(); ++p) {
    result = std::max(result, field.at(p).norm());
  }
  return result;
}

inline VectorField forces(const CellLattice& cells, const VectorField& u, const VectorField& v,
                          CellExtremes* extremes = nullptr) {
  lattice::Team team(1);
  VectorField force(u.component[0].size());
  const CellExtremes found = lattice::CellForces(cells, team).add(u, v, force);
  if (extremes != nullptr) *extremes = found;
  return force;
}

inline void expect_equal(const CellExtremes& a, const CellExtremes& b) {
  EXPECT_EQ(a.smallest_jacobian, b.smallest_jacobian);
  EXPECT_EQ(a.stiffening, b.stiffening);
  EXPECT_EQ(a.thickening, b.thickening);
  EXPECT_EQ(a.fastest, b.fastest);
  EXPECT_EQ(a.velocity_gradient, b.velocity_gradient);
}

/// Runs `check(scene)` for whole and for cut cells.
template <typename Check>
inline void for_all_scenes(const Check& check) {
  for (const Scene& scene : {block(10, 3, 2), block(8, 2, 3), tip()}) {
    SCOPED_TRACE(std::to_string(scene.cells.size()) + " cells");
    check(scene);
  }
}

/// Runs `check(scene, material)` for every law with and without damping.
template <typename Check>
inline void for_all_materials(const Check& check) {
  for_all_scenes([&](const Scene& scene) {
    for (const Law kind : all_laws) {
      for (const double time : {0.0, tau}) {
        SCOPED_TRACE("law " + std::to_string(int(kind)) + ", tau " + std::to_string(time));
        check(scene, material(kind, time));
      }
    }
  });
}

inline Matrix3d some_gradient() {
  Matrix3d H;
  H << 0.31, -0.22, 0.15, 0.24, -0.26, 0.13, -0.18, 0.09, 0.17;
  return H;
}

}  // namespace cell_scenes
