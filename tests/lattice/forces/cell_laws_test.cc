// What the cells' laws promise, seen through the kernel.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "lattice/forces/cell_energy.h"
#include "lattice/kernels/pack_algebra.h"
#include "lattice/model/cell_law.h"
#include "lattice/model/formulation.h"
#include "meshes/press/fields.h"
#include "tests/lattice/cell_scenes.h"
#include "tests/lattice/statics/laws.h"

using namespace fingertip;
using namespace cell_scenes;
using namespace laws;

namespace {

/// First Piola-Kirchhoff stress of law A.
Matrix3d law_a_stress(const CellMaterial& m, const Matrix3d& F) {
  const Matrix3d T = F.inverse().transpose();
  return m.shear * (F - T) + m.lambda * std::log(F.determinant()) * T;
}

/// Every law of large strain with every cost of volume but that of `network`.
std::vector<CellMaterial> every_large_law() {
  using meshes::RubberLaw;
  std::vector<CellMaterial> all;
  for (const meshes::VolumetricLaw volumetric : values(meshes::VolumetricLaw()))
    for (const meshes::StrainEnergy& energy : std::initializer_list<meshes::StrainEnergy>{
             {RubberLaw::neo_hookean, volumetric, {}},
             {RubberLaw::yeoh, volumetric, {-0.013, 0.0021}},
             {RubberLaw::yeoh, volumetric, {0.2, 0.04}},
             {RubberLaw::mooney_rivlin, volumetric, {0.27}},
             {RubberLaw::ogden, volumetric, {0.9, 1.3, 0.02, 4.9, 0.08, -2.1}},
             {RubberLaw::gent, volumetric, {9.3}}}) {
      if (energy == meshes::StrainEnergy()) continue;
      all.push_back(lattice::network_material(energy, 1.4e3, 9.1e3, 1.0 / 3.0));
    }
  return all;
}

/// Of the vectorised kernel.
double kernel_energy(const CellLattice& cells, const VectorField& u) {
  lattice::Team team(1);
  return lattice::cell_energy(cells, u, team);
}

/// Sum of the forces on the particles of the block's face of largest x.
Vector3 force_on_face(const Scene& scene, const VectorField& force) {
  int last = 0;
  for (const CutCell& cell : scene.cells) last = std::max(last, cell.index[0] + 1);
  Vector3 result = Vector3::Zero();
  for (int k = 0; k < scene.grid.size[2]; ++k) {
    for (int j = 0; j < scene.grid.size[1]; ++j) {
      result += force.at(scene.grid.index(last, j, k));
    }
  }
  return result;
}

}  // namespace

TEST(CellForces, TurnWithTheBody) {
  const Matrix3d Q = Eigen::AngleAxisd(2.1, Vector3(1.0, -2.0, 0.5).normalized()).matrix();
  for_all_scenes([&](const Scene& scene) {
    for (const Law kind : finite_laws) {
      const CellLattice cells = scene.of(material(kind, tau));
      const VectorField u = strained(scene, 6), v = random_field(scene, 0.3, 7);
      VectorField turned(scene.grid.points()), turned_v = turned, turned_force = turned;
      const VectorField force = forces(cells, u, v);
      const VectorField rest = on_particles(scene, [](const Vector3& x) { return x; });
      for (std::size_t p = 0; p < scene.grid.points(); ++p) {
        turned.set(p, Q * (rest.at(p) + u.at(p)) + Vector3(0.01, 0.02, -0.03) - rest.at(p));
        turned_v.set(p, Q * v.at(p));
        turned_force.set(p, Q * force.at(p));
      }
      const double energy = cell_energy(cells, u);
      EXPECT_NEAR(cell_energy(cells, turned), energy, 1e-11 * energy);
      EXPECT_LT(largest(sum(forces(cells, turned, turned_v), -1.0, turned_force)),
                1e-11 * largest(force));
    }
  });
}

