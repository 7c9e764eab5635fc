/// What the two direct solvers share: the free unknowns of a space and their matrix.
#pragma once

#include <vector>

#include "fem_reference/assembly.h"
#include "fem_reference/sparse_factor.h"

namespace fingertip::fem_reference {

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

  UpperTriangle upper_triangle(const SparseMatrix& matrix) const;
  Eigen::VectorXd restrict(const Vector& v) const;
  Vector extend(const Eigen::VectorXd& v) const;

 private:
  Vector zero_;  ///< of the whole space
  std::vector<long> number_, node_;
};

}  // namespace fingertip::fem_reference
