#include "lattice/model/model.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <set>

#include "lattice/statics/cube.h"
#include "meshes/cells/cubic_grid.h"
#include "tests/expectations.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;

namespace {

LatticeModel published_tip(int per_radius) {
  return tip(ModelKind::published, Kinematics::finite, per_radius);
}

}  // namespace

TEST(PublishedModel, CountMatchesThePapersEstimate) {
  const meshes::Geometry geometry;
  const auto ratio = [&](int per_radius) {
    return double(published_tip(per_radius).particles.size()) /
           meshes::expected_particle_count(geometry, 0.01 / per_radius);
  };
  EXPECT_NEAR(ratio(7), 1.0, 0.12);
  EXPECT_NEAR(ratio(24), 1.0, 0.012);
}

TEST(PublishedModel, EqualMassesAddUpToTheTip) {
  const LatticeModel model = published_tip(7);
  const double exact = 500.0 * meshes::Geometry{}.tip_volume();
  EXPECT_NEAR(model.total_mass(), exact, 1e-12 * exact);
  for (const std::size_t i : model.particles) {
    EXPECT_DOUBLE_EQ(model.mass[i], exact / double(model.particles.size()));
  }
}

TEST(PublishedModel, JoinsEveryTwoParticlesNoFartherThanTheBodyDiagonal) {
  const LatticeModel model = published_tip(5);
  std::size_t pairs = 0;
  for (std::size_t a = 0; a < model.particles.size(); ++a) {
    for (std::size_t b = a + 1; b < model.particles.size(); ++b) {
      const double distance =
          (model.rest_position(model.particles[a]) - model.rest_position(model.particles[b]))
              .norm();
      pairs += distance < 1.8 * model.spacing();
    }
  }
  EXPECT_EQ(model.spring_count(), pairs);
}

TEST(PublishedModel, ConstantsAndDampersFollowThePaper) {
  const LatticeModel model = published_tip(7);
  const double a = model.spacing(), m = model.mass[model.particles.front()];
  const meshes::Rubber rubber;
  const double lengths[3] = {a, a * std::sqrt(2.0), a * std::sqrt(3.0)};
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_NEAR(model.stiffness[f], rubber.youngs_modulus * a * a / lengths[f], 1e-12);
    EXPECT_NEAR(model.damping[f], 2.0 * std::sqrt(0.5 * m * model.stiffness[f]), 1e-15);
  }
}

TEST(PublishedModel, LigamentsHoldExactlyTheParticlesNextToTheRod) {
  const LatticeModel model = published_tip(8);
  std::set<std::size_t> held;
  for (const auto& ligament : model.ligaments) held.insert(ligament.particle);
  EXPECT_EQ(held.size(), model.ligaments.size());
  for (const std::size_t i : model.particles) {
    const double distance = meshes::Geometry::radial_distance(model.rest_position(i));
    EXPECT_EQ(held.count(i) == 1, distance <= 0.005 + model.spacing() + 1e-9) << distance;
  }
}

TEST(CellModels, WeightsAreSharesOfTheCellsAround) {
  const LatticeModel model = block(ModelKind::central, Kinematics::small, {3, 2, 4});
  std::array<double, 3> total{};
  for (int s = 0; s < lattice::directions; ++s) {
    for (const double w : model.weight[std::size_t(s)]) {
      EXPECT_GE(w, 0.0);
      EXPECT_LE(w, 1.0);
      total[lattice::half_stencil[std::size_t(s)].family] += w;
    }
  }
  const double cells = 3 * 2 * 4;  // each cell owns 12/4 edges, 12/2 face and 4 body diagonals
  EXPECT_NEAR(total[0], 3.0 * cells, 1e-12);
  EXPECT_NEAR(total[1], 6.0 * cells, 1e-12);
  EXPECT_NEAR(total[2], 4.0 * cells, 1e-12);
}

TEST(LatticeModel, MatrixOfABlockIsThatOfItsForces) {
  for (const ModelKind kind : {ModelKind::published, ModelKind::central, ModelKind::hookean}) {
    const LatticeModel model = block(kind, Kinematics::small, {2, 1, 3}, 0.0);
    const lattice::LatticeBody body = lattice::body_of_block(model);
    const lattice::ElasticSystem system(body);
    Eigen::VectorXd force;
    auto lower = system.empty_tangent();
    system.assemble(Eigen::VectorXd::Zero(body.unknowns()), force, &lower);
    const Eigen::MatrixXd matrix = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const Eigen::MatrixXd from_forces = tangent(model, lattice::State(model));
    EXPECT_LT((matrix - from_forces).norm(), 1e-10 * matrix.norm()) << name(kind);
  }
}

