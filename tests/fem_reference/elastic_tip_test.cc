#include "fem_reference/elastic_tip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fem_reference/contact_solver.h"
#include "meshes/volume_mesh.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::ElasticTip;
using meshes::Vector3;

namespace {

ElasticTip make_tip(const meshes::Geometry& geometry, double refinement, int degree,
                    const meshes::Rubber& rubber = {}) {
  const TemporaryFolder folder;
  const auto file = folder / "tip.msh";
  meshes::write_tip_mesh(geometry, meshes::TipMeshOptions{}.refined(refinement), file);
  return ElasticTip(rubber, file, degree);
}

struct ExactMeasures {
  double volume, outer, bond, end;
};

/// Of the quarter tip.
ExactMeasures exact(const meshes::Geometry& g) {
  const double R = g.tip_radius, r = g.rod_radius, L = g.sleeve_length, pi = std::numbers::pi;
  return {g.tip_volume() / 4, (2 * pi * R * R + 2 * pi * R * L) / 4,
          (2 * pi * r * r + 2 * pi * r * L) / 4, pi * (R * R - r * r) / 4};
}

TEST(ElasticTip, CurvedSurfacesStayCurved) {
  for (const double length : {0.015, 0.0}) {
    meshes::Geometry geometry;
    geometry.sleeve_length = length;
    const ExactMeasures measures = exact(geometry);
    const auto error = [&](double refinement, int degree) {
      const ElasticTip tip = make_tip(geometry, refinement, degree);
      return std::array{std::abs(tip.volume() / measures.volume - 1),
                        std::abs(tip.area(meshes::Surface::outer) / measures.outer - 1),
                        std::abs(tip.area(meshes::Surface::bond) / measures.bond - 1),
                        std::abs(tip.area(meshes::Surface::end) / measures.end - 1)};
    };
    const auto coarse = error(0.5, 2), fine = error(1.0, 2), flat = error(1.0, 1);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_LT(fine[i], 2e-6) << i;
      EXPECT_LT(fine[i], coarse[i] / 8) << i;  // h⁴ would be 16
      EXPECT_LT(fine[i], flat[i] / 100) << i;
    }
  }
}

TEST(ElasticTip, NodalAreasAddUp) {
  const meshes::Geometry geometry;
  for (const int degree : {1, 2}) {
    const ElasticTip tip = make_tip(geometry, 1.0, degree);
    double sum = 0.0;
    for (const auto& node : tip.outer_nodes()) {
      EXPECT_GT(node.area, 0.0);
      EXPECT_NEAR(meshes::Geometry::radial_distance(node.position), geometry.tip_radius, 1e-15);
      sum += node.area;
    }
    EXPECT_NEAR(sum / exact(geometry).outer, 1.0, degree == 2 ? 1e-5 : 5e-3);
  }
}

/// Linear displacement is in equilibrium: no force on nodes inside, and the exact energy.
TEST(ElasticTip, PatchTest) {
  const meshes::Geometry geometry;
  const meshes::Rubber rubber;
  Eigen::Matrix3d gradient;
  gradient << 0.3, -0.2, 0.5, 0.1, 0.7, -0.4, 0.6, 0.25, -0.9;
  const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
  const double density = rubber.lame_lambda() / 2 * std::pow(strain.trace(), 2) +
                         rubber.shear_modulus * strain.squaredNorm();
  for (const int degree : {1, 2}) {
    const ElasticTip tip = make_tip(geometry, 0.5, degree);
    Eigen::VectorXd u(tip.dofs());
    for (int i = 0; i < tip.dofs(); ++i)
      u[i] = gradient.row(tip.component_of_dof()[std::size_t(i)])
                 .dot(tip.nodes()[std::size_t(tip.node_of_dof()[std::size_t(i)])]);
    const Eigen::VectorXd force = tip.stiffness() * u;
    EXPECT_NEAR(u.dot(force) / 2 / (density * tip.volume()), 1.0, 1e-12);
    const double scale = force.cwiseAbs().maxCoeff();
    int inside = 0;
    for (int i = 0; i < tip.dofs(); ++i) {
      const Vector3& w = tip.nodes()[std::size_t(tip.node_of_dof()[std::size_t(i)])];
      if (geometry.signed_distance(w) > -1e-5 || w.x() < 1e-5 || w.y() < 1e-5) continue;
      EXPECT_LT(std::abs(force[i]), 1e-12 * scale);
      ++inside;
    }
    EXPECT_GT(inside, degree == 2 ? 1000 : 50);
  }
}

