#include "lattice/forces/cell_forces.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "lattice/forces/cell_energy.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "lattice/statics/cut_lattice.h"
#include "lattice/statics/elastic_system.h"
#include "tests/lattice/cell_scenes.h"

using namespace fingertip;
using namespace cell_scenes;
using Eigen::VectorXd;

TEST(CellForces, KernelIsTheReferenceForEveryWidthAndNumberOfThreads) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    const VectorField u = strained(scene, 1), v = random_field(scene, 0.3, 2);
    VectorField before = random_field(scene, 1e-4, 3), expected = before, first;
    CellExtremes first_extremes;
    reference::cell_forces(cells, u, v, expected);
    for (int width = 2; width <= lattice::kernel::supported_width(); width *= 2) {
      for (const int threads : {1, 2}) {
        SCOPED_TRACE(std::to_string(width) + " lanes, threads " + std::to_string(threads));
        lattice::Team team(threads);
        VectorField force = before;
        const CellExtremes extremes = lattice::CellForces(cells, team, width).add(u, v, force);
        EXPECT_LT(largest(sum(force, -1.0, expected)), 1e-13 * largest(expected));
        if (width == 2 && threads == 1) {
          first = force;
          first_extremes = extremes;
        }
        EXPECT_EQ(first.component, force.component) << "not the same bits";
        expect_equal(extremes, first_extremes);
      }
    }
  });
}

TEST(CellForces, AreMinusTheGradientOfTheEnergy) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    const VectorField u = strained(scene, 4);
    const VectorField force = forces(cells, u, VectorField(scene.grid.points()));
    const double h = 1e-6 * scene.grid.spacing;
    for (unsigned seed = 0; seed < 5; ++seed) {
      const VectorField d = random_field(scene, 1.0, 10 + seed);
      const double slope =
          (cell_energy(cells, sum(u, h, d)) - cell_energy(cells, sum(u, -h, d))) / (2.0 * h);
      EXPECT_NEAR(-product(force, d), slope,
                  1e-7 * std::sqrt(product(force, force) * product(d, d)));
    }
  });
}

TEST(CellForces, EnergyIsThatOfTheCellsOneByOneWithTheSameBitsAtAnyWidth) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    lattice::Team alone(1), pair(2);
    for (const double size : {1.0, 1e-4}) {
      VectorField u = strained(scene, 4);
      for (auto& component : u.component) {
        for (double& value : component) value *= size;
      }
      const double wanted = cell_energy(cells, u),
                   at_width_two = lattice::cell_energy(cells, u, alone, 2);
      // What log J loses at small strain, and invariants of F in the reference.
      EXPECT_NEAR(at_width_two, wanted, (m.holds_fibres() ? 1e-6 : 1e-7) * wanted);
      if (size == 1.0) {
        EXPECT_NEAR(at_width_two, wanted, 1e-12 * wanted);
      }
      EXPECT_EQ(lattice::cell_energy(cells, u, alone), at_width_two);
      EXPECT_EQ(lattice::cell_energy(cells, u, pair), at_width_two);
    }
  });
}

TEST(CellForces, EnergyFoundOnTheWayIsThatOfItsOwnPassAndLeavesTheForcesAsTheyAre) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    const VectorField u = strained(scene, 1), v = random_field(scene, 0.3, 2);
    const VectorField expected = forces(cells, u, v);
    lattice::Team alone(1);
    const double wanted = lattice::cell_energy(cells, u, alone);
    std::optional<double> first;
    for (int width = 2; width <= lattice::kernel::supported_width(); width *= 2) {
      for (const int threads : {1, 2}) {
        lattice::Team team(threads);
        VectorField force(scene.grid.points());
        double energy = 0.0;
        lattice::CellForces(cells, team, width).add(u, v, force, energy);
        EXPECT_EQ(force.component, expected.component) << "not the same bits";
        EXPECT_NEAR(energy, wanted, 1e-13 * wanted);
        EXPECT_EQ(energy, *(first = first.value_or(energy))) << "not the same bits";
      }
    }
  });
}

