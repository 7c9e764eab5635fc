/// The arrays of a lattice in lanes, and the way into them and out again.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "tests/benchmarks/springs/engine/spring_problem.h"
#include "tests/benchmarks/springs/engine/sweep.h"

namespace fingertip::lattice::springs {

/// Zeroed memory, aligned to large pages.
template <typename Real>
class Arena {
 public:
  explicit Arena(std::size_t count);
  Real* data() const { return data_.get(); }

 private:
  struct Release {
    void operator()(Real* data) const;
  };
  std::unique_ptr<Real[], Release> data_;
};

template <typename Real>
class LaneStorage {
 public:
  /// For registers of `lanes` Reals. Rows run along the axis that fills registers best.
  LaneStorage(const SpringProblem& problem, int lanes);

  const LaneGrid<Real>& grid() const { return grid_; }

  /// Positions or velocities, one column per mass in the order of `mass_points`.
  enum class Quantity { position, velocity };
  void put(Quantity quantity, const Eigen::Matrix3Xd& values);
  Eigen::Matrix3Xd get(Quantity quantity) const;

  std::size_t masses() const { return masses_.size(); }
  std::size_t springs() const { return springs_; }
  std::size_t evaluated_springs() const { return evaluated_; }  ///< lanes computed in a step

  /// Reals of the force buffer of one step in flight.
  std::size_t force_buffer() const;

 private:
  using Point = std::array<int, 3>;  ///< along a row, row, plane

  bool occupied(const SpringProblem& problem, const Point& p) const;
  std::ptrdiff_t slot_offset(int plane, int row, int slot) const;
  std::size_t motion_count() const;
  void mark_row(const SpringProblem& problem, int plane, int row);
  void copy_seams();

  int lanes_, axis_;
  LaneGrid<Real> grid_{};
  Arena<Real> motion_;
  std::vector<LaneMask<Real>> masks_;
  std::vector<std::uint8_t> links_;
  std::vector<std::ptrdiff_t> masses_;  ///< where each mass is in `motion`
  std::size_t springs_ = 0, evaluated_ = 0;
};

}  // namespace fingertip::lattice::springs