TEST(CellForces, RigidMotionOfADeformedBodyIsNotDamped) {
  for_all_scenes([](const Scene& scene) {
    for (const Law kind : finite_laws) {
      const CellLattice cells = scene.of(material(kind, tau));
      const VectorField u = strained(scene, 8), rest(scene.grid.points());
      const Vector3 spin(30.0, -10.0, 20.0);
      VectorField x = on_particles(scene, [](const Vector3& X) { return X; });
      x = sum(x, 1.0, u);
      VectorField v(scene.grid.points());
      for (std::size_t p = 0; p < scene.grid.points(); ++p) {
        v.set(p, Vector3(0.1, 0.2, -0.3) + spin.cross(x.at(p)));
      }
      CellExtremes extremes;
      const VectorField without = forces(cells, u, rest), with = forces(cells, u, v, &extremes);
      const VectorField damped = forces(cells, u, random_field(scene, 0.1, 9));
      EXPECT_LT(largest(sum(with, -1.0, without)), 1e-12 * largest(sum(damped, -1.0, without)));
      EXPECT_LT(extremes.fastest, 1e-11 * spin.norm());
      if (!cells.material.large_strain()) continue;
      const double largest_row = 50.0;  // of [spin]x: |30| + |20|
      EXPECT_NEAR(extremes.velocity_gradient, largest_row, 1e-9 * largest_row);
    }
  });
}

TEST(CellForces, BalanceInForceAndTorque) {
  for_all_materials([](const Scene& scene, const CellMaterial& m) {
    const VectorField u = strained(scene, 11), v = random_field(scene, 0.3, 12);
    const VectorField force = forces(scene.of(m), u, v);
    // Small strain exerts its forces where the particles rest.
    VectorField x = on_particles(scene, [](const Vector3& X) { return X; });
    if (m.kind != CellLawKind::cubic) x = sum(x, 1.0, u);
    Vector3 total = Vector3::Zero(), torque = Vector3::Zero();
    double magnitude = 0.0;
    for (std::size_t p = 0; p < scene.grid.points(); ++p) {
      total += force.at(p);
      torque += x.at(p).cross(force.at(p));
      magnitude += force.at(p).norm();
    }
    EXPECT_LT(total.norm(), 1e-13 * magnitude);
    EXPECT_LT(torque.norm(), 1e-13 * magnitude * 0.03);
  });
}

TEST(CellForces, DampersDissipate) {
  for_all_scenes([](const Scene& scene) {
    for (const Law kind : finite_laws) {
      const CellLattice cells = scene.of(material(kind, tau));
      for (unsigned seed = 20; seed < 30; ++seed) {
        const VectorField u = strained(scene, seed), v = random_field(scene, 0.5, seed + 100);
        const VectorField without = forces(cells, u, VectorField(scene.grid.points()));
        EXPECT_LT(product(sum(forces(cells, u, v), -1.0, without), v), 0.0);
      }
    }
  });
}

TEST(CellForces, DampingAtRestIsTauTimesTheStiffness) {
  for_all_scenes([](const Scene& scene) {
    for (const Law kind : finite_laws) {
      const CellMaterial m = material(kind, tau);
      CellMaterial linear = material(Law::cubic);
      const bool network = m.large_strain();
      linear.c44 = network ? m.shear : 0.0;
      linear.c12 = network ? m.lambda : m.kappa;
      linear.c11 = linear.c12 + 2.0 * linear.c44;
      if (!network) linear.hourglass_modulus = 0.0;
      const VectorField v = random_field(scene, 0.5, 13), rest(scene.grid.points());
      const VectorField expected = forces(scene.of(linear), sum(rest, tau, v), rest);
      EXPECT_LT(largest(sum(forces(scene.of(m), rest, v), -1.0, expected)),
                1e-13 * largest(expected));
      EXPECT_LE(largest(forces(scene.of(m), rest, rest)),
                m.holds_fibres() ? 1e-15 * m.shear * scene.grid.spacing : 0.0);
    }
  });
}

TEST(CellForces, HomogeneousDeformationHasTheStressOfLawA) {
  const Scene scene = block(10, 3, 2);
  const double area = 6.0 * scene.grid.spacing * scene.grid.spacing;
  const CellMaterial m = material(Law::network);
  const CellLattice cells = scene.of(m);
  const auto stress_of = [&](const Matrix3d& F) -> Vector3 {
    const VectorField u = on_particles(
        scene, [&](const Vector3& x) { return Vector3((F - Matrix3d::Identity()) * x); });
    return -force_on_face(scene, forces(cells, u, VectorField(scene.grid.points()))) / area;
  };
  const Matrix3d shear = some_gradient();
  for (double stretch = 0.5; stretch < 1.55; stretch += 0.1) {
    for (const double sheared : {0.0, 1.0}) {
      Matrix3d F = Vector3(stretch, 1.0, 1.0 / std::sqrt(stretch)).asDiagonal();
      F += sheared * shear;
      const Vector3 expected = law_a_stress(m, F).col(0);
      EXPECT_LT((stress_of(F) - expected).norm(), 1e-12 * m.lambda) << stretch;
    }
  }
  // Volumes that need the logarithm's range reduction.
  for (int power = -11; power <= 11; ++power) {
    const Matrix3d F = 1.1 * std::exp2(power / 3.0) * Matrix3d::Identity();
    const Vector3 expected = law_a_stress(m, F).col(0);
    EXPECT_LT((stress_of(F) - expected).norm(), 1e-12 * expected.norm()) << power;
  }
}