TEST(CellForces, EnergyOfACellTurnedInsideOutIsInfiniteOnTheWayToo) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    VectorField u = strained(scene, 1), v = random_field(scene, 0.3, 2), force(scene.grid.points());
    for (auto& component : u.component)
      for (double& value : component) value *= 100.0;
    lattice::Team alone(1);
    double energy = 0.0;
    lattice::CellForces(cells, alone).add(u, v, force, energy);
    const double apart = lattice::cell_energy(cells, u, alone);
    EXPECT_EQ(std::isinf(energy), m.large_strain());
    EXPECT_EQ(std::isinf(energy), std::isinf(apart));
  });
}

/// The statics add up the fibres edge by edge and the mean cells with Eigen.

TEST(CellForces, AreThoseOfTheStaticsFibresAndCells) {
  for (const bool finite : {false, true}) {
    lattice::LatticeSettings settings;
    settings.model = finite ? lattice::ModelKind::network : lattice::ModelKind::hookean;
    settings.kinematics = finite ? lattice::Kinematics::finite : lattice::Kinematics::small;
    settings.spacing = 1.5e-3;
    settings.offset = Vector3(0.3, -0.2, 0.1);
    const meshes::Rubber rubber;
    const double a = settings.spacing;
    const auto k = lattice::hookean_constants(rubber, a, 0.2 * a * rubber.shear_modulus);
    settings.constants = k;
    CellMaterial m;
    m.kind = finite ? CellLawKind::network : CellLawKind::cubic;
    m.shear = rubber.shear_modulus, m.lambda = rubber.lame_lambda();
    m.c44 = (k.k2 + 4.0 / 3.0 * k.k3) / a;
    m.c12 = m.c44 + k.kappa, m.c11 = (k.k1 + k.k2) / a + m.c44 + k.kappa;
    m.hourglass_modulus = lattice::fibre_share * (finite ? m.shear : m.c44);

    lattice::LatticeBody body = lattice::build_cut_tip({}, rubber, settings, 1);
    body.bond.clear();
    const lattice::ElasticSystem system(body);
    const Scene scene = tip(a, settings.offset);
    const CellLattice cells = scene.of(m);
    const VectorField u = strained(scene, 5);
    const VectorField force = forces(cells, u, VectorField(scene.grid.points()));
    ASSERT_EQ(body.rest.size(), scene.numbered().particles());
    const auto point = [&](std::size_t p) {
      const Vector3 at = scene.grid.coordinates(body.rest[p]).array().round();
      return scene.grid.index(int(at.x()), int(at.y()), int(at.z()));
    };
    VectorXd x(body.unknowns()), expected;
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      x.segment<3>(3 * Eigen::Index(p)) = u.at(point(p));
    }
    system.assemble(x, expected, nullptr);
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      EXPECT_LT((force.at(point(p)) - expected.segment<3>(3 * Eigen::Index(p))).norm(),
                1e-11 * largest(force));
    }
    EXPECT_NEAR(cell_energy(cells, u), system.energy(x), 1e-11 * system.energy(x));
  }
}

/// At rest the dampers are tau times the stiffness, which the cubic law has for the same moduli.

/// The mean gradient of a linear displacement is the gradient, however the cell is cut.

TEST(CellForces, LinearDisplacementIsExactInCutCells) {
  const Scene scene = tip();
  const Matrix3d H = some_gradient();
  const CellMaterial m = material(Law::cubic);
  Matrix3d P = m.c44 * (H + H.transpose());
  P.diagonal() = (m.c11 - m.c12) * H.diagonal() + Vector3::Constant(m.c12 * H.trace());
  const VectorField u = on_particles(scene, [&](const Vector3& x) { return Vector3(H * x); });
  const lattice::GridCells numbered = scene.numbered();
  VectorField expected(scene.grid.points());
  for (const CutCell& cell : scene.cells) {
    const auto gradients = lattice::mean_gradients(lattice::corner_moments(cell),
                                                   scene.grid.spacing, Matrix3d::Identity());
    const double volume = cell.fraction() * std::pow(scene.grid.spacing, 3);
    for (int c = 0; c < 8; ++c) {
      expected.add(numbered.point(numbered.corners(cell)[std::size_t(c)]),
                   -volume * P * gradients.col(c));
    }
  }
  const VectorField force = forces(scene.of(m), u, VectorField(scene.grid.points()));
  EXPECT_LT(largest(sum(force, -1.0, expected)), 1e-12 * largest(expected));
}

