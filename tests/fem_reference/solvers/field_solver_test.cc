#include "fem_reference/solvers/field_solver.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/dofs/dof_tools.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>

#include "fem_reference/tip/tip_body.h"
#include "meshes/base/errors.h"
#include "tests/fem_reference/shared_mesh.h"

using namespace fingertip;
using fem_reference::Body;
using fem_reference::ConstrainedSolution;
using fem_reference::ContactUnknowns;
using fem_reference::FieldSolver;
using fem_reference::HookeKernel;
using fem_reference::LinearSystem;
using fem_reference::Vector;
using fem_reference::Volumetric;

namespace {

/// A tip with or without hanging nodes, its stiffness, and the contact unknowns near the pole.
struct Problem {
  std::unique_ptr<Body<3>> body;
  std::unique_ptr<LinearSystem> system;
  ContactUnknowns contact;
  Vector load;

  Problem(int degree, bool hanging) {
    const SharedMesh mesh(degree == 1 ? 0.6 : degree == 2 ? 0.4 : 0.25);
    body = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), degree, 0.0);
    if (hanging) refine_pole();
    body->number(fem_reference::tip_supports<3>());
    HookeKernel<3> kernel(meshes::Rubber{}, Volumetric::mean_dilatation);
    system = std::make_unique<LinearSystem>(*body, true);
    assemble(*body, kernel, body->fine.vector(), *system);
    contact = contact_unknowns(within_reach(outer_nodes(*body), {}, 6e-3, 0.0), true);
    load = body->fine.vector();
    for (const auto i : body->fine.owned) load[i] = 1e-6 * std::sin(0.1 * double(i));
    load.compress(dealii::VectorOperation::insert);
  }

  void refine_pole() {
    for (const auto& cell : body->triangulation.active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->center().distance(dealii::Point<3>(0, 0, 0.01)) < 3.5e-3)
        cell->set_refine_flag();
    body->triangulation.execute_coarsening_and_refinement();
  }

  std::size_t size() const { return contact.unknowns.size(); }
};

/// What contact may ask for: nodes within `radius` stick or slide, displaced and loaded by waves.
struct Request {
  std::vector<char> held;
  Eigen::VectorXd values, loads;
};

Request request(const ContactUnknowns& contact, double radius, bool stick) {
  const std::size_t n = contact.unknowns.size();
  Request result{std::vector<char>(n, 0), Eigen::VectorXd::Zero(Eigen::Index(n)),
                 Eigen::VectorXd::Zero(Eigen::Index(n))};
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    const meshes::Vector3& w = contact.nodes[i].position;
    if (std::hypot(w.x(), w.y()) > radius) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const int k = contact.of_node[i][c];
      if (k < 0) continue;
      const bool hold = c == 2 || stick;
      result.held[std::size_t(k)] = hold;
      result.values[k] =
          c == 2 ? -1e-3 + 1e-4 * std::sin(1e3 * w.x()) : 1e-4 * std::cos(7e2 * w.y());
      if (!hold) result.loads[k] = 1e-4 * std::cos(1e3 * w.x());
    }
  }
  return result;
}

const std::array<std::pair<double, bool>, 4> stages{
    {{0.0, false}, {2e-3, true}, {5e-3, false}, {3e-3, true}}};

class FieldSolverTest : public ::testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  const Problem problem{std::get<0>(GetParam()), std::get<1>(GetParam())};
};

