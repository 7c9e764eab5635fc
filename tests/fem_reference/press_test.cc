#include "fem_reference/press.h"

#include <deal.II/base/mpi.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "meshes/errors.h"
#include "meshes/volume_mesh.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using fem_reference::ContactPoint;
using fem_reference::ContinuumPress;
using fem_reference::LinearSolver;
using fem_reference::PressState;
using meshes::ContactMode;

namespace {

/// Trilinos wants MPI to be running.
class MpiEnvironment : public ::testing::Environment {
 public:
  void SetUp() override {
    mpi_ = std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(argc_, argv_, 1);
  }
  void TearDown() override { mpi_.reset(); }

 private:
  int argc_ = 1;
  std::string name_ = "test";
  std::array<char*, 2> arguments_{name_.data(), nullptr};
  char** argv_ = arguments_.data();
  std::unique_ptr<dealii::Utilities::MPI::MPI_InitFinalize> mpi_;
};
const auto* const mpi_environment = ::testing::AddGlobalTestEnvironment(new MpiEnvironment);

struct Case {
  ContactMode contact = ContactMode::frictionless;
  double refinement = 0.5;
  double depth = 3e-3;
  meshes::Geometry geometry{};
  ContinuumPress::Options options{};
};

class Pressing {
 public:
  explicit Pressing(const Case& c)
      : mesh_(write_mesh(c)), press(c.geometry, {}, c.contact, c.depth, mesh_, c.options) {}

 private:
  std::filesystem::path write_mesh(const Case& c) const {
    meshes::write_tip_mesh(c.geometry, meshes::TipMeshOptions{}.refined(c.refinement),
                           folder_ / "tip.msh");
    return folder_ / "tip.msh";
  }
  TemporaryFolder folder_;
  std::filesystem::path mesh_;

 public:
  ContinuumPress press;
};

double force_at_depth(const Case& c) {
  return Pressing(c).press.advance(c.depth).sample.normal_force;
}

/// What the plane gives, the rod takes, and the pressures add up to it.
TEST(ContinuumPress, ForcesBalance) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    Case c;
    c.contact = mode;
    Pressing pressing(c);
    ContinuumPress& press = pressing.press;
    double previous = 0.0;
    for (const double indentation : {1e-4, 1e-3, 3e-3}) {
      const PressState state = press.advance(indentation);
      const meshes::Vector3 bond = press.tip().bond_reaction(press.displacement());
      EXPECT_NEAR(4 * bond.z() / state.sample.normal_force, 1.0, 1e-9);
      const Eigen::VectorXd plane = press.plane_force();
      double sum = 0.0, work = 0.0;
      for (const auto& node : press.tip().outer_nodes()) sum -= plane[node.dof[2]];
      EXPECT_NEAR(4 * sum / state.sample.normal_force, 1.0, 1e-12);
      // Clapeyron: the elastic energy is half the work of the final forces.
      work = plane.dot(press.displacement());
      const Eigen::VectorXd internal = press.tip().stiffness() * press.displacement();
      EXPECT_NEAR(press.displacement().dot(internal) / work, 1.0, 1e-9);
      EXPECT_GT(state.sample.normal_force, previous);
      previous = state.sample.normal_force;
    }
  }
}

/// Signorini's conditions at every candidate node.
TEST(ContinuumPress, PushesWhereItTouchesAndNowhereElse) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    Case c;
    c.contact = mode;
    Pressing pressing(c);
    ContinuumPress& press = pressing.press;
    press.advance(2e-3);
    const double plane = c.geometry.tip_radius - 2e-3;
    const Eigen::VectorXd force = press.plane_force();
    int touching = 0;
    for (const auto& node : press.tip().outer_nodes()) {
      const double gap = plane - node.position.z() - press.displacement()[node.dof[2]];
      const double push = -force[node.dof[2]];
      EXPECT_GE(gap, -1e-11);
      EXPECT_GE(push, -1e-12);
      EXPECT_LE(gap * push, 1e-14);
      touching += push > 0;
      if (mode == ContactMode::frictionless) {
        EXPECT_EQ(std::hypot(force[node.dof[0]], force[node.dof[1]]), 0.0);
      }
    }
    EXPECT_GT(touching, 50);
  }
}

