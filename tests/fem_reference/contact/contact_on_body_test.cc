/// The laws of contact at every node of the elastic tip itself.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>

#include "fem_reference/contact/plane_contact.h"
#include "fem_reference/solvers/field_solver.h"
#include "fem_reference/tip/tip_body.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::FieldSolver;
using fem_reference::HookeKernel;
using fem_reference::LinearSystem;
using fem_reference::NodeStatus;
using fem_reference::PlaneContact;
using meshes::ContactMode;

namespace {

const meshes::Rubber rubber;
const double R = meshes::Geometry{}.tip_radius;

/// Half a tip of linear rubber under the plane, on any number of processes.
struct Tip {
  std::unique_ptr<Body<3>> body;
  std::unique_ptr<LinearSystem> system;
  std::unique_ptr<FieldSolver> solver;
  std::unique_ptr<PlaneContact> contact;

  Tip(ContactMode mode, double friction) {
    const SharedMesh mesh(0.4, meshes::Sector::half);
    body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), 2, 0.0);
    body->number(fem_reference::tip_supports<3>());
    HookeKernel<3> kernel(rubber, fem_reference::Volumetric::mean_dilatation);
    const bool serial = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
    system = std::make_unique<LinearSystem>(*body, !serial);
    assemble(*body, kernel, body->fine.vector(), *system);
    auto unknowns = contact_unknowns(within_reach(outer_nodes(*body), {}, R, 0.2 * R),
                                     mode != ContactMode::frictionless);
    solver = serial ? make_condensed_solver(*body, unknowns.unknowns)
                    : make_multigrid_solver(*body, unknowns.unknowns, 1e-12);
    solver->set_matrix(*system);
    contact =
        std::make_unique<PlaneContact>(std::move(unknowns), mode, fem_reference::PlanePose{R, 0.0},
                                       friction, rubber.shear_modulus);
  }

  void press(double indentation, double shift) {
    contact->solve(*solver, {R - indentation, shift});
    contact->commit();
  }
  meshes::Vector3 resultant() const {
    meshes::Vector3 sum = meshes::Vector3::Zero();
    for (std::size_t i = 0; i < contact->status().size(); ++i) sum += contact->reaction(i);
    return sum;
  }
};

/// Signorini's conditions: nothing behind the plane, no pull, no push at a distance.
void expect_unilateral(const Tip& tip) {
  const double push = -tip.resultant().z();
  int touching = 0;
  for (std::size_t i = 0; i < tip.contact->status().size(); ++i) {
    const double gap = tip.contact->gap(i), force = -tip.contact->reaction(i).z();
    EXPECT_GE(gap, -1e-11);
    EXPECT_GE(force, -1e-7 * push);
    EXPECT_LE(std::abs(gap * force), 1e-11 * push);
    touching += tip.contact->status()[i] != NodeStatus::open;
  }
  EXPECT_EQ(touching, tip.contact->active_nodes());
  EXPECT_GT(touching, 10);
}

TEST(ContactOnBody, PushesWhereItTouchesAndNowhereElse) {
  for (const ContactMode mode : {ContactMode::frictionless, ContactMode::stick}) {
    Tip tip(mode, 0.0);
    for (const double indentation : {4e-4, 8e-4, 1.2e-3}) {
      tip.press(indentation, 0.0);
      expect_unilateral(tip);
    }
    const meshes::Vector3 sum = tip.resultant();
    EXPECT_NEAR(sum.x() / sum.z(), 0.0, 1e-7);  // the half is symmetric about x = 0
    if (mode == ContactMode::frictionless) {
      EXPECT_EQ(sum.y(), 0.0);
    }
  }
}

/// Coulomb's law at every node: within the cone, at rest where it sticks, against the slip where it
/// slides.
void expect_coulomb(const PlaneContact& contact, const PlaneContact::State& before, double mu) {
  const PlaneContact::State& after = contact.committed();
  const double shift = after.pose.shift - before.pose.shift, push = after.reaction.norm();
  for (std::size_t i = 0; i < after.status.size(); ++i) {
    const Eigen::Vector2d force = contact.reaction(i).head<2>();
    const double limit = mu * -contact.reaction(i).z();
    EXPECT_LE(force.norm(), limit + 1e-7 * push);
    if (after.status[i] == NodeStatus::open || before.status[i] == NodeStatus::open) continue;
    Eigen::Vector2d slip(-shift, 0.0), held(0.0, 0.0);
    const auto& of = contact.unknowns().of_node[i];
    for (std::size_t c = 0; c < 2; ++c) {
      if (of[c] < 0) slip[Eigen::Index(c)] = 0.0;
      if (of[c] >= 0)
        slip[Eigen::Index(c)] += after.displacement[of[c]] - before.displacement[of[c]];
    }
    if (after.status[i] == NodeStatus::stick) {
      EXPECT_LT(slip.norm(), 1e-10);
    } else if (slip.norm() > 1e-9) {
      EXPECT_LT((force + limit * slip.normalized()).norm(), 1e-4 * limit + 1e-6 * push);
    }
  }
}

TEST(ContactOnBody, FrictionFollowsCoulombAtEveryNode) {
  const double mu = 0.25;
  Tip tip(ContactMode::coulomb, mu);
  const double path[][2] = {{3e-4, 0},    {6e-4, 0},      {1e-3, 0},    {1e-3, 2e-5},  {1e-3, 6e-5},
                            {1e-3, 4e-4}, {1e-3, 1.5e-3}, {1e-3, 3e-3}, {1e-3, 2.9e-3}};
  int sliding = 0, sticking = 0;
  for (const auto& [indentation, shift] : path) {
    SCOPED_TRACE(shift);
    const PlaneContact::State before = tip.contact->committed();
    tip.press(indentation, shift);
    expect_unilateral(tip);
    expect_coulomb(*tip.contact, before, mu);
    const meshes::Vector3 sum = tip.resultant();
    EXPECT_LE(std::abs(sum.x()), -mu * sum.z() * (1 + 1e-7));
    sliding += int(std::ranges::count(tip.contact->status(), NodeStatus::slide));
    sticking += int(std::ranges::count(tip.contact->status(), NodeStatus::stick));
    if (shift == 3e-3) {  // gross sliding
      EXPECT_NEAR(sum.x() / (-mu * sum.z()), 1.0, 1e-5);
    }
  }
  EXPECT_GT(sliding, 50);
  EXPECT_GT(sticking, 50);
}

}  // namespace
