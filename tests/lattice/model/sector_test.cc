#include "lattice/model/sector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "lattice/contact/bond.h"
#include "lattice/forces/energy.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::Matrix6;
using lattice::ModelKind;
using lattice::Sector;
using lattice::Vector6;
using lattice::Wrench;

namespace {

/// x, y and z turn to the next axis, as in grids of cut tips.
Eigen::Matrix3d renamed() {
  Eigen::Matrix3d axes;
  axes << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0;
  return axes;
}

std::vector<Vector3> mirrors(int count) {
  std::vector<Vector3> signs{{1.0, 1.0, 1.0}};
  if (count > 1) signs.emplace_back(1.0, -1.0, 1.0);
  if (count > 2) {
    signs.emplace_back(-1.0, 1.0, 1.0);
    signs.emplace_back(-1.0, -1.0, 1.0);
  }
  return signs;
}

Vector6 along(const Eigen::Matrix3d& axes, const Wrench& wrench) {
  Vector6 result;
  result << axes.transpose() * wrench.force, axes.transpose() * wrench.torque;
  return result;
}

/// Places of particles, to a hundredth of a spacing.
std::array<long, 3> key_of(const LatticeModel& model, const Vector3& rest) {
  const Vector3 place = 100.0 / model.spacing() * rest;
  return {std::lround(place.x()), std::lround(place.y()), std::lround(place.z())};
}

}  // namespace

/// Against forces at places of the part and their mirror images, one by one.
TEST(Sector, SumsUpWhatItsMirrorImagesDo) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto vector = [&] {
    return Vector3(uniform(generator), uniform(generator), uniform(generator));
  };
  const Eigen::Matrix3d axes = renamed();
  for (const int count : {1, 2, 4}) {
    const Sector sector(count, axes);
    Wrench part, whole;
    Matrix6 inertia = Matrix6::Zero(), all = Matrix6::Zero();
    for (int n = 0; n < 5; ++n) {
      const Vector3 at = vector(), force = vector();
      part.force += force;
      part.torque += at.cross(force);
      inertia += lattice::rigid_inertia(1.0 + n, at);
      for (const Vector3& mirror : mirrors(count)) {
        const Vector3 there = mirror.cwiseProduct(at), pull = mirror.cwiseProduct(force);
        whole.force += pull;
        whole.torque += there.cross(pull);
        all += lattice::rigid_inertia(1.0 + n, there);
      }
    }
    const Wrench sum = sector.whole(part);
    EXPECT_LT((sum.force - whole.force).norm(), 1e-12) << count;
    EXPECT_LT((sum.torque - whole.torque).norm(), 1e-12) << count;
    EXPECT_LT((sector.whole(part.force) - whole.force).norm(), 1e-12) << count;
    EXPECT_LT((sector.whole_on_grid(along(axes, part)) - along(axes, whole)).norm(), 1e-12);
    // Of motions that are their own mirror images, all that the rod can do.
    const Wrench motion = sector.even({vector(), vector()});
    const Vector6 moved = along(Eigen::Matrix3d::Identity(), motion);
    EXPECT_LT((sector.whole(inertia) * moved - all * moved).norm(), 1e-12) << count;
    Matrix6 turn = Matrix6::Zero();
    turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = axes;
    EXPECT_LT((sector.whole_on_grid(Matrix6(turn.transpose() * inertia * turn)) -
               turn.transpose() * sector.whole(inertia) * turn)
                  .norm(),
              1e-12);
  }
}

