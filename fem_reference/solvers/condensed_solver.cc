#include <memory>
#include <vector>

#include "fem_reference/contact/growing_cholesky.h"
#include "fem_reference/solvers/direct_solver.h"
#include "fem_reference/solvers/field_solver.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

class CondensedSolver : public FieldSolver {
 public:
  template <int dim>
  CondensedSolver(const Body<dim>& body, const std::vector<long>& contact_unknowns)
      : free_(body.fine) {
    for (const long unknown : contact_unknowns)
      contact_.push_back(free_.number(std::size_t(unknown)));
  }

  void set_matrix(const LinearSystem& system) override {
    SymmetricMatrix matrix;
    free_.restrict(system.matrix, matrix);
    const UpperTriangle upper = upper_triangle(matrix);
    if (!factor_) factor_ = std::make_unique<SparseFactor>(upper, free_.node(), contact_);
    factor_->factorise(upper);
    compliance_ = factor_->last_block_of_inverse();
    cholesky_ = std::make_unique<GrowingCholesky>(compliance_);
    load_ = Eigen::VectorXd::Zero(free_.size());
    offset_ = Eigen::VectorXd::Zero(compliance_.rows());
  }

  void set_load(const Vector& load) override {
    load_ = free_.restrict(load);
    offset_ = factor_->solve(load_)(contact_);
  }

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    cholesky_->choose(held);
    const std::vector<int>& indices = cholesky_->indices();
    ConstrainedSolution solution;
    solution.reaction = loads;
    solution.reaction(indices).setZero();
    const Eigen::VectorXd free_displacement =
        solution.reaction.isZero(0.0) ? offset_
                                      : Eigen::VectorXd(offset_ + compliance_ * solution.reaction);
    const Eigen::VectorXd missing = values(indices) - free_displacement(indices);
    solution.reaction(indices) = cholesky_->solve(missing);
    solution.displacement = offset_ + compliance_ * solution.reaction;
    reaction_ = solution.reaction;
    return solution;
  }

  Vector field() override {
    Eigen::VectorXd forces = load_;
    forces(contact_) += reaction_;
    return free_.extend(factor_->solve(forces));
  }

  double noise() const override { return 1e-10; }

 private:
  FreeUnknowns free_;
  std::vector<long> contact_;  ///< free numbers of the contact unknowns
  std::unique_ptr<SparseFactor> factor_;
  Eigen::MatrixXd compliance_;  ///< displacement of contact unknowns per force on them [m/N]
  std::unique_ptr<GrowingCholesky> cholesky_;
  Eigen::VectorXd load_, offset_, reaction_;
};

}  // namespace

template <int dim>
std::unique_ptr<FieldSolver> make_condensed_solver(const Body<dim>& body,
                                                   const std::vector<long>& contact_unknowns) {
  return std::make_unique<CondensedSolver>(body, contact_unknowns);
}

template std::unique_ptr<FieldSolver> make_condensed_solver(const Body<2>&,
                                                            const std::vector<long>&);
template std::unique_ptr<FieldSolver> make_condensed_solver(const Body<3>&,
                                                            const std::vector<long>&);

}  // namespace fingertip::fem_reference::inline solvers
