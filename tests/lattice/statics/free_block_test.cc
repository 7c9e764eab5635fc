#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "body_sums.h"
#include "lattice/kernels/stencil.h"
#include "lattice/statics/cut_lattice.h"
#include "tests/expectations.h"

using namespace fingertip;
using namespace body_sums;
using lattice::Kinematics;
using lattice::LatticeSettings;
using lattice::ModelKind;

namespace {

constexpr double spacing = 1.3e-3;

Matrix3d skew_axes() {
  return Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
}

meshes::Rubber rubber_with(double nu) {
  meshes::Rubber rubber;
  rubber.youngs_modulus = 2.0 * rubber.shear_modulus * (1.0 + nu);
  return rubber;
}

LatticeSettings settings_for(ModelKind model, Kinematics kinematics, const meshes::Rubber& rubber) {
  LatticeSettings settings;
  settings.model = model;
  settings.kinematics = kinematics;
  settings.spacing = spacing;
  settings.constants =
      lattice::hookean_constants(rubber, spacing, 0.2 * spacing * rubber.shear_modulus);
  return settings;
}

/// A displacement gradient without any symmetry, of about this size.
Matrix3d some_gradient(double size) {
  Matrix3d H;
  H << 0.31, -0.72, 0.15, 0.44, -0.26, 0.63, -0.58, 0.09, 0.47;
  return size * H;
}

double hookes_energy(const meshes::Rubber& rubber, const Matrix3d& H) {
  const Matrix3d strain = 0.5 * (H + H.transpose());
  return 0.5 * rubber.lame_lambda() * std::pow(strain.trace(), 2) +
         rubber.shear_modulus * strain.squaredNorm();
}

double law_a_energy(const meshes::Rubber& rubber, const Matrix3d& H) {
  const Matrix3d F = Matrix3d::Identity() + H;
  const double log_j = std::log(F.determinant());
  return 0.5 * rubber.shear_modulus * (F.squaredNorm() - 3.0 - 2.0 * log_j) +
         0.5 * rubber.lame_lambda() * log_j * log_j;
}

/// Of an infinite lattice of whole springs, per volume.
double central_energy(const LatticeSettings& settings, const Matrix3d& H) {
  const lattice::SpringConstants& k = settings.constants;
  const std::array<double, 3> stiffness{k.k1, k.k2, k.k3};
  double sum = 0.0;
  for (const lattice::Direction& direction : lattice::half_stencil) {
    const Vector3 d = spacing * settings.axes * Vector3(direction.dx, direction.dy, direction.dz);
    const double stretch = settings.kinematics == Kinematics::finite ? (d + H * d).norm() - d.norm()
                                                                     : d.normalized().dot(H * d);
    sum += 0.5 * stiffness[std::size_t(direction.family)] * stretch * stretch;
  }
  return sum / std::pow(spacing, 3);
}

double energy_of(const lattice::LatticeBody& body, const Matrix3d& H) {
  return elastic_energy(body, on_particles(body, [&](const Vector3& x) { return Vector3(H * x); }));
}

double volume_of(const std::array<int, 3>& cells) {
  return std::pow(spacing, 3) * cells[0] * cells[1] * cells[2];
}

const std::vector<std::array<int, 3>> blocks{{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {2, 3, 5}};
const std::vector<double> ratios{-0.3, 0.0, 0.25, 0.4286, 0.499};

/// The block's faces carry the traction of a uniform stress: a quarter of each cell face's to each
/// of its corners.
VectorXd loaded_by(const lattice::LatticeBody& body, const Matrix3d& axes,
                   const std::array<int, 3>& cells, const Matrix3d& stress) {
  VectorXd load = VectorXd::Zero(body.unknowns());
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    const Vector3 at = axes.transpose() * body.rest[p] / spacing;
    for (int d = 0; d < 3; ++d) {
      double share = 0.25 * spacing * spacing;  // number of cell faces that meet here, over 4
      for (int e = 0; e < 3; ++e) {
        const double end = cells[std::size_t(e)];
        if (e != d && at[e] > 0.5 && at[e] < end - 0.5) share *= 2.0;
      }
      const double outward = at[d] < 0.5 ? -1.0 : at[d] > cells[std::size_t(d)] - 0.5 ? 1.0 : 0.0;
      load.segment<3>(3 * Eigen::Index(p)) += outward * share * (stress * axes.col(d));
    }
  }
  return load;
}

/// Equilibrium of a free body under a balanced load: springs to the ground that carry nothing hold
/// six components of three particles that are no line.
VectorXd solve_free(const lattice::LatticeBody& body, const std::array<int, 3>& cells,
                    const VectorXd& load) {
  Eigen::SparseMatrix<double> K = stiffness(body);
  const int second = cells[0], third = (cells[0] + 1) * cells[1];
  // Along the block's own directions: with its edges along x, y, z these are the plain components.
  for (const int unknown : {0, 1, 2, 3 * second + 1, 3 * second + 2, 3 * third + 2}) {
    K.coeffRef(unknown, unknown) += K.coeff(0, 0);
  }
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(K).solve(load);
}

}  // namespace

