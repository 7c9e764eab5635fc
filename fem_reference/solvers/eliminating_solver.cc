#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "fem_reference/solvers/conjugate_gradients.h"
#include "fem_reference/solvers/direct_solver.h"
#include "fem_reference/solvers/field_solver.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

using Eigen::Index;

/// Of the forces: what a solution leaves out of balance.
constexpr double accuracy = 1e-11;
/// A solution may take this share of the time of a factorisation; a factor that is cheaper than
/// `fewest` solutions is made anew at once.
constexpr double worth_trying = 0.5, fewest = 4.0;
/// Columns that are solved for together take this share of their time one by one.
constexpr double together = 0.2;

/// Solves with the rows and columns that are held taken out of a symmetric matrix, from a factor
/// that was made when fewer were held: with E the columns of unity of the others, W = A^-1 E,
///     A_free^-1 b = A^-1 b - W (E^T W)^-1 E^T A^-1 b.
/// What was held then and is free now stands apart in the factor: the inverse is not exact.
class HeldFactor {
 public:
  HeldFactor(const SymmetricMatrix& pattern, const std::vector<long>& nodes)
      : factor_(upper_triangle(pattern), nodes, {}) {}

  void factorise(const SymmetricMatrix& matrix, const std::vector<char>& held) {
    factor_.factorise(upper_triangle(matrix, held));
    base_ = held;
    more_.clear();
    columns_.resize(Index(held.size()), 0);
  }

  void forget() { base_.clear(); }

  /// Solutions that take the time of a factorisation.
  double worth() const { return factor_.solves_per_factorisation(); }

  /// Makes itself that of `held`; false when a new factor would be better.
  bool hold(const std::vector<char>& held) {
    if (base_.size() != held.size() || worth() < fewest) return false;
    std::vector<Index> more;
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (held[i] && !base_[i]) more.push_back(Index(i));
    }
    if (more == more_) return true;
    if (together * double(more.size()) > worth_trying * worth()) return false;
    solve_for(more);
    return true;
  }

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const {
    Eigen::VectorXd solution = factor_.solve(right);
    if (!more_.empty()) {
      const Eigen::VectorXd there = solution(more_);
      solution -= columns_ * small_->solve(there);
      solution(more_).setZero();
    }
    return solution;
  }

 private:
  /// Takes over the columns that are there already.
  void solve_for(const std::vector<Index>& more) {
    Eigen::MatrixXd columns(columns_.rows(), Index(more.size()));
    std::vector<Index> missing;
    for (std::size_t k = 0; k < more.size(); ++k) {
      const auto known = std::ranges::find(more_, more[k]);
      if (known == more_.end())
        missing.push_back(Index(k));
      else
        columns.col(Index(k)) = columns_.col(known - more_.begin());
    }
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(columns.rows(), Index(missing.size()));
    for (Index k = 0; k < units.cols(); ++k)
      units(more[std::size_t(missing[std::size_t(k)])], k) = 1.0;
    if (units.cols() > 0) columns(Eigen::all, missing) = factor_.solve_columns(units);
    more_ = more;
    columns_ = std::move(columns);
    small_.emplace(Eigen::MatrixXd(columns_(more_, Eigen::all)));
  }

  SparseFactor factor_;
  std::vector<char> base_;                            ///< held when the factor was made
  std::vector<Index> more_;                           ///< held since then
  Eigen::MatrixXd columns_;                           ///< W
  std::optional<Eigen::LLT<Eigen::MatrixXd>> small_;  ///< of E^T W
};

class EliminatingSolver : public FieldSolver {
 public:
  template <int dim>
  EliminatingSolver(const Body<dim>& body, const std::vector<long>& contact_unknowns)
      : free_(body.fine), displacement_(Eigen::VectorXd::Zero(free_.size())) {
    for (const long unknown : contact_unknowns)
      contact_.push_back(free_.number(std::size_t(unknown)));
  }

  void set_matrix(const LinearSystem& system) override {
    free_.restrict(system.matrix, matrix_);
    if (!factor_) factor_ = std::make_unique<HeldFactor>(matrix_, free_.node());
    set_load(Eigen::VectorXd::Zero(free_.size()));
  }

