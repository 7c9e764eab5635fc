/// What the two direct solvers share: the free unknowns of a space and their matrix.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "fem_reference/contact/contact_surface.h"
#include "fem_reference/elements/assembly.h"
#include "fem_reference/solvers/sparse_factor.h"

namespace fingertip::fem_reference::inline solvers {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, long>;

/// With the rows and columns that are held cut off from the others, where some are.
UpperTriangle upper_triangle(const SymmetricMatrix& matrix, const std::vector<char>& held = {});

/// Numbers the unknowns of a space that no constraint takes away. One process only.
class FreeUnknowns {
 public:
  template <int dim>
  explicit FreeUnknowns(const Space<dim>& space);

  long size() const { return long(node_.size()); }
  /// Free number of an unknown, -1 when it is constrained.
  long number(std::size_t unknown) const { return number_[unknown]; }
  /// The node (named by one of its unknowns) to which every free unknown belongs.
  const std::vector<long>& node() const { return node_; }

  /// From now on the unknowns of these nodes count along axes of their own on this side.
  void set_axes(const std::vector<NodeAxes>& nodes) { axes_ = nodes; }

  /// Every matrix must have the pattern of the first.
  void restrict(const SparseMatrix& matrix, SymmetricMatrix& result);
  Eigen::VectorXd restrict(const Vector& v) const;
  Vector extend(const Eigen::VectorXd& v) const;

 private:
  /// Calls with the free numbers of a node's unknowns that are free, and the turn of these.
  void for_each_turn(auto&& take) const;
  void turn(SymmetricMatrix& matrix) const;
  Vector zero_;  ///< of the whole space
  std::vector<long> number_, node_;
  SymmetricMatrix pattern_;
  std::vector<long> place_;  ///< of every entry of a matrix in the pattern's values, or -1
  std::vector<NodeAxes> axes_;
};

}  // namespace fingertip::fem_reference::inline solvers