TEST(FreeBlock, LinearDisplacementsStoreHookesEnergy) {
  for (const double nu : ratios) {
    const meshes::Rubber rubber = rubber_with(nu);
    for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
      for (const Matrix3d& axes : {Matrix3d(Matrix3d::Identity()), skew_axes()}) {
        auto settings = settings_for(model, Kinematics::small, rubber);
        settings.axes = axes;
        for (const auto& cells : blocks) {
          const Matrix3d H = some_gradient(1e-3);
          const double exact = volume_of(cells) * hookes_energy(rubber, H);
          EXPECT_NEAR(energy_of(lattice::build_free_block(rubber, settings, cells), H) / exact, 1.0,
                      1e-12)
              << nu << " " << name(model) << " " << cells[2];
        }
      }
    }
  }
}

TEST(FreeBlock, FiniteNetworkStoresLawA) {
  for (const double nu : {0.0, 0.25, 0.4286, 0.499}) {
    const meshes::Rubber rubber = rubber_with(nu);
    auto settings = settings_for(ModelKind::network, Kinematics::finite, rubber);
    settings.axes = skew_axes();
    for (const auto& cells : blocks) {
      const Matrix3d H = some_gradient(0.4);
      const double exact = volume_of(cells) * law_a_energy(rubber, H);
      EXPECT_NEAR(energy_of(lattice::build_free_block(rubber, settings, cells), H) / exact, 1.0,
                  1e-12)
          << nu;
    }
  }
}

TEST(FreeBlock, CellsOfLargeStrainStoreTheirLaw) {
  using meshes::RubberLaw, meshes::VolumetricLaw;
  for (const meshes::StrainEnergy& energy : std::initializer_list<meshes::StrainEnergy>{
           {RubberLaw::yeoh, VolumetricLaw::logarithmic, {0.1, 0.02}},
           {RubberLaw::mooney_rivlin, VolumetricLaw::quadratic, {0.3}},
           {RubberLaw::ogden, VolumetricLaw::quadratic, {0.8, 1.3, 0.2, 5.0}},
           {RubberLaw::gent, VolumetricLaw::isochoric_logarithmic, {20.0}}}) {
    meshes::Rubber rubber = rubber_with(0.45);
    rubber.energy = energy;
    auto settings = settings_for(ModelKind::network, Kinematics::finite, rubber);
    settings.axes = skew_axes();
    for (const auto& cells : blocks) {
      const Matrix3d H = some_gradient(0.4);
      const double exact =
          volume_of(cells) * meshes::HyperelasticLaw(rubber).energy(Matrix3d::Identity() + H);
      EXPECT_NEAR(energy_of(lattice::build_free_block(rubber, settings, cells), H) / exact, 1.0,
                  1e-12)
          << describe(energy);
    }
  }
}

TEST(FreeBlock, FiniteCentralSpringsStoreTheInfiniteLatticesEnergy) {
  const meshes::Rubber rubber;
  const Matrix3d H = some_gradient(0.4);
  const double dilatation = (Matrix3d::Identity() + H).determinant() - 1.0;
  for (const ModelKind model : {ModelKind::central, ModelKind::hookean}) {
    auto settings = settings_for(model, Kinematics::finite, rubber);
    settings.axes = skew_axes();
    const double volume_term = model == ModelKind::hookean ? settings.constants.kappa : 0.0;
    const double density =
        central_energy(settings, H) + 0.5 * volume_term * dilatation * dilatation;
    for (const auto& cells : blocks) {
      EXPECT_NEAR(energy_of(lattice::build_free_block(rubber, settings, cells), H) /
                      (volume_of(cells) * density),
                  1.0, 1e-12)
          << name(model);
    }
  }
}

