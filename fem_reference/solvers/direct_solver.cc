#include "fem_reference/solvers/direct_solver.h"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace fingertip::fem_reference::inline solvers {

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

void FreeUnknowns::restrict(const SparseMatrix& matrix, SymmetricMatrix& result) {
  const Epetra_CrsMatrix& rows = matrix.trilinos_matrix();
  std::size_t entry = 0;
  const auto for_each_entry = [&](auto take) {
    for (int i = 0; i < rows.NumMyRows(); ++i) {
      int entries = 0;
      int* indices = nullptr;
      double* values = nullptr;
      rows.ExtractMyRowView(i, entries, values, indices);
      for (int e = 0; e < entries; ++e) take(i, indices[e], values[e]);
    }
  };
  if (place_.empty()) {
    // All matrices of a space have one pattern: each entry's place is kept.
    struct Entry {
      long row, column;
      std::size_t source;
    };
    std::vector<Entry> kept;
    for_each_entry([&](int i, int column, double) {
      const long r = number_[std::size_t(rows.GRID(i))],
                 c = number_[std::size_t(rows.GCID(column))];
      if (r >= 0 && c >= 0) kept.push_back({r, c, entry});
      ++entry;
    });
    // Trilinos keeps rows in order, mostly, and sorting what is sorted is slow, too.
    const auto order = [](const Entry& e) { return std::pair(e.row, e.column); };
    if (!std::ranges::is_sorted(kept, {}, order)) std::ranges::sort(kept, {}, order);
    place_.assign(entry, -1);
    pattern_.resize(size(), size());
    pattern_.reserve(long(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) place_[kept[k].source] = long(k);
    long row = -1;
    for (const Entry& e : kept) {
      while (row < e.row) pattern_.startVec(++row);
      pattern_.insertBack(e.row, e.column) = 0.0;
    }
    pattern_.finalize();
    entry = 0;
  }
  if (result.nonZeros() != pattern_.nonZeros()) result = pattern_;
  for_each_entry([&](int, int, double value) {
    const long place = place_[entry++];
    if (place >= 0) result.valuePtr()[place] = value;
  });
  turn(result);
}

void FreeUnknowns::for_each_turn(auto&& take) const {
  for (const NodeAxes& node : axes_) {
    std::vector<long> numbers;
    std::vector<Eigen::Index> components;
    for (std::size_t c = 0; c < 3; ++c) {
      const long number = node.unknown[c] < 0 ? -1 : number_[std::size_t(node.unknown[c])];
      if (number < 0) continue;
      numbers.push_back(number);
      components.push_back(Eigen::Index(c));
    }
    take(numbers, Eigen::MatrixXd(node.axes(components, components)));
  }
}

/// Q A Q^T. The unknowns of a node have the same neighbours, so that the pattern stays.
void FreeUnknowns::turn(SymmetricMatrix& matrix) const {
  for_each_turn([&](const std::vector<long>& numbers, const Eigen::MatrixXd& axes) {
    if (numbers.empty()) return;
    const long* start = matrix.outerIndexPtr();
    const long entries = start[numbers[0] + 1] - start[numbers[0]];
    Eigen::MatrixXd rows(Eigen::Index(numbers.size()), entries);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      if (start[numbers[k] + 1] - start[numbers[k]] != entries)
        throw std::logic_error(
            "the unknowns of a node on the contact surface differ in neighbours");
      rows.row(Eigen::Index(k)) =
          Eigen::Map<Eigen::RowVectorXd>(matrix.valuePtr() + start[numbers[k]], entries);
    }
    rows = axes * rows;
    for (std::size_t k = 0; k < numbers.size(); ++k)
      Eigen::Map<Eigen::RowVectorXd>(matrix.valuePtr() + start[numbers[k]], entries) =
          rows.row(Eigen::Index(k));
    Eigen::VectorXd across(Eigen::Index(numbers.size()));
    for (long e = start[numbers[0]]; e < start[numbers[0] + 1]; ++e) {
      const long row = matrix.innerIndexPtr()[e];
      for (std::size_t k = 0; k < numbers.size(); ++k)
        across[Eigen::Index(k)] = matrix.coeff(row, numbers[k]);
      across = (axes * across).eval();
      for (std::size_t k = 0; k < numbers.size(); ++k)
        matrix.coeffRef(row, numbers[k]) = across[Eigen::Index(k)];
    }
  });
}

Eigen::VectorXd FreeUnknowns::restrict(const Vector& v) const {
  Eigen::VectorXd result(size());
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] >= 0) result[number_[i]] = v[unsigned(i)];
  for_each_turn([&](const std::vector<long>& numbers, const Eigen::MatrixXd& axes) {
    result(numbers) = (axes * result(numbers)).eval();
  });
  return result;
}

Vector FreeUnknowns::extend(const Eigen::VectorXd& turned) const {
  Vector result = zero_;
  Eigen::VectorXd v = turned;
  for_each_turn([&](const std::vector<long>& numbers, const Eigen::MatrixXd& axes) {
    v(numbers) = (axes.transpose() * v(numbers)).eval();
  });
  for (std::size_t i = 0; i < number_.size(); ++i)
    if (number_[i] >= 0) result[unsigned(i)] = v[number_[i]];
  result.compress(dealii::VectorOperation::insert);
  return result;
}

UpperTriangle upper_triangle(const SymmetricMatrix& matrix, const std::vector<char>& held) {
  UpperTriangle upper;
  upper.start.push_back(0);
  for (long c = 0; c < matrix.outerSize(); ++c) {
    for (SymmetricMatrix::InnerIterator entry(matrix, c); entry && entry.col() <= c; ++entry) {
      const long r = entry.col();
      const bool apart = r != c && !held.empty() && (held[std::size_t(r)] || held[std::size_t(c)]);
      upper.row.push_back(r);
      upper.value.push_back(apart ? 0.0 : entry.value());
    }
    upper.start.push_back(long(upper.row.size()));
  }
  return upper;
}

}  // namespace fingertip::fem_reference::inline solvers