TEST(ElasticTip, RigidMotionsCostNoEnergyAndTheMatrixIsSymmetric) {
  const ElasticTip tip = make_tip({}, 0.5, 2);
  const double scale = tip.stiffness().coeffs().abs().maxCoeff();
  const Vector3 rotation(0.3, -0.5, 0.8), shift(0.01, 0.02, -0.03);
  Eigen::VectorXd u(tip.dofs());
  for (int i = 0; i < tip.dofs(); ++i) {
    const Vector3& w = tip.nodes()[std::size_t(tip.node_of_dof()[std::size_t(i)])];
    const Vector3 motion = shift + Vector3(rotation.y() * w.z() - rotation.z() * w.y(),
                                           rotation.z() * w.x() - rotation.x() * w.z(),
                                           rotation.x() * w.y() - rotation.y() * w.x());
    u[i] = motion[tip.component_of_dof()[std::size_t(i)]];
  }
  EXPECT_LT((tip.stiffness() * u).cwiseAbs().maxCoeff(), 1e-12 * scale * u.cwiseAbs().maxCoeff());
  const ElasticTip::Matrix transposed = tip.stiffness().transpose();
  EXPECT_LT((tip.stiffness() - transposed).norm(), 1e-13 * tip.stiffness().norm());
}

/// Lamé's hollow sphere: u_r = C (rho - r³/rho²) vanishes at the bond; half of it is the tip
/// without sleeve when its end may only slide.
TEST(ElasticTip, HollowSphereFollowsLame) {
  meshes::Geometry geometry;
  geometry.sleeve_length = 0.0;
  const meshes::Rubber rubber;
  const double C = 0.01, r = geometry.rod_radius, R = geometry.tip_radius;
  const auto radial = [&](double rho) { return C * (rho - r * r * r / (rho * rho)); };
  // sigma_rr = 3 K C + 4 G C r³/rho³, pushing on a quarter of the disc π R².
  const double stress =
      3 * rubber.bulk_modulus() * C + 4 * rubber.shear_modulus * C * std::pow(r / R, 3);
  const double exact_force = stress * std::numbers::pi * R * R / 4;

  std::array<double, 2> field_error{}, force_error{};
  for (std::size_t level = 0; level < 2; ++level) {
    const ElasticTip tip = make_tip(geometry, level == 0 ? 0.35 : 0.7, 2);
    std::vector<int> unknowns;
    std::vector<double> values;
    for (int i = 0; i < tip.dofs(); ++i) {
      if (tip.fixed()[std::size_t(i)]) continue;
      const Vector3& w = tip.nodes()[std::size_t(tip.node_of_dof()[std::size_t(i)])];
      const int component = tip.component_of_dof()[std::size_t(i)];
      const bool outer = w.norm() > R * (1 - 1e-9), end = w.z() < 1e-12 && component == 2;
      if (!outer && !end) continue;
      unknowns.push_back(i);
      values.push_back(outer ? radial(R) * w[component] / R : 0.0);
    }
    const auto solver = make_condensed_solver(tip, unknowns);
    const Eigen::Map<Eigen::VectorXd> wanted(values.data(), Eigen::Index(values.size()));
    const auto solution = solver->hold(std::vector<char>(unknowns.size(), 1), wanted);
    double force = 0.0;
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      const auto i = std::size_t(unknowns[k]);
      if (tip.component_of_dof()[i] == 2 &&
          tip.nodes()[std::size_t(tip.node_of_dof()[i])].z() > 1e-12)
        force += solution.reaction[Eigen::Index(k)];
    }
    force_error[level] = std::abs(force / exact_force - 1);
    const Eigen::VectorXd u = solver->field();
    for (int i = 0; i < tip.dofs(); ++i) {
      const Vector3& w = tip.nodes()[std::size_t(tip.node_of_dof()[std::size_t(i)])];
      const double exact_u =
          radial(w.norm()) * w[tip.component_of_dof()[std::size_t(i)]] / w.norm();
      field_error[level] = std::max(field_error[level], std::abs(u[i] - exact_u) / radial(R));
    }
  }
  EXPECT_LT(field_error[1], 1e-3);
  EXPECT_LT(field_error[1], field_error[0] / 4);
  EXPECT_LT(force_error[1], 2e-2);  // the reactions of the outer rim belong partly to the end
  EXPECT_LT(force_error[1], force_error[0]);
}

TEST(ElasticTip, RefusesAMissingMesh) {
  EXPECT_THROW(ElasticTip({}, "no/such/file.msh", 2), std::runtime_error);
}

}  // namespace