TEST(CellForces, LogarithmIsGoodToOneUnitInTheLastPlace) {
  using Pack = std::experimental::native_simd<double>;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> near(0.7, 1.42), exponent(-12.0, 12.0);
  for (int i = 0; i < 100000; ++i) {
    const double value = i % 2 == 0 ? near(generator) : std::exp2(exponent(generator));
    const double computed = lattice::kernel::PackAlgebra<Pack>::log(value)[0];
    const long double exact = std::log(static_cast<long double>(value));
    EXPECT_LE(std::abs(computed - exact), 2.3e-16L * std::abs(exact)) << value;
  }
}

TEST(CellForces, ExtremesOfAKnownDeformation) {
  const Scene scene = block(10, 3, 2);
  const auto extremes = [&](Law kind, double stretch, double rate) {
    const auto along_x = [&](double factor) {
      return on_particles(scene, [=](const Vector3& x) { return Vector3(factor * x.x(), 0, 0); });
    };
    CellExtremes found;
    forces(scene.of(material(kind, tau)), along_x(stretch - 1.0), along_x(rate), &found);
    return found;
  };
  const CellMaterial m = material(Law::network, tau);
  const CellExtremes network = extremes(Law::network, 0.4, 1.2);
  const double g = 1.0 / 0.16, pressure = m.shear - m.lambda * std::log(0.4);
  EXPECT_NEAR(network.smallest_jacobian, 0.4, 1e-13);
  EXPECT_NEAR(network.thickening, g, 1e-11);
  EXPECT_NEAR(network.stiffening,
              (m.shear + (pressure + m.lambda) * g) / (m.lambda + 2.0 * m.shear), 1e-11);
  EXPECT_NEAR(network.fastest, 3.0, 1e-11);
  const CellExtremes volume = extremes(Law::volume, 0.4, 1.2);
  EXPECT_NEAR(volume.smallest_jacobian, 0.4, 1e-13);
  EXPECT_NEAR(volume.thickening, 1.0, 1e-12);
  EXPECT_NEAR(volume.stiffening, 1.0 + 0.6 / 0.4, 1e-12);
  EXPECT_NEAR(volume.fastest, 3.0, 1e-11);
  EXPECT_NEAR(extremes(Law::network, -0.5, 0.0).smallest_jacobian, -0.5, 1e-13);
  expect_equal(extremes(Law::cubic, 0.4, 1.2), CellExtremes{});
  expect_equal(extremes(Law::network, 1.0, 0.0), CellExtremes{});
}

/// What the kernel and the laws of one point make of every law and cost of volume.
TEST(CellForces, HomogeneousDeformationHasTheStressOfItsLaw) {
  const Scene scene = block(10, 3, 2);
  const double area = 6.0 * scene.grid.spacing * scene.grid.spacing;
  for (const CellMaterial& m : every_large_law()) {
    const CellLattice cells = scene.of(m);
    const meshes::HyperelasticLaw law = lattice::hyperelastic_law(m);
    const double volume = double(scene.cells.size()) * std::pow(scene.grid.spacing, 3);
    for (double stretch = 0.5; stretch < 1.55; stretch += 0.15) {
      Matrix3d F = Vector3(stretch, 1.0, 1.0 / std::sqrt(stretch)).asDiagonal();
      F += 0.8 * some_gradient();
      const VectorField u = on_particles(
          scene, [&](const Vector3& x) { return Vector3((F - Matrix3d::Identity()) * x); });
      const VectorField force = forces(cells, u, VectorField(scene.grid.points()));
      const Vector3 expected = law.complete(F).stress.col(0);
      EXPECT_LT((-force_on_face(scene, force) / area - expected).norm(), 1e-11 * expected.norm())
          << stretch;
      const double energy = kernel_energy(cells, u);
      EXPECT_NEAR(energy, volume * law.energy(F), 1e-11 * std::abs(energy));
    }
  }
}

