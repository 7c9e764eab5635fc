#include <deal.II/lac/solver_cg.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fem_reference/solvers/field_solver.h"
#include "fem_reference/solvers/two_level.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

constexpr unsigned max_iterations = 1000;
/// The coarse hierarchy is built anew when more than this share of the held unknowns has changed.
constexpr double worth_rebuilding = 0.02;

class MultigridSolver : public FieldSolver {
 public:
  MultigridSolver(const Body<3>& body, const std::vector<long>& contact_unknowns, double tolerance)
      : body_(body),
        contact_unknowns_(contact_unknowns),
        tolerance_(tolerance),
        displacement_(body.fine.vector()),
        load_(displacement_) {
    for (const long unknown : contact_unknowns)
      contact_local_.push_back(body.fine.owned.is_element(unsigned(unknown))
                                   ? long(body.fine.owned.index_within_set(unsigned(unknown)))
                                   : -1);
    constrained_.assign(body.fine.owned.n_elements(), 0);
    for (const auto i : body.fine.owned)
      if (body.fine.constraints.is_constrained(i))
        constrained_[body.fine.owned.index_within_set(i)] = 1;
  }

  void set_matrix(const LinearSystem& system) override {
    system_ = &system;
    preconditioner_ = std::make_unique<TwoLevelPreconditioner>(body_, system);
    built_for_.clear();
  }

  void set_load(const Vector& load) override { load_ = load; }

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    held_ = constrained_;
    Vector load = load_;
    for (std::size_t i = 0; i < held.size(); ++i) {
      const long local = contact_local_[i];
      if (local < 0) continue;
      if (held[i]) {
        held_[std::size_t(local)] = 1;
        displacement_.begin()[local] = values[Eigen::Index(i)];
      } else {
        load.begin()[local] += loads[Eigen::Index(i)];
      }
    }
    for (std::size_t i = 0; i < constrained_.size(); ++i)
      if (constrained_[i]) displacement_.begin()[i] = load.begin()[i] = 0.0;
    prepare(held);
    ConstrainedSolution solution;
    solution.cg_iterations = relax(load);
    Vector force = body_.fine.vector();
    system_->matrix.vmult(force, displacement_);
    force -= load_;
    solution.displacement = gather(displacement_);
    solution.reaction = gather(force);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) solution.reaction[Eigen::Index(i)] = loads[Eigen::Index(i)];
    return solution;
  }

  Vector field() override { return displacement_; }

  double noise() const override { return std::max(1e-10, 100 * tolerance_); }

 private:
  void prepare(const std::vector<char>& held) {
    std::size_t changed = held.size();
    if (built_for_.size() == held.size()) {
      changed = 0;
      for (std::size_t i = 0; i < held.size(); ++i) changed += held[i] != built_for_[i];
    }
    if (double(changed) <= worth_rebuilding * double(std::ranges::count(held, 1)) &&
        built_for_.size() == held.size())
      return;
    preconditioner_->set_held(held_);
    built_for_ = held;
  }

  /// Solves for the unknowns that are not held; returns the CG iterations.
  int relax(const Vector& load) {
    const ProjectedMatrix matrix(system_->matrix, held_);
    Vector residual = load, correction = body_.fine.vector();
    system_->matrix.vmult(residual, displacement_);
    const double scale = std::max(residual.l2_norm(), load.l2_norm());  // mostly the reactions
    residual.sadd(-1.0, 1.0, load);
    matrix.project(residual);
    if (residual.l2_norm() <= tolerance_ * scale) return 0;
    dealii::SolverControl control(max_iterations, tolerance_ * scale);
    dealii::SolverCG<Vector> cg(control);
    try {
      cg.solve(matrix, correction, residual, *preconditioner_);
    } catch (const dealii::SolverControl::NoConvergence&) {
      throw meshes::NotConverged("conjugate gradients stopped at a residual of " +
                                 std::to_string(control.last_value() / scale) +
                                 " of the reactions after " + std::to_string(control.last_step()) +
                                 " iterations");
    }
    displacement_ += correction;
    return int(control.last_step());
  }

  Eigen::VectorXd gather(const Vector& v) const {
    const std::vector<double> all = body_.fine.gather(v, contact_unknowns_);
    return Eigen::Map<const Eigen::VectorXd>(all.data(), Eigen::Index(all.size()));
  }

  const Body<3>& body_;
  std::vector<long> contact_unknowns_;
  std::vector<long> contact_local_;  ///< index among the owned unknowns, -1 for other processes'
  std::vector<char> constrained_, held_, built_for_;
  double tolerance_;
  const LinearSystem* system_ = nullptr;
  std::unique_ptr<TwoLevelPreconditioner> preconditioner_;
  Vector displacement_, load_;
};

}  // namespace

std::unique_ptr<FieldSolver> make_multigrid_solver(const Body<3>& body,
                                                   const std::vector<long>& contact_unknowns,
                                                   double tolerance) {
  return std::make_unique<MultigridSolver>(body, contact_unknowns, tolerance);
}

}  // namespace fingertip::fem_reference::inline solvers
