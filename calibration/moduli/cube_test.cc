#include "calibration/moduli/cube_test.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::calibration::inline moduli {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Pivots below this fraction of the largest count as zero. A stiff but sound
/// cube of 8 cells has pivots above 1e-4 of the largest.
constexpr double singular_ratio = 1e-10;

/// The cube's points by their integer coordinates 0 ... cells, whatever order they are stored in.
class PointIndex {
 public:
  explicit PointIndex(const lattice::CubeLattice& cube) : points_(cube.cells + 1) {
    Vector3d lowest = cube.positions.front();
    for (const Vector3d& p : cube.positions) lowest = lowest.cwiseMin(p);
    of_.resize(cube.positions.size());
    for (std::size_t i = 0; i < cube.positions.size(); ++i) {
      const Vector3d steps = (cube.positions[i] - lowest) / cube.spacing;
      of_[slot({int(std::lround(steps(0))), int(std::lround(steps(1))),
                int(std::lround(steps(2)))})] = Index(i);
    }
  }
  Index operator()(const std::array<int, 3>& ijk) const { return of_[slot(ijk)]; }

 private:
  std::size_t slot(const std::array<int, 3>& ijk) const {
    return (std::size_t(ijk[2]) * std::size_t(points_) + std::size_t(ijk[1])) *
               std::size_t(points_) +
           std::size_t(ijk[0]);
  }
  int points_;
  std::vector<Index> of_;
};

/// Outward surface area carried by each point [m²]: a quarter of every adjacent surface cell face.
/// It turns a stress into nodal loads and the surface displacement into the mean strain.
std::vector<Vector3d> surface_areas(const lattice::CubeLattice& cube, const PointIndex& point) {
  std::vector<Vector3d> areas(cube.positions.size(), Vector3d::Zero());
  const double quarter = 0.25 * cube.spacing * cube.spacing;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int p = 0; p < cube.cells; ++p)
        for (int q = 0; q < cube.cells; ++q)
          for (int corner = 0; corner < 4; ++corner) {
            std::array<int, 3> ijk{};
            ijk[std::size_t(axis)] = side * cube.cells;
            ijk[std::size_t((axis + 1) % 3)] = p + corner % 2;
            ijk[std::size_t((axis + 2) % 3)] = q + corner / 2;
            areas[std::size_t(point(ijk))](axis) += side == 0 ? -quarter : quarter;
          }
  return areas;
}

/// Statically determinate supports: one corner entirely, the next one across, the third one axis.
std::vector<char> supports(const lattice::CubeLattice& cube, const PointIndex& point) {
  std::vector<char> held(3 * cube.positions.size(), 0);
  const auto hold = [&](Index p, int component) { held[std::size_t(3 * p + component)] = 1; };
  for (int c = 0; c < 3; ++c) hold(point({0, 0, 0}), c);
  hold(point({cube.cells, 0, 0}), 1);
  hold(point({cube.cells, 0, 0}), 2);
  hold(point({0, cube.cells, 0}), 2);
  return held;
}

/// Machine that applies uniform stresses to one cube and reads mean strains.
class TestingMachine {
 public:
  explicit TestingMachine(const lattice::CubeLattice& cube)
      : areas_(surface_areas(cube, PointIndex(cube))),
        volume_(std::pow(cube.spacing * cube.cells, 3)) {
    const std::vector<char> held = supports(cube, PointIndex(cube));
    std::vector<Index> reduced(held.size(), -1);
    for (std::size_t dof = 0; dof < held.size(); ++dof)
      if (held[dof] == 0) {
        reduced[dof] = Index(free_.size());
        free_.push_back(Index(dof));
      }
    factorise(cube.stiffness, reduced);
  }

  /// Volume-averaged strain under the uniform stress `stress` [Pa].
  Matrix3d mean_strain(const Matrix3d& stress) const {
    Eigen::VectorXd load(Index(free_.size()));
    for (std::size_t i = 0; i < free_.size(); ++i)
      load(Index(i)) = (stress * areas_[std::size_t(free_[i] / 3)])(free_[i] % 3);
    const Eigen::VectorXd free_displacement = solver_.solve(load);
    std::vector<Vector3d> displacement(areas_.size(), Vector3d::Zero());
    for (std::size_t i = 0; i < free_.size(); ++i)
      displacement[std::size_t(free_[i] / 3)](free_[i] % 3) = free_displacement(Index(i));
    Matrix3d gradient = Matrix3d::Zero();
    for (std::size_t p = 0; p < areas_.size(); ++p)
      gradient += displacement[p] * areas_[p].transpose() / volume_;
    return 0.5 * (gradient + gradient.transpose());
  }

 private:
  void factorise(const Eigen::SparseMatrix<double>& stiffness, const std::vector<Index>& reduced) {
    std::vector<Eigen::Triplet<double>> entries;
    for (Index column = 0; column < stiffness.outerSize(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(stiffness, column); it; ++it)
        if (reduced[std::size_t(it.row())] >= 0 && reduced[std::size_t(it.col())] >= 0)
          entries.emplace_back(int(reduced[std::size_t(it.row())]),
                               int(reduced[std::size_t(it.col())]), it.value());
    Eigen::SparseMatrix<double> matrix(Index(free_.size()), Index(free_.size()));
    matrix.setFromTriplets(entries.begin(), entries.end());
    solver_.compute(matrix);
    const bool singular =
        solver_.info() != Eigen::Success ||
        solver_.vectorD().minCoeff() < singular_ratio * solver_.vectorD().maxCoeff();
    if (singular)
      throw meshes::NotConverged(
          "material test: the cube has a mechanism or an instability besides the six rigid "
          "motions, so it carries no load");
  }

  std::vector<Vector3d> areas_;
  double volume_;
  std::vector<Index> free_;  ///< degrees of freedom that no support holds
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// Young's modulus from tension along `direction`: stress over strain along it.
double tension_modulus(const TestingMachine& machine, const Vector3d& direction, double stress) {
  const Vector3d d = direction.normalized();
  return stress / d.dot(machine.mean_strain(stress * d * d.transpose()) * d);
}

}  // namespace

CubeModuli measure_cube(const lattice::CubeLattice& cube) {
  const TestingMachine machine(cube);
  // Any stress does in small strain; 1 Pa reads the compliance directly.
  constexpr double stress = 1.0;
  CubeModuli moduli;
  const Matrix3d axial =
      machine.mean_strain(stress * Vector3d::UnitX() * Vector3d::UnitX().transpose());
  moduli.youngs_modulus_100 = stress / axial(0, 0);
  moduli.poissons_ratio_100 = -0.5 * (axial(1, 1) + axial(2, 2)) / axial(0, 0);
  moduli.bulk_modulus = stress / (3.0 * axial.trace());
  moduli.youngs_modulus_110 = tension_modulus(machine, {1.0, 1.0, 0.0}, stress);
  moduli.youngs_modulus_111 = tension_modulus(machine, {1.0, 1.0, 1.0}, stress);
  Matrix3d shear = Matrix3d::Zero();
  shear(0, 1) = shear(1, 0) = stress;
  moduli.shear_modulus = stress / (2.0 * machine.mean_strain(shear)(0, 1));
  return moduli;
}

}  // namespace fingertip::calibration::inline moduli