TEST(CellForces, ExponentialIsGoodToTwoUnitsInTheLastPlace) {
  using Pack = std::experimental::native_simd<double>;
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> near(-0.5, 0.5), far(-690.0, 690.0);
  for (int i = 0; i < 100000; ++i) {
    const double value = i % 2 == 0 ? near(generator) : far(generator);
    const double computed = lattice::kernel::PackAlgebra<Pack>::exp(value)[0];
    const long double exact = std::exp(static_cast<long double>(value));
    EXPECT_LE(std::abs(computed - exact), 4.5e-16L * exact) << value;
  }
}

/// Against the eigenvalues of the point law's tangents, over all dF; and not needlessly far above.
TEST(CellForces, StiffeningBoundsTheTangentOfEveryLaw) {
  using Eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>;
  const Scene scene = block(1, 1, 1);
  std::mt19937 generator(6);
  std::normal_distribution<double> normal;
  for (const CellMaterial& m : every_large_law()) {
    const meshes::HyperelasticLaw law = lattice::hyperelastic_law(m);
    const auto largest_of = [&](const Matrix3d& F) {
      return Eigenvalues(law.complete(F).tangent).eigenvalues().maxCoeff();
    };
    // Of plane waves, by trial.
    const auto wave_of = [&](const Matrix3d& F) {
      const auto tangent = law.complete(F).tangent;
      double most = 0.0;
      for (int i = 0; i < 200; ++i) {
        const Vector3 a = Vector3::NullaryExpr([&] { return normal(generator); }).normalized(),
                      n = i % 2 == 0 ? a : Vector3::NullaryExpr([&] { return normal(generator); });
        Eigen::Matrix<double, 9, 1> dF;
        for (int k = 0; k < 9; ++k) dF[k] = a[k / 3] * n.normalized()[k % 3];
        most = std::max(most, dF.dot(tangent * dF));
      }
      return most;
    };
    const double rest = largest_of(Matrix3d::Identity()), waves = m.lambda + 2.0 * m.shear;
    for (int i = 0; i < 60; ++i) {
      Matrix3d H =
          (i % 2 == 0 ? 0.15 : 0.35) * Matrix3d::NullaryExpr([&] { return normal(generator); });
      if (i == 0) H.setZero();
      const Matrix3d F = Matrix3d::Identity() + H;
      if (F.determinant() < 0.05 || !std::isfinite(law.energy(F))) continue;
      const VectorField u = on_particles(scene, [&](const Vector3& x) { return Vector3(H * x); });
      CellExtremes extremes;
      forces(scene.of(m), u, u, &extremes);
      EXPECT_LE(largest_of(F), extremes.stiffening * rest * (1.0 + 1e-9)) << i;
      EXPECT_LE(wave_of(F), extremes.stiffening * waves * (1.0 + 1e-9)) << i;
      if (i == 0) {
        EXPECT_LT(extremes.stiffening, 1.25);
      }
    }
  }
}

/// Against the eigenvalues of the statics' tangents.
TEST(CellForces, StiffeningBoundsTheTangent) {
  using Eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>;
  const Scene scene = block(1, 1, 1);
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  for (const double ratio : {0.0, 0.5, 7.0}) {
    CellMaterial network = material(Law::network);
    network.lambda = ratio * network.shear;
    meshes::Rubber rubber;
    rubber.shear_modulus = network.shear;
    rubber.youngs_modulus = network.shear * (3.0 * ratio + 2.0) / (ratio + 1.0);
    const CellMaterial volume = material(Law::volume);
    const lattice::CellLaw laws[] = {network_law(rubber, 0.0), volume_law(volume.kappa, true)};
    for (int i = 0; i < 300; ++i) {
      const double size = i % 2 == 0 ? 0.2 : 0.5;
      Matrix3d H = size * Matrix3d::NullaryExpr([&] { return normal(generator); });
      if (i % 3 == 0) H = (std::exp(normal(generator)) - 1.0) * Matrix3d::Identity();
      if ((Matrix3d::Identity() + H).determinant() < 0.01) continue;
      const VectorField u = on_particles(scene, [&](const Vector3& x) { return Vector3(H * x); });
      for (const int law : {0, 1}) {
        const auto largest_of = [&](const Matrix3d& at) {
          return Eigenvalues(laws[law].evaluate(at).tangent).eigenvalues().cwiseAbs().maxCoeff();
        };
        CellExtremes extremes;
        forces(scene.of(law == 0 ? network : volume), u, u, &extremes);
        EXPECT_LE(largest_of(H), extremes.stiffening * largest_of(Matrix3d::Zero()) * (1.0 + 1e-9));
      }
    }
  }
}
