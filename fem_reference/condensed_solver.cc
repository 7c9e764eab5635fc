#include <cholmod.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "fem_reference/contact_solver.h"
#include "fem_reference/growing_cholesky.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using Long = SuiteSparse_long;

/// CHOLMOD's workspace. Its objects are freed through it, so that it must outlive them.
class Workspace {
 public:
  Workspace() {
    cholmod_l_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
  }
  ~Workspace() { cholmod_l_finish(&common); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  auto own(cholmod_sparse* object) {
    return std::shared_ptr<cholmod_sparse>(
        object, [this](cholmod_sparse* p) { cholmod_l_free_sparse(&p, &common); });
  }
  auto own(cholmod_factor* object) {
    return std::shared_ptr<cholmod_factor>(
        object, [this](cholmod_factor* p) { cholmod_l_free_factor(&p, &common); });
  }
  auto own(cholmod_dense* object) {
    return std::shared_ptr<cholmod_dense>(
        object, [this](cholmod_dense* p) { cholmod_l_free_dense(&p, &common); });
  }

  cholmod_common common{};
};

/// A symmetric matrix of which the upper triangle is stored, from (row, value) lists per column.
/// `rows(column)` yields pairs with row <= column, sorted.
template <class Columns>
std::shared_ptr<cholmod_sparse> upper_triangle(Workspace& workspace, std::size_t n,
                                               std::size_t entries, bool values, Columns fill) {
  auto matrix = workspace.own(cholmod_l_allocate_sparse(
      n, n, entries, 1, 1, 1, values ? CHOLMOD_REAL : CHOLMOD_PATTERN, &workspace.common));
  if (!matrix) throw meshes::NotConverged("not enough memory for the stiffness matrix");
  fill(static_cast<Long*>(matrix->p), static_cast<Long*>(matrix->i),
       static_cast<double*>(matrix->x));
  return matrix;
}

/// Numbers the unknowns that are free to move.
std::vector<int> number_free(const std::vector<char>& fixed) {
  std::vector<int> number(fixed.size(), -1);
  int next = 0;
  for (std::size_t i = 0; i < fixed.size(); ++i)
    if (!fixed[i]) number[i] = next++;
  return number;
}

class CondensedSolver : public ContactSolver {
 public:
  CondensedSolver(const ElasticTip& tip, const std::vector<int>& contact_unknowns)
      : free_number_(number_free(tip.fixed())), contact_unknowns_(contact_unknowns) {
    factorise(tip);
    extract_compliance();
    cholesky_ = std::make_unique<GrowingCholesky>(compliance_);
  }

  HeldSolution hold(const std::vector<char>& held, const Eigen::VectorXd& values) override {
    cholesky_->choose(held);
    const std::vector<int>& indices = cholesky_->indices();
    HeldSolution solution;
    solution.reaction = Eigen::VectorXd::Zero(values.size());
    solution.reaction(indices) = cholesky_->solve(values(indices));
    solution.displacement = compliance_ * solution.reaction;
    reaction_ = solution.reaction;
    return solution;
  }

  Eigen::VectorXd field() override {
    auto load = workspace_.own(cholmod_l_zeros(factor_->n, 1, CHOLMOD_REAL, &workspace_.common));
    double* entries = static_cast<double*>(load->x);
    for (std::size_t i = 0; i < contact_unknowns_.size(); ++i)
      entries[free_number_[std::size_t(contact_unknowns_[i])]] = reaction_[Eigen::Index(i)];
    const auto solution =
        workspace_.own(cholmod_l_solve(CHOLMOD_A, factor_.get(), load.get(), &workspace_.common));
    Eigen::VectorXd displacement = Eigen::VectorXd::Zero(Eigen::Index(free_number_.size()));
    for (std::size_t i = 0; i < free_number_.size(); ++i)
      if (free_number_[i] >= 0)
        displacement[Eigen::Index(i)] = static_cast<double*>(solution->x)[free_number_[i]];
    return displacement;
  }

  double noise() const override { return 1e-10; }

 private:
  /// Nested dissection of the nodes, contact nodes apart; unknowns of a node stay together.
  std::vector<Long> interior_order(const ElasticTip& tip, const std::vector<char>& in_contact) {
    const std::vector<int>& node = tip.node_of_dof();
    std::vector<std::vector<int>> unknowns(tip.nodes().size());
    for (int i = 0; i < tip.dofs(); ++i)
      if (!tip.fixed()[std::size_t(i)] && !in_contact[std::size_t(i)])
        unknowns[std::size_t(node[std::size_t(i)])].push_back(i);
    std::vector<int> number(unknowns.size(), -1);
    std::vector<int> nodes;
    for (std::size_t k = 0; k < unknowns.size(); ++k)
      if (!unknowns[k].empty()) number[k] = int(nodes.size()), nodes.push_back(int(k));

    std::vector<std::set<Long>> neighbours(nodes.size());
    std::size_t entries = 0;
    for (std::size_t column = 0; column < nodes.size(); ++column) {
      const int unknown = unknowns[std::size_t(nodes[column])].front();
      for (ElasticTip::Matrix::InnerIterator it(tip.stiffness(), unknown); it; ++it) {
        const int row = number[std::size_t(node[std::size_t(it.row())])];
        if (row >= 0 && row <= int(column)) neighbours[column].insert(row);
      }
      entries += neighbours[column].size();
    }
    const auto graph = upper_triangle(
        workspace_, nodes.size(), entries, false, [&](Long* starts, Long* rows, double*) {
          starts[0] = 0;
          for (std::size_t column = 0; column < nodes.size(); ++column) {
            std::ranges::copy(neighbours[column], rows + starts[column]);
            starts[column + 1] = starts[column] + Long(neighbours[column].size());
          }
        });
    std::vector<Long> node_order(nodes.size()), order;
    if (!cholmod_l_metis(graph.get(), nullptr, 0, 1, node_order.data(), &workspace_.common))
      throw meshes::NotConverged("the ordering of the stiffness matrix failed");
    for (const Long k : node_order)
      for (const int unknown : unknowns[std::size_t(nodes[std::size_t(k)])])
        order.push_back(free_number_[std::size_t(unknown)]);
    return order;
  }