  void set_axes(const std::vector<NodeAxes>& nodes) override {
    const Vector before = field();
    free_.set_axes(nodes);
    displacement_ = free_.restrict(before);
  }

  void set_load(const Vector& load) override { set_load(free_.restrict(load)); }

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    // Where the solution was last, the forces are nearly those wanted, reactions included.
    const double scale = (matrix_ * displacement_).norm();
    Eigen::VectorXd right = load_;
    std::vector<char> gone(std::size_t(free_.size()), 0);
    for (std::size_t i = 0; i < held.size(); ++i) {
      gone[std::size_t(contact_[i])] = held[i];
      if (held[i])
        displacement_[contact_[i]] = values[Index(i)];
      else
        right[contact_[i]] += loads[Index(i)];
    }
    ConstrainedSolution solution;
    if (!factor_->hold(gone) ||
        !improve(gone, right, std::max(scale, right.norm()), solution.cg_iterations)) {
      factor_->factorise(matrix_, gone);
      displacement_ += factor_->solve(out_of_balance(gone, right));
    }
    solution.displacement = displacement_(contact_);
    solution.reaction = (matrix_ * displacement_ - load_)(contact_);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) solution.reaction[Index(i)] = loads[Index(i)];
    return solution;
  }

  void forget() override {
    if (factor_) factor_->forget();
    displacement_.setZero();
  }

  Vector field() override { return free_.extend(displacement_); }

  double noise() const override { return noise_; }

 private:
  void set_load(Eigen::VectorXd load) {
    load_ = std::move(load);
    enough_ = 0.0;
    noise_ = 10.0 * accuracy;
  }

  /// `right` - A u where nothing is held.
  Eigen::VectorXd out_of_balance(const std::vector<char>& held,
                                 const Eigen::VectorXd& right) const {
    return without(held, right - matrix_ * displacement_);
  }

  static Eigen::VectorXd without(const std::vector<char>& held, Eigen::VectorXd v) {
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) v[Index(i)] = 0.0;
    return v;
  }

  /// Conjugate gradients from where the solution was last, preconditioned by the factor of a matrix
  /// that was different. False, and nothing done, when a new factor costs less.
  bool improve(const std::vector<char>& held, const Eigen::VectorXd& right, double scale,
               int& iterations) {
    Eigen::VectorXd u = displacement_, residual = out_of_balance(held, right);
    if (enough_ == 0.0) {
      enough_ = std::max(accuracy * scale, newton_forcing * residual.norm());
      noise_ = std::max(noise_, 10.0 * enough_ / scale);
    }
    const CgOutcome outcome = conjugate_gradients(
        u, residual, enough_, int(worth_trying * factor_->worth()) + 1,
        [&](const Eigen::VectorXd& v) { return without(held, matrix_ * v); },
        [&](const Eigen::VectorXd& v) { return factor_->solve(v); });
    iterations += outcome.iterations;
    // Where the matrix is indefinite the factorisation will tell why.
    if (outcome.end != CgEnd::converged) return false;
    displacement_ = u;
    return true;
  }

  FreeUnknowns free_;
  std::vector<long> contact_;  ///< free numbers of the contact unknowns
  SymmetricMatrix matrix_;
  std::unique_ptr<HeldFactor> factor_;
  Eigen::VectorXd load_, displacement_;
  double enough_ = 0.0, noise_ = 0.0;  ///< out of balance since the last load [N], as a fraction
};

}  // namespace

void FieldSolver::set_axes(const std::vector<NodeAxes>& /*nodes*/) {
  throw std::logic_error("this solver knows the axes of the body alone");
}

template <int dim>
std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<dim>& body,
                                                     const std::vector<long>& contact_unknowns) {
  return std::make_unique<EliminatingSolver>(body, contact_unknowns);
}

template std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<2>&,
                                                              const std::vector<long>&);
template std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<3>&,
                                                              const std::vector<long>&);

}  // namespace fingertip::fem_reference::inline solvers