TEST(FreeBlock, AnyConstantsGiveTheInfiniteLatticesEnergyAtSmallStrain) {
  const meshes::Rubber rubber;
  const Matrix3d H = some_gradient(1e-3);
  for (const ModelKind model : {ModelKind::central, ModelKind::hookean}) {
    auto settings = settings_for(model, Kinematics::small, rubber);
    settings.axes = skew_axes();
    settings.constants = {5.0, 1.5, 0.4, 2000.0};  // far from isotropic
    // Springs alone: central has no use for the volume constant.
    const double volume_term = model == ModelKind::hookean ? settings.constants.kappa : 0.0;
    const double density = central_energy(settings, H) + 0.5 * volume_term * std::pow(H.trace(), 2);
    for (const auto& cells : blocks) {
      EXPECT_NEAR(energy_of(lattice::build_free_block(rubber, settings, cells), H) /
                      (volume_of(cells) * density),
                  1.0, 1e-12)
          << name(model);
    }
  }
}

TEST(FreeBlock, UniaxialAndShearTestsGiveTheModuli) {
  for (const double nu : ratios) {
    const meshes::Rubber rubber = rubber_with(nu);
    const auto settings = settings_for(ModelKind::hookean, Kinematics::small, rubber);
    for (const int n : {2, 4, 8}) {
      const std::array<int, 3> cells{n, n, n};
      const auto body = lattice::build_free_block(rubber, settings, cells);
      const double stress = 1e-3 * rubber.youngs_modulus;
      Matrix3d pull = Matrix3d::Zero(), shear = Matrix3d::Zero();
      pull(2, 2) = stress;
      shear(0, 1) = shear(1, 0) = stress;
      const VectorXd pulled = solve_free(body, cells, loaded_by(body, settings.axes, cells, pull));
      const VectorXd sheared =
          solve_free(body, cells, loaded_by(body, settings.axes, cells, shear));
      for (const MeanCell& cell : body.cells) {  // each cell, so the deformation is uniform
        const Matrix3d H = mean_gradient(cell, pulled), S = mean_gradient(cell, sheared);
        ASSERT_NEAR(stress / H(2, 2) / rubber.youngs_modulus, 1.0, 1e-9) << nu << " " << n;
        ASSERT_NEAR(-H(0, 0) / H(2, 2), nu, 1e-9) << nu << " " << n;
        ASSERT_NEAR(-H(1, 1) / H(2, 2), nu, 1e-9) << nu << " " << n;
        ASSERT_NEAR(stress / (S(0, 1) + S(1, 0)) / rubber.shear_modulus, 1.0, 1e-9)
            << nu << " " << n;
      }
    }
  }
}

TEST(FreeBlock, MassAndEdgesAreThoseOfABlock) {
  const meshes::Rubber rubber;
  auto settings = settings_for(ModelKind::network, Kinematics::finite, rubber);
  settings.axes = skew_axes();
  const auto body = lattice::build_free_block(rubber, settings, {2, 3, 5});
  EXPECT_EQ(body.rest.size(), 3u * 4u * 6u);
  EXPECT_EQ(body.cells.size(), 30u);
  EXPECT_EQ(body.fibres.size(), 2u * 4u * 6u + 3u * 3u * 6u + 3u * 4u * 5u);
  EXPECT_TRUE(body.springs.empty() && body.bond.empty() && body.outer.empty());
  EXPECT_EQ(std::count(body.fixed.begin(), body.fixed.end(), 0), body.unknowns());
  double mass = 0.0;
  for (const double m : body.mass) mass += m;
  EXPECT_NEAR(mass / (rubber.density * volume_of({2, 3, 5})), 1.0, 1e-13);
  EXPECT_EQ(body.rest.front(), Vector3(Vector3::Zero()));
  const Vector3 far = spacing * settings.axes * Vector3(2.0, 3.0, 5.0);
  EXPECT_LT((body.rest.back() - far).norm(), 1e-15);
}

TEST(FreeBlock, RefusesWhatIsNoLattice) {
  const meshes::Rubber rubber;
  const auto good = settings_for(ModelKind::hookean, Kinematics::small, rubber);
  const std::array<int, 3> cells{1, 1, 1};
  EXPECT_NO_THROW(lattice::build_free_block(rubber, good, cells));
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, good, {1, 0, 1}), meshes::InvalidInput,
                      "lattice.spacing");
  auto bad = good;
  bad.spacing = 0.0;
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.spacing");
  bad = good;
  bad.axes(0, 1) = 0.1;
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.rotation");
  bad = good;
  bad.axes = -Matrix3d::Identity();
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.rotation");
  bad = good;
  bad.constants.k1 = -1.0;
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.constants");
  bad = good;
  bad.constants.k2 = bad.constants.k3 = 0.0;
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.constants");
  bad = good;
  bad.model = ModelKind::published;
  EXPECT_THROW_SAYING(lattice::build_free_block(rubber, bad, cells), meshes::InvalidInput,
                      "lattice.model");
}