  std::shared_ptr<cholmod_sparse> free_stiffness(const ElasticTip& tip) {
    const ElasticTip::Matrix& k = tip.stiffness();
    std::size_t n = 0;
    for (const int number : free_number_) n += number >= 0;
    const auto entries = std::size_t(k.nonZeros() + k.cols()) / 2;
    return upper_triangle(workspace_, n, entries, true, [&](Long* starts, Long* rows, double* x) {
      Long entry = 0;
      for (int column = 0; column < k.cols(); ++column) {
        const int number = free_number_[std::size_t(column)];
        if (number < 0) continue;
        starts[number] = entry;
        for (ElasticTip::Matrix::InnerIterator it(k, column); it && it.row() <= column; ++it) {
          const int row = free_number_[std::size_t(it.row())];
          if (row < 0) continue;
          rows[entry] = row;
          x[entry++] = it.value();
        }
        starts[number + 1] = entry;
      }
    });
  }

  void factorise(const ElasticTip& tip) {
    std::vector<char> in_contact(tip.fixed().size(), 0);
    for (const int unknown : contact_unknowns_) in_contact[std::size_t(unknown)] = 1;
    std::vector<Long> order = interior_order(tip, in_contact);
    for (const int unknown : contact_unknowns_) order.push_back(free_number_[std::size_t(unknown)]);

    const auto matrix = free_stiffness(tip);
    cholmod_common& common = workspace_.common;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_GIVEN;
    factor_ = workspace_.own(cholmod_l_analyze_p(matrix.get(), order.data(), nullptr, 0, &common));
    if (!factor_ || !cholmod_l_factorize(matrix.get(), factor_.get(), &common) ||
        common.status != CHOLMOD_OK)
      throw meshes::NotConverged("the stiffness matrix could not be factorised (CHOLMOD status " +
                                 std::to_string(common.status) +
                                 "): too little memory, or a degenerate mesh");
  }

  /// With K = L L^T and the contact unknowns last, L's last block L_c belongs to the condensed
  /// stiffness S = L_c L_c^T, and the compliance is its inverse.
  void extract_compliance() {
    const auto contacts = Eigen::Index(contact_unknowns_.size());
    const auto interior = Long(factor_->n) - contacts;
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(contacts, contacts);
    const Long* super = static_cast<Long*>(factor_->super);
    const Long* row_start = static_cast<Long*>(factor_->pi);
    const Long* value_start = static_cast<Long*>(factor_->px);
    const Long* rows = static_cast<Long*>(factor_->s);
    const double* values = static_cast<double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const Long height = row_start[s + 1] - row_start[s];
      for (Long column = std::max(super[s], interior); column < super[s + 1]; ++column)
        for (Long k = column - super[s]; k < height; ++k)
          lower(rows[row_start[s] + k] - interior, column - interior) =
              values[value_start[s] + (column - super[s]) * height + k];
    }
    const Eigen::MatrixXd inverse =
        lower.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(contacts, contacts));
    Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(contacts, contacts);
    compliance.selfadjointView<Eigen::Lower>().rankUpdate(inverse.transpose());
    // CHOLMOD may reorder unknowns further while it keeps every subtree together.
    std::vector<int> contact_of_free(factor_->n, -1);
    for (std::size_t i = 0; i < contact_unknowns_.size(); ++i)
      contact_of_free[std::size_t(free_number_[std::size_t(contact_unknowns_[i])])] = int(i);
    const Long* permutation = static_cast<Long*>(factor_->Perm);
    std::vector<int> position(contact_unknowns_.size(), -1);
    for (Eigen::Index i = 0; i < contacts; ++i) {
      const int contact = contact_of_free[std::size_t(permutation[interior + i])];
      if (contact < 0) throw meshes::NotConverged("CHOLMOD moved contact unknowns off the end");
      position[std::size_t(contact)] = int(i);
    }
    compliance_ = Eigen::MatrixXd(compliance.selfadjointView<Eigen::Lower>())(position, position);
  }

  Workspace workspace_;
  std::vector<int> free_number_;  ///< number among the free unknowns, -1 for fixed ones
  std::vector<int> contact_unknowns_;
  std::shared_ptr<cholmod_factor> factor_;
  Eigen::MatrixXd compliance_;  ///< displacement of contact unknowns per force on them [m/N]
  std::unique_ptr<GrowingCholesky> cholesky_;
  Eigen::VectorXd reaction_;
};

}  // namespace

std::unique_ptr<ContactSolver> make_condensed_solver(const ElasticTip& tip,
                                                     const std::vector<int>& contact_unknowns) {
  return std::make_unique<CondensedSolver>(tip, contact_unknowns);
}

}  // namespace fingertip::fem_reference