/// Particle by particle, in whole tips and their parts.
TEST(Sector, OfATipHasTheWholesParticlesAndItsShareOfTheirMasses) {
  for (const ModelKind kind : all_models) {
    const lattice::LatticeSettings settings = settings_for(kind, Kinematics::finite, 6);
    const LatticeModel whole = lattice::build_tip({}, {}, settings);
    std::map<std::array<long, 3>, std::uint32_t> at;
    for (const std::uint32_t p : whole.particles) at[key_of(whole, whole.rest_position(p))] = p;
    for (const int count : {2, 4}) {
      const LatticeModel part = lattice::build_tip({}, {}, settings, count);
      SCOPED_TRACE(std::string(name(kind)) + ", " + std::to_string(count));
      double images = 0.0;
      for (const std::uint32_t p : part.particles) {
        const Vector3 rest = part.rest_position(p);
        const auto found = at.find(key_of(part, rest));
        ASSERT_NE(found, at.end());
        const double planes =
            double(std::abs(rest.y()) < 1e-9) + double(count == 4 && std::abs(rest.x()) < 1e-9);
        const double share = std::pow(0.5, planes);
        images += count * share;
        // What light particles are given follows from moments that are integrated to 1e-7.
        ASSERT_NEAR(part.mass[p] / (share * whole.mass[found->second]), 1.0, 1e-6);
      }
      EXPECT_EQ(std::lround(images), long(whole.particles.size()));
      EXPECT_NEAR(part.total_mass(), whole.total_mass(), 1e-9 * whole.total_mass());
      EXPECT_NEAR(part.added_mass, whole.added_mass, 1e-6 * whole.added_mass);
      EXPECT_EQ(part.cells.size() * std::size_t(count), whole.cells.size());
    }
  }
}

/// What the parts store together is what the whole does in the mirrored state.
TEST(Sector, OfATipStoresItsShareOfTheEnergy) {
  for (const ModelKind kind : all_models) {
    const lattice::LatticeSettings settings = settings_for(kind, Kinematics::finite, 6);
    const LatticeModel whole = lattice::build_tip({}, {}, settings),
                       part = lattice::build_tip({}, {}, settings, 4);
    const auto moved = [](const LatticeModel& model) {
      lattice::State state(model);
      for (const std::uint32_t p : model.particles) {
        const Vector3 x = model.rest_position(p);
        const Vector3 u = {2.0 * x.x() * x.z(), -3.0 * x.y() * (x.z() + 5.0 * x.x() * x.x()),
                           x.squaredNorm()};
        state.displacement.set(p, model.grid.axes.transpose() * (10.0 * u));
        state.velocity.set(p, model.grid.axes.transpose() * u);
      }
      return state;
    };
    const lattice::State of_whole = moved(whole), of_part = moved(part);
    const double stored = lattice::elastic_energy(whole, of_whole),
                 kinetic = lattice::kinetic_energy(whole, of_whole),
                 bond = lattice::ligament_energy(whole, of_whole, {});
    SCOPED_TRACE(name(kind));
    EXPECT_NEAR(lattice::elastic_energy(part, of_part), stored, 1e-9 * stored);
    EXPECT_NEAR(lattice::kinetic_energy(part, of_part), kinetic, 1e-6 * kinetic);
    EXPECT_NEAR(4.0 * lattice::ligament_energy(part, of_part, {}), bond, 1e-9 * bond);
    const Vector3 momentum = lattice::linear_momentum(whole, of_whole);
    EXPECT_LT((lattice::linear_momentum(part, of_part) - momentum).norm(), 1e-6 * momentum.norm());
  }
}

TEST(Sector, DividesOnlyWhatIsSymmetric) {
  for (const ModelKind kind : {ModelKind::published, ModelKind::hookean}) {
    lattice::LatticeSettings settings = settings_for(kind, Kinematics::small, 6);
    EXPECT_THROW_SAYING(lattice::build_tip({}, {}, settings, 3), meshes::InvalidInput, "sectors");
    settings.offset = Vector3(0.3, 0.0, 0.0);
    EXPECT_THROW_SAYING(lattice::build_tip({}, {}, settings, 4), meshes::InvalidInput, "sectors");
    EXPECT_NO_THROW(lattice::build_tip({}, {}, settings, 2));
  }
}