/// The quarter is symmetric about x = y, so that lateral forces along x and y are equal and the
/// whole tip's cancel.
TEST(ContinuumPress, StickIsStifferSymmetricAndIndependentOfTheStep) {
  Case c;
  const double frictionless = force_at_depth(c);
  c.contact = ContactMode::stick;
  Pressing pressing(c);
  const double stick = pressing.press.advance(c.depth).sample.normal_force;
  EXPECT_GT(stick, 1.05 * frictionless);

  const Eigen::VectorXd force = pressing.press.plane_force();
  double fx = 0.0, fy = 0.0, fz = 0.0;
  for (const auto& node : pressing.press.tip().outer_nodes()) {
    fx += force[node.dof[0]];
    fy += force[node.dof[1]];
    fz += force[node.dof[2]];
  }
  EXPECT_NEAR(fx, fy, 1e-7 * std::abs(fx));  // the mesh is symmetric to 2e-9 R
  EXPECT_GT(std::abs(fx), 0.05 * std::abs(fz));

  c.options.step /= 2;
  EXPECT_NEAR(force_at_depth(c) / stick, 1.0, 3e-4);
  c.options.step *= 8;
  EXPECT_NEAR(force_at_depth(c) / stick, 1.0, 3e-3);
}

TEST(ContinuumPress, IsHomogeneousInLengthAndStiffness) {
  // Twice the lengths, thrice the stiffness: four times three the force.
  Case c;
  c.contact = ContactMode::stick;
  const double force = force_at_depth(c);
  const meshes::Rubber rubber;
  const meshes::Rubber stiffer{3 * rubber.youngs_modulus, 3 * rubber.shear_modulus, 500, 0};
  const meshes::Geometry larger{0.02, 0.01, 0.03, 0.06};
  const TemporaryFolder folder;
  meshes::write_tip_mesh(larger, meshes::TipMeshOptions{}.refined(0.5), folder / "tip.msh");
  ContinuumPress press(larger, stiffer, c.contact, 2 * c.depth, folder / "tip.msh", {});
  EXPECT_NEAR(press.advance(2 * c.depth).sample.normal_force / (12 * force), 1.0, 1e-6);
}

TEST(ContinuumPress, LinearElementsConvergeTowardQuadraticOnes) {
  Case c;
  c.refinement = 0.7;
  c.depth = 1e-3;
  const double quadratic = force_at_depth(c);
  c.options.degree = 1;
  c.refinement = 1.0;
  const double fine = force_at_depth(c);
  c.refinement = 0.5;
  const double coarse = force_at_depth(c);
  EXPECT_GT(coarse, fine);  // linear elements are too stiff
  EXPECT_GT(fine, quadratic);
  EXPECT_LT(fine / quadratic - 1, 0.5 * (coarse / quadratic - 1));
}

/// Two linear solvers that share nothing but the matrix.
TEST(ContinuumPress, MultigridAgreesWithTheFactorisation) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    Case c;
    c.contact = mode;
    c.depth = 1e-3;
    c.options.degree = 1;
    c.refinement = 1.0;
    c.options.step = 0.05;
    c.options.solver = LinearSolver::condensed;
    Pressing direct(c);
    c.options.solver = LinearSolver::multigrid;
    Pressing iterative(c);
    const PressState one = direct.press.advance(c.depth), two = iterative.press.advance(c.depth);
    EXPECT_EQ(one.cg_iterations, 0);
    EXPECT_GT(two.cg_iterations, 0);
    EXPECT_EQ(one.active_nodes, two.active_nodes);
    EXPECT_NEAR(two.sample.normal_force / one.sample.normal_force, 1.0, 1e-6);
    EXPECT_LT((direct.press.displacement() - iterative.press.displacement()).norm(),
              1e-5 * direct.press.displacement().norm());
  }
}

TEST(ContinuumPress, WorksWithoutASleeve) {
  Case c;
  const double with_sleeve = force_at_depth(c);
  c.geometry.sleeve_length = 0.0;
  const double without = force_at_depth(c);
  EXPECT_LT(without, with_sleeve);
  EXPECT_GT(without, 0.5 * with_sleeve);
}

TEST(ContinuumPress, StopsOnRequest) {
  Case c;
  c.options.stop_requested = [] { return true; };
  Pressing pressing(c);
  EXPECT_THROW(pressing.press.advance(1e-3), meshes::Interrupted);
}

/// Hertz's pressure on nodes of a regular grid, whose outermost node misses the edge.
TEST(ContactEdge, FindsTheEdgeBetweenNodes) {
  for (const double edge : {0.96, 1.0, 1.04}) {
    std::vector<ContactPoint> contact;
    const double spacing = 0.1;
    for (int i = 0; i * spacing < edge; ++i)
      contact.push_back({i * spacing, std::sqrt(1 - std::pow(i * spacing / edge, 2))});
    EXPECT_NEAR(fem_reference::contact_edge(contact, spacing), edge, 1e-9);
  }
  EXPECT_EQ(fem_reference::contact_edge({}, 0.1), 0.0);
  EXPECT_EQ(fem_reference::contact_edge({{0.0, 1.0}}, 0.1), 0.0);
}

}  // namespace