TEST(CellForces, AbsentCellsSeeNothingOfWhatLiesAtTheirCorners) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const CellLattice cells = scene.of(m);
    const VectorField u = strained(scene, 14), v = random_field(scene, 0.3, 15);
    VectorField bad_u = u, bad_v = v;
    const lattice::GridCells numbered = scene.numbered();
    std::mt19937 generator(16);
    std::uniform_real_distribution<double> garbage(-1e308, 1e308);
    for (std::size_t p = 0; p < scene.grid.points(); ++p) {
      if (numbered.particle_at(p) != lattice::GridCells::none) continue;
      bad_u.set(p, Vector3(garbage(generator), -1.0, 1e-320));
      bad_v.set(p, Vector3(1e-3, garbage(generator), garbage(generator)));
    }
    CellExtremes extremes, bad_extremes;
    EXPECT_EQ(forces(cells, u, v, &extremes).component,
              forces(cells, bad_u, bad_v, &bad_extremes).component);
    expect_equal(extremes, bad_extremes);
    for (const auto& component : forces(cells, bad_u, bad_v).component) {
      for (const double value : component) EXPECT_TRUE(std::isfinite(value));
    }
  });
}

TEST(CellLattice, NeedsRoomAroundTheCellsAndOrder) {
  const CellMaterial m = material(Law::network);
  for (std::size_t d = 0; d < 3; ++d) {
    Scene tight = block(3, 2, 2);
    --tight.grid.size[d];
    EXPECT_THROW(tight.of(m), std::invalid_argument) << d;
    Scene low = block(3, 2, 2);
    low.cells.front().index[d] = 0;
    EXPECT_THROW(low.of(m), std::invalid_argument) << d;
  }
  Scene unsorted = block(3, 2, 2);
  std::swap(unsorted.cells[0], unsorted.cells[1]);
  EXPECT_THROW(unsorted.of(m), std::invalid_argument);
  EXPECT_TRUE(block(0, 2, 2).of(m).empty());
}

TEST(CellLattice, BlocksHoldEveryCellOnceAndPlanesEveryBlock) {
  const Scene scene = tip(8e-4);
  const CellLattice cells = scene.of(material(Law::cubic));
  double fraction = 0.0, expected = 0.0;
  bool whole = false;
  std::set<std::size_t> taken;
  for (std::size_t b = 0; b < cells.blocks.size(); ++b) {
    const lattice::CellBlock& at = cells.blocks[b];
    for (std::size_t l = 0; l < lattice::lanes; ++l) {
      const bool present = at.cut == lattice::CellBlock::whole || cells.cut[at.cut].at[l] > 0.0;
      if (present) {
        EXPECT_TRUE(taken.insert(at.first + l).second);
      }
      fraction += at.cut == lattice::CellBlock::whole ? 1.0 : cells.cut[at.cut].at[l];
    }
    whole = whole || at.cut == lattice::CellBlock::whole;
  }
  for (const CutCell& cell : scene.cells) expected += cell.fraction();
  EXPECT_TRUE(whole);
  EXPECT_NEAR(fraction, expected, 1e-12 * expected);
  std::size_t blocks = 0;
  for (const auto& slabs : cells.slabs) {
    std::size_t above = 0;  // the lowest plane of particles that no slab has yet
    for (const auto& slab : slabs) {
      EXPECT_LT(slab.first, slab.last);
      blocks += slab.last - slab.first;
      EXPECT_GE(cells.blocks[slab.first].first / std::size_t(cells.plane), above);
      for (std::uint32_t b = slab.first; b < slab.last; ++b)
        above = std::max(above, cells.blocks[b].first / std::size_t(cells.plane) + 2);
    }
  }
  EXPECT_GE(cells.slabs[1].size(), 4U);
  EXPECT_EQ(blocks, cells.blocks.size());
}
