#include "lattice/model/cell_law.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/lattice/statics/laws.h"

using namespace fingertip;
using namespace laws;
using Eigen::Matrix3d;

namespace {

using Vector9 = Eigen::Matrix<double, 9, 1>;

constexpr double gf_per_cm2 = 98.0665;  // [Pa]
constexpr double spacing = 1.1e-3;
constexpr double share = 1.0 / 3.0;

const meshes::Rubber rubber;

Matrix3d some_axes() {
  return Eigen::AngleAxisd(0.8, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
}

/// A displacement gradient without any symmetry.
Matrix3d some_gradient() {
  Matrix3d H;
  H << 0.21, -0.32, 0.15, 0.24, -0.16, 0.33, -0.28, 0.09, 0.17;
  return H;
}

/// Constants of a lattice that is not isotropic.
lattice::SpringConstants anisotropic() {
  return {2.0, 0.7, 0.9, 3000.0};
}

std::vector<std::pair<const char*, CellLaw>> all_laws() {
  return {{"none", CellLaw()},
          {"cubic", cubic_law(anisotropic(), spacing, share, some_axes())},
          {"volume, small", volume_law(5000.0, false)},
          {"volume, finite", volume_law(5000.0, true)},
          {"network", network_law(rubber, share)}};
}

/// Energy of isotropic fibres that carry the modulus s G, above rest.
double fibre_energy(double s, const Matrix3d& H) {
  const Matrix3d F = Matrix3d::Identity() + H;
  return 0.5 * s * rubber.shear_modulus * (F.squaredNorm() - 3.0);
}

/// Nominal stress of network and fibres together.
Matrix3d network_stress(double s, const Matrix3d& F) {
  const Vector9 stress = network_law(rubber, s).evaluate(F - Matrix3d::Identity()).stress;
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(stress.data()) +
         s * rubber.shear_modulus * F;
}

}  // namespace

TEST(CellLaw, StressAndTangentAreDerivatives) {
  const double step = 1e-5;
  for (const auto& [label, law] : all_laws()) {
    SCOPED_TRACE(label);
    const auto response = law.evaluate(some_gradient());
    EXPECT_NEAR(response.energy, law.energy(some_gradient()), 1e-13 * std::abs(response.energy));
    for (int i = 0; i < 9; ++i) {
      Matrix3d plus = some_gradient(), minus = plus;
      plus(i / 3, i % 3) += step;
      minus(i / 3, i % 3) -= step;
      EXPECT_NEAR(response.stress[i], (law.energy(plus) - law.energy(minus)) / (2 * step), 2e-4);
      const Vector9 slope = (law.evaluate(plus).stress - law.evaluate(minus).stress) / (2 * step);
      EXPECT_LT((response.tangent.col(i) - slope).norm(), 2e-3);
    }
  }
}

/// Law A pulled along one axis with free sides; figures of the shared physics notes, to their last
/// digit.
TEST(CellLaw, NetworkPulledAlongAnAxis) {
  const std::vector<std::pair<double, double>> curve = {
      {0.8, -9.931}, {0.9, -4.416}, {1.1, 3.677}, {1.2, 6.838}, {1.5, 14.460}};
  for (const double s : {0.0, share, 1.0}) {
    for (const auto& [stretch, nominal] : curve) {
      double low = 0.5, high = 1.5;
      for (int i = 0; i < 60; ++i) {
        const double side = 0.5 * (low + high);
        const Matrix3d F = Eigen::Vector3d(stretch, side, side).asDiagonal();
        (network_stress(s, F)(1, 1) > 0.0 ? high : low) = side;
      }
      const Matrix3d F = Eigen::Vector3d(stretch, low, low).asDiagonal();
      EXPECT_NEAR(network_stress(s, F)(0, 0) / gf_per_cm2, nominal, 6e-4) << s << ' ' << stretch;
    }
  }
}

TEST(CellLaw, NetworkShearsLinearly) {
  for (const double gamma : {0.1, 0.5, 1.5}) {
    Matrix3d F = Matrix3d::Identity();
    F(0, 1) = gamma;
    EXPECT_NEAR(network_stress(share, F)(0, 1), rubber.shear_modulus * gamma,
                1e-12 * rubber.shear_modulus);
  }
}

TEST(CellLaw, NetworkDoesNotSeeRotations) {
  const Matrix3d turn = some_axes(), F = Matrix3d::Identity() + some_gradient();
  const auto total = [](const Matrix3d& deformation) {
    const Matrix3d H = deformation - Matrix3d::Identity();
    return network_law(rubber, share).energy(H) + fibre_energy(share, H);
  };
  EXPECT_NEAR(total(turn), 0.0, 1e-12 * rubber.shear_modulus);
  EXPECT_NEAR(total(turn * F), total(F), 1e-12 * total(F));
  EXPECT_NEAR(total(F * turn), total(F), 1e-12 * total(F));  // isotropic
}

TEST(CellLaw, NetworkHasNoStressAtRestAndHookesTangent) {
  const Matrix3d rest = Matrix3d::Identity();
  EXPECT_LT(network_stress(share, rest).norm(), 1e-12 * rubber.shear_modulus);
  auto tangent = network_law(rubber, share).evaluate(Matrix3d::Zero()).tangent;
  const auto hooke = cubic_law(lattice::hookean_constants(rubber, spacing), spacing, share)
                         .evaluate(Matrix3d::Zero())
                         .tangent;
  EXPECT_LT((tangent - hooke).norm(), 1e-12 * hooke.norm());
}

TEST(CellLaw, NetworkRefusesInvertedCells) {
  const CellLaw law = network_law(rubber, share);
  Matrix3d H = Matrix3d::Zero();
  for (const double flat : {-1.0, -1.5}) {
    H(2, 2) = flat;
    EXPECT_THROW(law.evaluate(H), std::domain_error);
    EXPECT_EQ(law.energy(H), std::numeric_limits<double>::infinity());
    EXPECT_NO_THROW(volume_law(5000.0, true).evaluate(H));
  }
}

/// Whatever k3, hookean constants give an isotropic body, in any axes.
TEST(CellLaw, CubicOfHookeanConstantsIsIsotropic) {
  const Matrix3d H = some_gradient(), strain = 0.5 * (H + H.transpose());
  const double exact = 0.5 * rubber.lame_lambda() * std::pow(strain.trace(), 2) +
                       rubber.shear_modulus * strain.squaredNorm();
  for (const double k3 : {0.0, 0.3, 0.7}) {
    const auto constants =
        lattice::hookean_constants(rubber, spacing, k3 * spacing * rubber.shear_modulus);
    for (const Matrix3d& axes : {Matrix3d(Matrix3d::Identity()), some_axes()}) {
      EXPECT_NEAR(cubic_law(constants, spacing, 0.0, axes).energy(H), exact, 1e-12 * exact);
      EXPECT_NEAR(cubic_law(constants, spacing, share, axes).energy(H) +
                      0.5 * share * rubber.shear_modulus * H.squaredNorm(),
                  exact, 1e-12 * exact);
    }
  }
}

/// Springs counted one by one: a uniform strain stretches every spring of the infinite lattice, of
/// which a cell owns 3 along axes, 6 along face and 4 along body diagonals.
TEST(CellLaw, CubicIsTheSumOfItsSprings) {
  const auto k = anisotropic();
  const Matrix3d H = some_gradient(), axes = some_axes();
  double springs = 0.0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const int family = std::abs(x) + std::abs(y) + std::abs(z);
        if (family == 0) continue;
        const Eigen::Vector3d d = spacing * (axes * Eigen::Vector3d(x, y, z));
        const double stretch = d.normalized().dot(H * d);
        const double stiffness = family == 1 ? k.k1 : family == 2 ? k.k2 : k.k3;
        springs += 0.25 * stiffness * stretch * stretch;  // each is met from both ends
      }
    }
  }
  const double energy = springs / std::pow(spacing, 3) + 0.5 * k.kappa * std::pow(H.trace(), 2);
  EXPECT_NEAR(cubic_law(k, spacing, 0.0, axes).energy(H), energy, 1e-12 * energy);
}