/// On any number of processes: A u = f + contact forces, and held unknowns where they belong.
TEST_P(FieldSolverTest, MultigridIsInEquilibrium) {
  const auto solver = make_multigrid_solver(*problem.body, problem.contact.unknowns, 1e-11);
  solver->set_matrix(*problem.system);
  solver->set_load(problem.load);
  for (const auto& [radius, stick] : stages) {
    const Request wanted = request(problem.contact, radius, stick);
    const ConstrainedSolution solution =
        solver->solve_constrained(wanted.held, wanted.values, wanted.loads);
    const Vector u = solver->field();
    Vector out_of_balance = problem.load;
    problem.system->matrix.vmult(out_of_balance, u);
    out_of_balance -= problem.load;
    const double scale = solution.reaction.norm();
    for (std::size_t i = 0; i < problem.size(); ++i) {
      const auto unknown = unsigned(problem.contact.unknowns[i]);
      const auto k = Eigen::Index(i);
      if (problem.body->fine.owned.is_element(unknown)) {
        out_of_balance[unknown] = double(out_of_balance[unknown]) - solution.reaction[k];
        EXPECT_EQ(double(u[unknown]), solution.displacement[k]);
      }
      if (wanted.held[i]) {
        EXPECT_EQ(solution.displacement[k], wanted.values[k]);
      } else {
        EXPECT_EQ(solution.reaction[k], wanted.loads[k]);
      }
    }
    for (const auto i : problem.body->fine.owned)
      if (problem.body->fine.constraints.is_constrained(i)) out_of_balance[i] = 0.0;
    out_of_balance.compress(dealii::VectorOperation::insert);
    EXPECT_LT(out_of_balance.l2_norm(), 1e-9 * scale);
    EXPECT_GT(solution.cg_iterations, 0);
    EXPECT_LT(solution.cg_iterations, 60);
  }
}

/// Two solvers that share nothing but the matrix. One process.
TEST_P(FieldSolverTest, CondensedAgreesWithMultigrid) {
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) GTEST_SKIP();
  const auto direct = make_condensed_solver(*problem.body, problem.contact.unknowns);
  const auto iterative = make_multigrid_solver(*problem.body, problem.contact.unknowns, 1e-12);
  for (const auto& solver : {direct.get(), iterative.get()}) {
    solver->set_matrix(*problem.system);
    solver->set_load(problem.load);
  }
  for (const auto& [radius, stick] : stages) {
    const Request wanted = request(problem.contact, radius, stick);
    const ConstrainedSolution by_factor =
        direct->solve_constrained(wanted.held, wanted.values, wanted.loads);
    const ConstrainedSolution by_iterations =
        iterative->solve_constrained(wanted.held, wanted.values, wanted.loads);
    EXPECT_LT((by_factor.displacement - by_iterations.displacement).norm(),
              1e-7 * by_factor.displacement.norm());
    EXPECT_LT((by_factor.reaction - by_iterations.reaction).norm(),
              1e-7 * by_factor.reaction.norm());
    Vector difference = direct->field();
    const double scale = difference.l2_norm();
    difference -= iterative->field();
    EXPECT_LT(difference.l2_norm(), 1e-7 * scale);
    EXPECT_EQ(by_factor.cg_iterations, 0);
  }
}

/// One that keeps what it knows while matrix and contact change, beside one that never saw another;
/// made by `make`, to be exact or to leave what Newton's method may.
void expect_to_keep_up(const Problem& problem,
                       const std::function<std::unique_ptr<FieldSolver>(bool exact)>& make) {
  const auto kept = make(false);
  double stiffness = 1.0;
  int corrections = 0;
  LinearSystem stiffer(*problem.body, true);
  for (const auto& [radius, stick] : stages) {
    meshes::Rubber rubber;
    rubber.shear_modulus *= stiffness;  // at the same E: not a multiple of the matrix before
    HookeKernel<3> kernel(rubber, Volumetric::mean_dilatation);
    assemble(*problem.body, kernel, problem.body->fine.vector(), stiffer);
    stiffness *= 0.985;
    for (const double wider : {0.0, 4e-4, 8e-4}) {  // the contact grows on the way
      const Request wanted = request(problem.contact, radius + wider, stick);
      const auto fresh = make(true);
      fresh->set_matrix(stiffer);
      fresh->set_load(problem.load);
      const ConstrainedSolution anew =
          fresh->solve_constrained(wanted.held, wanted.values, wanted.loads);
      kept->set_matrix(stiffer);
      double before = std::numeric_limits<double>::infinity();
      for (int round = 0; round < 5; ++round) {  // each leaves a thousandth out of balance
        kept->set_load(problem.load);
        const ConstrainedSolution corrected =
            kept->solve_constrained(wanted.held, wanted.values, wanted.loads);
        if (round == 0 && corrected.cg_iterations > 0) ++corrections;
        const double difference = (anew.displacement - corrected.displacement).norm();
        EXPECT_LT(difference, std::max(0.05 * before, 1e-9 * anew.displacement.norm()));
        before = difference;
        if (round == 4) {
          EXPECT_LT((anew.reaction - corrected.reaction).norm(), 1e-8 * anew.reaction.norm());
        }
      }
    }
  }
  EXPECT_GT(corrections, 0);
}