TEST(LatticeModel, BlocksCoverEveryParticleOnceWithoutCrossingRows) {
  for (const ModelKind kind : all_models) {
    const LatticeModel model = tip(kind, Kinematics::small, 7);
    std::vector<int> times(model.points(), 0);
    for (const std::size_t begin : model.blocks) {
      for (std::size_t lane = 0; lane < lattice::lanes; ++lane) ++times[begin + lane];
    }
    for (const std::size_t i : model.particles) EXPECT_EQ(times[i], 1);
  }
}

TEST(LatticeModel, EveryNeighbourOfAParticleHasAnIndex) {
  const LatticeModel model = tip(ModelKind::hookean, Kinematics::small, 6);
  const std::size_t reach = std::size_t(lattice::neighbour_offset(model.grid.size, 12));
  EXPECT_GE(model.particles.front(), reach);
  EXPECT_LT(model.particles.back() + reach, model.grid.points());
}

TEST(LatticeModel, StiffnessHasTheCubesSymmetry) {
  // Permuting the axes of a cube of lattice permutes its stiffness matrix and nothing else.
  for (const ModelKind kind : {ModelKind::published, ModelKind::central, ModelKind::hookean}) {
    const double a = 1e-3;
    const auto cube = lattice::cube_lattice(kind, constants_for(kind, {}, a), a, 2);
    const Eigen::MatrixXd k(cube.stiffness);
    Eigen::MatrixXd turned(k.rows(), k.cols());
    const auto image = [](Eigen::Index dof) {  // x -> y -> z -> x, particles and components
      const Eigen::Index p = dof / 3, i = p % 3, j = p / 3 % 3, l = p / 9;
      return 3 * (l + 3 * i + 9 * j) + (dof + 1) % 3;
    };
    for (Eigen::Index r = 0; r < k.rows(); ++r) {
      for (Eigen::Index c = 0; c < k.cols(); ++c) turned(image(r), image(c)) = k(r, c);
    }
    EXPECT_LT((k - turned).norm(), 1e-12 * k.norm()) << lattice::name(kind);
    EXPECT_LT((k - k.transpose()).norm(), 1e-14 * k.norm());
  }
}

TEST(CubeLattice, UniformStrainOfTheHookeanCubeStoresTheContinuumsEnergy) {
  // E, G and nu are exact for any k3, so the energy of any uniform strain must be the rubber's.
  const meshes::Rubber rubber;
  const double a = 1e-3;
  const int n = 3;
  for (const double share : {0.0, 0.3, 0.7}) {
    const auto constants = lattice::hookean_constants(rubber, a, share * a * rubber.shear_modulus);
    const auto cube = lattice::cube_lattice(ModelKind::hookean, constants, a, n);
    Eigen::Matrix3d strain;
    strain << 1.0, 0.4, -0.3, 0.4, -0.5, 0.7, -0.3, 0.7, 0.2;
    Eigen::VectorXd u(3 * Eigen::Index(cube.positions.size()));
    for (std::size_t p = 0; p < cube.positions.size(); ++p) {
      u.segment<3>(3 * Eigen::Index(p)) = strain * cube.positions[p];
    }
    const double stored = 0.5 * u.dot(cube.stiffness * u);
    const double exact =
        std::pow(n * a, 3) * (0.5 * rubber.lame_lambda() * strain.trace() * strain.trace() +
                              rubber.shear_modulus * strain.squaredNorm());
    EXPECT_NEAR(stored, exact, 1e-12 * exact);
  }
}

TEST(LatticeModel, PublishedAloneHasNoCellsToCut) {
  EXPECT_THROW_SAYING(
      lattice::build_published_tip({}, {}, settings_for(ModelKind::hookean, Kinematics::small, 8)),
      meshes::InvalidInput, "lattice.model");
  EXPECT_THROW_SAYING(
      lattice::build_cut_model({}, {}, settings_for(ModelKind::published, Kinematics::small, 8)),
      meshes::InvalidInput, "lattice.model");
}

TEST(BuildTip, RefusesWhatCannotBeALattice) {
  auto settings = settings_for(ModelKind::hookean, Kinematics::small, 8);
  settings.spacing = 0.003;
  EXPECT_THROW_SAYING(lattice::build_tip({}, {}, settings), meshes::InvalidInput,
                      "lattice.spacing");
  settings = settings_for(ModelKind::hookean, Kinematics::small, 8);
  settings.constants.k1 = std::nan("");
  EXPECT_THROW_SAYING(lattice::build_tip({}, {}, settings), meshes::InvalidInput,
                      "lattice.constants");
  EXPECT_THROW_SAYING(lattice::cube_lattice(ModelKind::central, {1.0, 1.0, 1.0, 0.0}, 1e-3, 0),
                      meshes::InvalidInput, "lattice.spacing");
}
