#include "fem_reference/direct_solver.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "fem_reference/field_solver.h"

namespace fingertip::fem_reference {

template <int dim>
FreeUnknowns::FreeUnknowns(const Space<dim>& space)
    : zero_(space.vector()), number_(space.dofs.n_dofs(), -1) {
  long next = 0;
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (!space.constraints.is_constrained(unsigned(i))) number_[i] = next++;
  node_.resize(std::size_t(next));
  std::vector<dealii::types::global_dof_index> indices(space.element.n_dofs_per_cell());
  for (const auto& cell : space.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    for (unsigned i = 0; i < indices.size(); ++i) {
      const unsigned local = space.element.system_to_component_index(i).second;
      // The unknown of the x component stands for the node.
      if (number_[indices[i]] >= 0)
        node_[std::size_t(number_[indices[i]])] =
            long(indices[space.element.component_to_system_index(0, local)]);
    }
  }
}

template FreeUnknowns::FreeUnknowns(const Space<2>&);
template FreeUnknowns::FreeUnknowns(const Space<3>&);

UpperTriangle FreeUnknowns::upper_triangle(const SparseMatrix& matrix) const {
  const Epetra_CrsMatrix& rows = matrix.trilinos_matrix();
  UpperTriangle upper;
  upper.start.push_back(0);
  std::vector<std::pair<long, double>> column;
  for (int i = 0; i < rows.NumMyRows(); ++i) {
    const long c = number_[std::size_t(rows.GRID(i))];
    if (c < 0) continue;
    int entries = 0;
    int* indices = nullptr;
    double* values = nullptr;
    rows.ExtractMyRowView(i, entries, values, indices);
    column.clear();
    for (int e = 0; e < entries; ++e) {  // symmetric: the row is the column
      const long r = number_[std::size_t(rows.GCID(indices[e]))];
      if (r >= 0 && r <= c) column.emplace_back(r, values[e]);
    }
    std::ranges::sort(column);
    for (const auto& [r, value] : column) {
      upper.row.push_back(r);
      upper.value.push_back(value);
    }
    upper.start.push_back(long(upper.row.size()));
  }
  return upper;
}

Eigen::VectorXd FreeUnknowns::restrict(const Vector& v) const {
  Eigen::VectorXd result(size());
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] >= 0) result[number_[i]] = v[unsigned(i)];
  return result;
}

Vector FreeUnknowns::extend(const Eigen::VectorXd& v) const {
  Vector result = zero_;
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] >= 0) result[unsigned(i)] = v[number_[i]];
  result.compress(dealii::VectorOperation::insert);
  return result;
}

namespace {

/// y = A x for a symmetric matrix given by its upper triangle.
Eigen::VectorXd multiply(const UpperTriangle& matrix, const Eigen::VectorXd& x) {
  Eigen::VectorXd y = Eigen::VectorXd::Zero(x.size());
  for (long c = 0; c < matrix.size(); ++c)
    for (long e = matrix.start[std::size_t(c)]; e < matrix.start[std::size_t(c) + 1]; ++e) {
      const long r = matrix.row[std::size_t(e)];
      const double value = matrix.value[std::size_t(e)];
      y[r] += value * x[c];
      if (r != c) y[c] += value * x[r];
    }
  return y;
}

class EliminatingSolver : public FieldSolver {
 public:
  template <int dim>
  EliminatingSolver(const Body<dim>& body, const std::vector<long>& contact_unknowns)
      : free_(body.fine) {
    for (const long unknown : contact_unknowns)
      contact_.push_back(free_.number(std::size_t(unknown)));
  }

  void set_matrix(const LinearSystem& system) override {
    matrix_ = free_.upper_triangle(system.matrix);
    if (!factor_) factor_ = std::make_unique<SparseFactor>(matrix_, free_.node(), NoUnknowns{});
    factored_for_.clear();
    load_ = Eigen::VectorXd::Zero(free_.size());
  }

  void set_load(const Vector& load) override { load_ = free_.restrict(load); }

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    factorise(held);
    Eigen::VectorXd fixed = Eigen::VectorXd::Zero(free_.size()), right = load_;
    for (std::size_t i = 0; i < held.size(); ++i)
      (held[i] ? fixed : right)[contact_[i]] += (held[i] ? values : loads)[Eigen::Index(i)];
    right -= multiply(matrix_, fixed);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) right[contact_[i]] = 0.0;
    displacement_ = factor_->solve(right) + fixed;
    ConstrainedSolution solution;
    solution.displacement = displacement_(contact_);
    solution.reaction = (multiply(matrix_, displacement_) - load_)(contact_);
    for (std::size_t i = 0; i < held.size(); ++i)
      if (!held[i]) solution.reaction[Eigen::Index(i)] = loads[Eigen::Index(i)];
    return solution;
  }

  Vector field() override { return free_.extend(displacement_); }

  double noise() const override { return 1e-10; }

 private:
  using NoUnknowns = std::vector<long>;

  void factorise(const std::vector<char>& held) {
    if (factored_for_ == held) return;
    std::vector<char> gone(std::size_t(free_.size()), 0);
    for (std::size_t i = 0; i < held.size(); ++i) gone[std::size_t(contact_[i])] = held[i];
    UpperTriangle eliminated = matrix_;
    for (long c = 0; c < eliminated.size(); ++c)
      for (long e = eliminated.start[std::size_t(c)]; e < eliminated.start[std::size_t(c) + 1];
           ++e) {
        const long r = eliminated.row[std::size_t(e)];
        if (r != c && (gone[std::size_t(r)] || gone[std::size_t(c)]))
          eliminated.value[std::size_t(e)] = 0.0;
      }
    factor_->factorise(eliminated);
    factored_for_ = held;
  }

  FreeUnknowns free_;
  std::vector<long> contact_;  ///< free numbers of the contact unknowns
  UpperTriangle matrix_;
  std::unique_ptr<SparseFactor> factor_;
  std::vector<char> factored_for_;
  Eigen::VectorXd load_, displacement_;
};

}  // namespace

template <int dim>
std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<dim>& body,
                                                     const std::vector<long>& contact_unknowns) {
  return std::make_unique<EliminatingSolver>(body, contact_unknowns);
}

template std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<2>&,
                                                              const std::vector<long>&);
template std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<3>&,
                                                              const std::vector<long>&);

}  // namespace fingertip::fem_reference