TEST_P(FieldSolverTest, EliminatingAgreesWithAFreshOne) {
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) GTEST_SKIP();
  expect_to_keep_up(problem, [&](bool) {
    return make_eliminating_solver(*problem.body, problem.contact.unknowns);
  });
}

INSTANTIATE_TEST_SUITE_P(DegreesAndHangingNodes, FieldSolverTest,
                         ::testing::Combine(::testing::Values(1, 2, 3), ::testing::Bool()));

TEST(MultigridSolver, KeepsUpWithAChangingMatrix) {
  const Problem problem(2, true);
  expect_to_keep_up(problem, [&](bool exact) {
    return make_multigrid_solver(*problem.body, problem.contact.unknowns, 1e-12,
                                 exact ? 0.0 : fem_reference::newton_forcing);
  });
}

TEST(MultigridSolver, HasTheSameBitsWithAnyNumberOfThreads) {
  const unsigned usual = dealii::MultithreadInfo::n_threads();
  const auto field = [](unsigned threads) {
    dealii::MultithreadInfo::set_thread_limit(threads);
    const Problem problem(2, true);
    const auto solver = make_multigrid_solver(*problem.body, problem.contact.unknowns, 1e-10);
    solver->set_matrix(*problem.system);
    solver->set_load(problem.load);
    const Request wanted = request(problem.contact, 2e-3, true);
    solver->solve_constrained(wanted.held, wanted.values, wanted.loads);
    return solver->field();
  };
  const Vector one = field(1), three = field(3);
  dealii::MultithreadInfo::set_thread_limit(usual);
  EXPECT_TRUE(std::equal(one.begin(), one.end(), three.begin()));
}

TEST(MultigridSolver, RefusesAMatrixThatIsNotPositiveDefinite) {
  const Problem problem(2, false);
  LinearSystem system(*problem.body, true);
  system.matrix.copy_from(problem.system->matrix);
  system.coarse_matrix.copy_from(problem.system->coarse_matrix);
  const auto solver = make_multigrid_solver(*problem.body, problem.contact.unknowns, 1e-10, 1e-3);
  solver->set_matrix(system);
  const Request wanted = request(problem.contact, 2e-3, true);
  solver->solve_constrained(wanted.held, wanted.values, wanted.loads);
  const Vector before = solver->field();
  system.matrix *= -1.0;  // its preconditioner is that of the matrix before
  solver->set_load(problem.load);
  EXPECT_THROW(solver->solve_constrained(wanted.held, wanted.values, wanted.loads),
               meshes::NotConverged);
  Vector after = solver->field();
  after -= before;
  EXPECT_EQ(after.linfty_norm(), 0.0);
}

TEST(CondensedSolver, RefusesAMatrixThatIsNotPositiveDefinite) {
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) GTEST_SKIP();
  Problem problem(1, false);
  problem.system->matrix *= -1.0;
  const auto solver = make_condensed_solver(*problem.body, problem.contact.unknowns);
  EXPECT_THROW(solver->set_matrix(*problem.system), meshes::NotConverged);
}

