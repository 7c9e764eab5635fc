#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <string>
#include <vector>

#include "fem_reference/contact_solver.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using Vector = dealii::Vector<double>;

/// Zeroes the entries of the held unknowns: the projection P.
void project(const std::vector<char>& held, Vector& v) {
  for (unsigned i = 0; i < v.size(); ++i)
    if (held[i]) v[i] = 0.0;
}

/// P A P for an operator A that leaves its argument alone.
template <class Operator>
struct Projected {
  const Operator& apply;
  const std::vector<char>& held;
  void vmult(Vector& result, const Vector& v) const {
    apply.vmult(result, v);  // v is already projected: CG never leaves the range of P
    project(held, result);
  }
};

class MultigridSolver : public ContactSolver {
 public:
  MultigridSolver(const ElasticTip& tip, const std::vector<int>& contact_unknowns, double tolerance)
      : tip_(tip), contact_unknowns_(contact_unknowns), tolerance_(tolerance) {
    build_matrix();
    build_preconditioner();
    displacement_.reinit(unsigned(tip.dofs()));
  }

  HeldSolution hold(const std::vector<char>& held, const Eigen::VectorXd& values) override {
    std::vector<char> constrained = tip_.fixed();
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) {
        const auto unknown = std::size_t(contact_unknowns_[i]);
        constrained[unknown] = 1;
        displacement_[unsigned(unknown)] = values[Eigen::Index(i)];
      }
    HeldSolution solution;
    solution.cg_iterations = relax(constrained);
    Vector force(displacement_.size());
    matrix_.vmult(force, displacement_);
    solution.displacement.resize(values.size());
    solution.reaction = Eigen::VectorXd::Zero(values.size());
    for (std::size_t i = 0; i < held.size(); ++i) {
      const auto unknown = unsigned(contact_unknowns_[i]);
      solution.displacement[Eigen::Index(i)] = displacement_[unknown];
      if (held[i]) solution.reaction[Eigen::Index(i)] = force[unknown];
    }
    return solution;
  }

  Eigen::VectorXd field() override {
    return Eigen::Map<const Eigen::VectorXd>(displacement_.data(),
                                             Eigen::Index(displacement_.size()));
  }

  double noise() const override { return std::max(1e-10, 100 * tolerance_); }

 private:
  /// Stiffness with the rows and columns of fixed unknowns replaced by the identity, scaled like
  /// their own diagonal.
  void build_matrix() {
    const ElasticTip::Matrix& k = tip_.stiffness();
    const std::vector<char>& fixed = tip_.fixed();
    dealii::DynamicSparsityPattern pattern{unsigned(k.rows()), unsigned(k.cols())};
    const auto kept = [&](int i, int j) {
      return i == j || (!fixed[std::size_t(i)] && !fixed[std::size_t(j)]);
    };
    const auto visit = [&](auto&& action) {
      for (int j = 0; j < k.cols(); ++j)
        for (ElasticTip::Matrix::InnerIterator it(k, j); it; ++it)
          if (kept(int(it.row()), j)) action(unsigned(it.row()), unsigned(j), it.value());
    };
    visit([&](unsigned i, unsigned j, double) { pattern.add(j, i); });
    matrix_.reinit(pattern);
    visit([&](unsigned i, unsigned j, double value) { matrix_.set(j, i, value); });
    matrix_.compress(dealii::VectorOperation::insert);
  }

  void build_preconditioner() {
    dealii::TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic = true;
    data.higher_order_elements = true;
    data.smoother_sweeps = 2;
    data.aggregation_threshold = 0.02;
    data.constant_modes.assign(3, std::vector<bool>(tip_.fixed().size(), false));
    for (std::size_t i = 0; i < tip_.fixed().size(); ++i)
      data.constant_modes[std::size_t(tip_.component_of_dof()[i])][i] = true;
    preconditioner_.initialize(matrix_, data);
  }

  /// Solves K u = 0 for the unknowns that are not constrained; returns the CG iterations.
  int relax(const std::vector<char>& constrained) {
    Vector residual(displacement_.size()), correction(displacement_.size());
    matrix_.vmult(residual, displacement_);
    const double scale = residual.l2_norm();  // dominated by the reactions
    residual *= -1.0;
    project(constrained, residual);
    if (residual.l2_norm() <= tolerance_ * scale) return 0;
    dealii::SolverControl control(1000, tolerance_ * scale);
    dealii::SolverCG<Vector> cg(control);
    const Projected<dealii::TrilinosWrappers::SparseMatrix> stiffness{matrix_, constrained};
    const Projected<dealii::TrilinosWrappers::PreconditionAMG> multigrid{preconditioner_,
                                                                         constrained};
    try {
      cg.solve(stiffness, correction, residual, multigrid);
    } catch (const dealii::SolverControl::NoConvergence&) {
      throw meshes::NotConverged("conjugate gradients stopped at a residual of " +
                                 std::to_string(control.last_value() / scale) +
                                 " of the reactions after " + std::to_string(control.last_step()) +
                                 " iterations");
    }
    displacement_ += correction;
    return int(control.last_step());
  }

  const ElasticTip& tip_;
  std::vector<int> contact_unknowns_;
  double tolerance_;
  dealii::TrilinosWrappers::SparseMatrix matrix_;
  dealii::TrilinosWrappers::PreconditionAMG preconditioner_;
  Vector displacement_;
};

}  // namespace

std::unique_ptr<ContactSolver> make_multigrid_solver(const ElasticTip& tip,
                                                     const std::vector<int>& contact_unknowns,
                                                     double tolerance) {
  return std::make_unique<MultigridSolver>(tip, contact_unknowns, tolerance);
}

}  // namespace fingertip::fem_reference
