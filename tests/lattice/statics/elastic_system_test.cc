#include "lattice/statics/elastic_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "body_sums.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/base/errors.h"

using namespace fingertip;
using namespace body_sums;
using lattice::ElasticSystem;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::Tangent;

namespace {

constexpr double spacing = 2.5e-3;

lattice::LatticeSettings settings_for(ModelKind model, Kinematics kinematics) {
  lattice::LatticeSettings settings;
  settings.model = model;
  settings.kinematics = kinematics;
  settings.spacing = spacing;
  const meshes::Rubber rubber;
  settings.constants =
      lattice::hookean_constants(rubber, spacing, 0.2 * spacing * rubber.shear_modulus);
  return settings;
}

struct Model : lattice::LatticeSettings {
  meshes::Rubber rubber;
};

/// Runs `check(model)` for the models made of cells, in both kinematics, and for laws of large
/// strain whose cells hold their fibres.
template <typename Check>
void for_all_models(const Check& check) {
  for (const ModelKind model : {ModelKind::central, ModelKind::hookean, ModelKind::network}) {
    for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
      SCOPED_TRACE(std::string(name(model)) + ", " + std::string(name(kinematics)));
      check(Model{settings_for(model, kinematics), {}});
    }
  }
  using meshes::RubberLaw, meshes::VolumetricLaw;
  for (const meshes::StrainEnergy& energy : std::initializer_list<meshes::StrainEnergy>{
           {RubberLaw::yeoh, VolumetricLaw::logarithmic, {0.1, 0.02}},
           {RubberLaw::mooney_rivlin, VolumetricLaw::quadratic, {0.3}},
           {RubberLaw::ogden, VolumetricLaw::quadratic, {0.8, 1.3, 0.2, 5.0}},
           {RubberLaw::gent, VolumetricLaw::isochoric_logarithmic, {20.0}}}) {
    SCOPED_TRACE(describe(energy));
    Model model{settings_for(ModelKind::network, Kinematics::finite), {}};
    model.rubber.energy = energy;
    check(model);
  }
}

LatticeBody quarter_tip(const Model& model) {
  return build_cut_tip({}, model.rubber, model, 4);
}

LatticeBody block(const Model& model) {
  return build_free_block(model.rubber, model, {3, 2, 2});
}

VectorXd random_displacement(const LatticeBody& body, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  return VectorXd::NullaryExpr(body.unknowns(), [&] { return uniform(generator); });
}

/// A smooth field, so that cells cut to slivers keep their orientation, too.
VectorXd smooth_displacement(const LatticeBody& body) {
  return on_particles(body, [](const Vector3& x) -> Vector3 {
    const Vector3 q = 100.0 * x;
    return 1e-3 * Vector3(std::sin(q.y() + 0.3), q.x() * q.z() - 0.4 * q.y(),
                          std::cos(q.x()) + 0.5 * q.z() * q.z());
  });
}

VectorXd force_of(const ElasticSystem& system, const VectorXd& u) {
  VectorXd force;
  system.assemble(u, force, nullptr);
  return force;
}

}  // namespace

/// Against sums taken straight from lattice_body.h.
TEST(ElasticSystem, EnergyIsTheSumOfItsTerms) {
  for_all_models([](const auto& settings) {
    const LatticeBody body = quarter_tip(settings);
    const VectorXd u = smooth_displacement(body);
    const double expected = elastic_energy(body, u) + bond_energy(body, u);
    EXPECT_NEAR(ElasticSystem(body).energy(u), expected, 1e-12 * expected);
  });
}

TEST(ElasticSystem, ForceIsMinusTheGradientOfTheEnergy) {
  for_all_models([](const auto& settings) {
    for (const LatticeBody& body : {block(settings), quarter_tip(settings)}) {
      const ElasticSystem system(body);
      const VectorXd u = smooth_displacement(body), force = force_of(system, u);
      const double step = 1e-8;
      for (unsigned seed = 0; seed < 5; ++seed) {
        const VectorXd d = random_displacement(body, 1.0, seed);
        const double slope =
            (system.energy(u + step * d) - system.energy(u - step * d)) / (2 * step);
        EXPECT_NEAR(-force.dot(d), slope, 1e-6 * force.norm() * d.norm());
      }
    }
  });
}

TEST(ElasticSystem, TangentIsTheDerivativeOfTheForce) {
  for_all_models([](const auto& settings) {
    for (const LatticeBody& body : {block(settings), quarter_tip(settings)}) {
      const ElasticSystem system(body);
      const VectorXd u = smooth_displacement(body);
      VectorXd force;
      Tangent tangent = system.empty_tangent();
      system.assemble(u, force, &tangent);
      const double step = 1e-8;
      for (unsigned seed = 0; seed < 5; ++seed) {
        const VectorXd d = random_displacement(body, 1.0, seed);
        const VectorXd slope =
            (force_of(system, u - step * d) - force_of(system, u + step * d)) / (2 * step);
        const VectorXd product = tangent.selfadjointView<Eigen::Lower>() * d;
        EXPECT_LT((product - slope).norm(), 1e-6 * slope.norm());
      }
    }
  });
}