/// Lamé's hollow sphere: u_r = C (rho - r³/rho²) vanishes at the bond; half of it is the tip
/// without sleeve when its end may only slide.
class HollowSphere {
 public:
  explicit HollowSphere(double refinement) {
    geometry_.sleeve_length = 0.0;
    const SharedMesh mesh(refinement, meshes::Sector::quarter, geometry_);
    body_ = fem_reference::read_tip<3>(MPI_COMM_WORLD, mesh.file(), 2, 0.0);
    body_->number(fem_reference::tip_supports<3>());
    prescribe();
    HookeKernel<3> kernel(rubber_, Volumetric::mean_dilatation);
    LinearSystem system(*body_, false);
    assemble(*body_, kernel, body_->fine.vector(), system);
    const auto solver = make_condensed_solver(*body_, unknowns_);
    solver->set_matrix(system);
    const Eigen::Map<Eigen::VectorXd> wanted(values_.data(), Eigen::Index(values_.size()));
    const ConstrainedSolution solution = solver->solve_constrained(
        std::vector<char>(unknowns_.size(), 1), wanted, Eigen::VectorXd::Zero(wanted.size()));
    for (std::size_t k = 0; k < unknowns_.size(); ++k)
      if (pushes_[k]) force_ += solution.reaction[Eigen::Index(k)];
    const Vector u = solver->field();
    for (const auto& [i, value] : exact_)
      field_error_ = std::max(field_error_, std::abs(u[i] - value) / radial(geometry_.tip_radius));
  }

  double field_error() const { return field_error_; }
  /// sigma_rr = 3 K C + 4 G C r³/rho³, pushing on a quarter of the disc π R².
  double force_error() const {
    const double R = geometry_.tip_radius, ratio = geometry_.rod_radius / R;
    const double stress =
        3 * rubber_.bulk_modulus() * C + 4 * rubber_.shear_modulus * C * std::pow(ratio, 3);
    return std::abs(force_ / (stress * std::numbers::pi * R * R / 4) - 1);
  }

 private:
  static constexpr double C = 0.01;

  double radial(double rho) const {
    return C * (rho - std::pow(geometry_.rod_radius, 3) / (rho * rho));
  }

  /// All of the outer sphere, and the end across it.
  void prescribe() {
    std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
    dealii::DoFTools::map_dofs_to_support_points(body_->mapping, body_->fine.dofs, points);
    for (unsigned component = 0; component < 3; ++component) {
      dealii::ComponentMask mask(3, false);
      mask.set(component, true);
      for (const auto i : dealii::DoFTools::extract_dofs(body_->fine.dofs, mask)) {
        const dealii::Point<3> w = points.at(i);
        exact_[i] = radial(w.norm()) * w[component] / w.norm();
        if (body_->fine.constraints.is_constrained(i)) continue;
        const bool outer = w.norm() > geometry_.tip_radius * (1 - 1e-9);
        if (!outer && !(w[2] < 1e-12 && component == 2)) continue;
        unknowns_.push_back(long(i));
        values_.push_back(outer ? exact_[i] : 0.0);
        pushes_.push_back(component == 2 && w[2] > 1e-12);
      }
    }
  }

  meshes::Geometry geometry_;
  const meshes::Rubber rubber_;
  std::unique_ptr<Body<3>> body_;
  std::vector<long> unknowns_;
  std::vector<double> values_;
  std::vector<char> pushes_;  ///< along z on the sphere off its rim
  std::map<dealii::types::global_dof_index, double> exact_;
  double force_ = 0.0, field_error_ = 0.0;
};

TEST(CondensedSolver, HollowSphereFollowsLame) {
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1) GTEST_SKIP();
  const HollowSphere coarse(0.35), fine(0.7);
  EXPECT_LT(fine.field_error(), 1e-3);
  EXPECT_LT(fine.field_error(), coarse.field_error() / 4);
  EXPECT_LT(fine.force_error(), 2e-2);  // the reactions of the outer rim belong partly to the end
  EXPECT_LT(fine.force_error(), coarse.force_error());
}

}  // namespace