/// Infinitesimal rigid motion at small strain, a turn by 1 rad at finite strain.
TEST(ElasticSystem, RigidMotionOfAFreeBodyCostsNothing) {
  for_all_models([](const auto& settings) {
    LatticeBody body = quarter_tip(settings);
    body.bond.clear();
    const ElasticSystem system(body);
    Matrix3d motion;
    if (body.finite) {
      motion = Eigen::AngleAxisd(1.0, Vector3(1.0, -2.0, 0.5).normalized()).toRotationMatrix() -
               Matrix3d::Identity();
    } else {
      motion << 0.0, -0.3, 0.7, 0.3, 0.0, -0.2, -0.7, 0.2, 0.0;
    }
    const auto field = [&](const Vector3& x) -> Vector3 {
      return motion * x + Vector3(0.002, -0.001, 0.003);
    };
    const VectorXd rigid = on_particles(body, field);
    const VectorXd strained = on_particles(
        body, [](const Vector3& x) -> Vector3 { return Vector3(0.3 * x.x(), 0.2 * x.x(), 0.0); });
    EXPECT_LT(std::abs(system.energy(rigid)), 1e-11 * system.energy(strained));
    EXPECT_LT(force_of(system, rigid).norm(), 1e-11 * force_of(system, strained).norm());
  });
}

TEST(ElasticSystem, RestIsFreeOfForce) {
  for_all_models([](const auto& settings) {
    const LatticeBody body = quarter_tip(settings);
    const ElasticSystem system(body);
    const VectorXd rest = VectorXd::Zero(body.unknowns());
    EXPECT_EQ(system.energy(rest), 0.0);
    EXPECT_LT(force_of(system, rest).norm(),
              1e-12 * force_of(system, smooth_displacement(body)).norm());
  });
}

/// Newton's third law; moments about present positions at finite strain.
TEST(ElasticSystem, InternalForcesBalance) {
  for_all_models([](const auto& settings) {
    LatticeBody body = quarter_tip(settings);
    body.bond.clear();
    const VectorXd u = smooth_displacement(body), force = force_of(ElasticSystem(body), u);
    Vector3 sum = Vector3::Zero(), moment = sum;
    double scale = 0.0;
    for (std::uint32_t p = 0; p < body.rest.size(); ++p) {
      const Vector3 x = body.finite ? Vector3(body.rest[p] + at(u, p)) : body.rest[p];
      sum += at(force, p);
      moment += x.cross(at(force, p));
      scale += at(force, p).norm();
    }
    EXPECT_LT(sum.norm(), 1e-12 * scale);
    EXPECT_LT(moment.norm(), 1e-12 * scale * meshes::Geometry{}.tip_radius);
  });
}

TEST(ElasticSystem, EmbeddedPointsAddTheirBlockToTheTangent) {
  const LatticeBody body = quarter_tip({settings_for(ModelKind::hookean, Kinematics::small), {}});
  const ElasticSystem system(body);
  Matrix3d block;
  block << 3.0, 0.5, -0.2, 0.5, 2.0, 0.7, -0.2, 0.7, 4.0;
  Tangent tangent = system.empty_tangent();
  double expected = 0.0;
  const VectorXd d = random_displacement(body, 1.0, 7);
  for (const EmbeddedPoint& point : body.outer) {
    system.add_embedded(point, block, tangent);
    const Vector3 shift = displacement(point, d);
    expected += shift.dot(block * shift);
    EXPECT_EQ(lattice::shift(point, d), shift);
    EXPECT_EQ(lattice::position(point, d), point.rest + shift);
  }
  EXPECT_NEAR(d.dot(tangent.selfadjointView<Eigen::Lower>() * d), expected, 1e-12 * expected);
  EXPECT_EQ(tangent.nonZeros(), system.empty_tangent().nonZeros());
}

TEST(ElasticSystem, CellsTurnedInsideOutAreNoted) {
  const LatticeBody body = block({settings_for(ModelKind::network, Kinematics::finite), {}});
  const ElasticSystem system(body);
  const auto stretched = [&](double by) {
    return on_particles(body, [by](const Vector3& x) -> Vector3 { return {0.0, 0.0, by * x.z()}; });
  };
  EXPECT_NEAR(system.smallest_jacobian(stretched(-0.7)), 0.3, 1e-14);
  EXPECT_NEAR(system.smallest_jacobian(stretched(0.5)), 1.5, 1e-14);
  EXPECT_EQ(system.energy(stretched(-1.2)), std::numeric_limits<double>::infinity());
  EXPECT_THROW(force_of(system, stretched(-1.2)), meshes::NotConverged);
  EXPECT_FALSE(system.linear());
  const LatticeBody small = block({settings_for(ModelKind::network, Kinematics::small), {}});
  EXPECT_TRUE(ElasticSystem(small).linear());
}
