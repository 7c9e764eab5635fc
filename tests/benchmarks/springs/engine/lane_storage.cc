#include "tests/benchmarks/springs/engine/lane_storage.h"

#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>
#include <type_traits>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::springs {

namespace {

/// Share of the lanes that hold a mass, in rows along `axis` that have any.
double lane_fill(const SpringProblem& problem, int axis, int lanes) {
  const int a = axis, b = (axis + 1) % 3, c = (axis + 2) % 3;
  std::size_t masses = 0, rows = 0;
  std::array<int, 3> p{};
  for (p[c] = 0; p[c] < problem.size[c]; ++p[c]) {
    for (p[b] = 0; p[b] < problem.size[b]; ++p[b]) {
      std::size_t in_row = 0;
      for (p[a] = 0; p[a] < problem.size[a]; ++p[a])
        in_row += problem.occupied(p[0], p[1], p[2]) ? 1 : 0;
      masses += in_row;
      rows += in_row > 0 ? 1 : 0;
    }
  }
  const int slots = (problem.size[a] + lanes - 1) / lanes;
  return double(masses) / std::max(1.0, double(rows) * slots * lanes);
}

int fullest_axis(const SpringProblem& problem, int lanes) {
  int best = 0;
  for (const int axis : {1, 2})
    if (lane_fill(problem, axis, lanes) > lane_fill(problem, best, lanes)) best = axis;
  return best;
}

template <typename Real>
SweepConstants<Real> constants_of(const SpringProblem& problem) {
  SweepConstants<Real> constants{};
  const double largest = *std::max_element(problem.damping.begin(), problem.damping.end());
  for (int c = 0; c < 3; ++c) {
    // The kernel scales by sqrt(mu). Of an undamped class among damped ones it takes 1e-18 of the
    // largest mu, which is below round-off.
    const double damping = std::max(problem.damping[std::size_t(c)], 1e-18 * largest);
    const double scale = largest > 0.0 ? std::sqrt(damping) : 1.0;
    const double stiffness = problem.stiffness[std::size_t(c)];
    const double rest_length = problem.spacing * std::sqrt(double(c) + 1.0);
    constants.family[c] = {
        Real(stiffness),
        Real(stiffness * rest_length / scale),
        Real(1.0),
        {Real(scale), Real(scale / 2.0), Real(scale * 3.0 / 8.0), Real(scale * 5.0 / 16.0)}};
  }
  constants.gain = Real(problem.step / problem.mass);
  constants.step = Real(problem.step);
  const PenaltyPlane& plane = problem.plane;
  for (int c = 0; c < 3; ++c) {
    constants.gravity_step[c] = Real(problem.step * problem.gravity[c]);
    constants.normal[c] = Real(plane.normal[c]);
  }
  constants.height = Real(plane.height);
  constants.plane_stiffness = Real(plane.stiffness);
  constants.plane_damping = Real(plane.damping);
  return constants;
}

}  // namespace

template <typename Real>
Arena<Real>::Arena(std::size_t count) {
  constexpr std::size_t page = std::size_t(2) << 20;
  const std::size_t bytes = (count * sizeof(Real) + page - 1) / page * page;
  void* data = std::aligned_alloc(page, bytes);
  if (data == nullptr) throw std::bad_alloc();
  madvise(data, bytes, MADV_HUGEPAGE);  // a request: without large pages it is slower, not wrong
  std::memset(data, 0, bytes);
  data_.reset(static_cast<Real*>(data));
}

template <typename Real>
void Arena<Real>::Release::operator()(Real* data) const {
  std::free(data);
}

template <typename Real>
LaneStorage<Real>::LaneStorage(const SpringProblem& problem, int lanes)
    : lanes_(lanes),
      axis_(fullest_axis(problem, lanes)),
      grid_{(problem.size[std::size_t(axis_)] + lanes - 1) / lanes,
            problem.size[std::size_t(axis_ + 1) % 3],
            problem.size[std::size_t(axis_ + 2) % 3],
            nullptr,
            nullptr,
            nullptr,
            constants_of<Real>(problem)},
      motion_(motion_count()),
      masks_(std::size_t(grid_.planes) * std::size_t(grid_.rows) * std::size_t(grid_.slots) *
             masks_per_slot),
      links_(std::size_t(grid_.planes) * std::size_t(grid_.rows)) {
  grid_.motion = motion_.data();
  grid_.masks = masks_.data();
  grid_.links = links_.data();
  for (int plane = 0; plane < grid_.planes; ++plane)
    for (int row = 0; row < grid_.rows; ++row) mark_row(problem, plane, row);
  for (const std::size_t point : mass_points(problem)) {
    const std::size_t nx = std::size_t(problem.size[0]), ny = std::size_t(problem.size[1]);
    const Point xyz{int(point % nx), int(point / nx % ny), int(point / nx / ny)};
    const int along = xyz[std::size_t(axis_)];
    masses_.push_back(slot_offset(xyz[std::size_t(axis_ + 2) % 3], xyz[std::size_t(axis_ + 1) % 3],
                                  along % grid_.slots) +
                      along / grid_.slots);
  }
}

template <typename Real>
bool LaneStorage<Real>::occupied(const SpringProblem& problem, const Point& p) const {
  Point xyz;
  for (int c = 0; c < 3; ++c) xyz[std::size_t(axis_ + c) % 3] = p[std::size_t(c)];
  return problem.occupied(xyz[0], xyz[1], xyz[2]);
}

/// Marks the lanes of one row that hold masses and springs, and the rows it is linked to.
template <typename Real>
void LaneStorage<Real>::mark_row(const SpringProblem& problem, int plane, int row) {
  const std::size_t index = std::size_t(plane) * std::size_t(grid_.rows) + std::size_t(row);
  std::uint8_t& links = links_[index];
  LaneMask<Real>* masks = &masks_[index * std::size_t(grid_.slots) * masks_per_slot];
  for (int along = 0; along < lanes_ * grid_.slots; ++along) {
    if (!occupied(problem, {along, row, plane})) continue;
    LaneMask<Real>* mask = masks + std::ptrdiff_t(along % grid_.slots) * masks_per_slot;
    const auto lane = LaneMask<Real>(1u << (along / grid_.slots));
    mask[mass_mask] = LaneMask<Real>(mask[mass_mask] | lane);
    links = std::uint8_t(links | row_has_masses);
    for (std::size_t s = 0; s < half_stencil.size(); ++s) {
      const Direction& d = half_stencil[s];
      if (!occupied(problem, {along + d.dx, row + d.dy, plane + d.dz})) continue;
      mask[s] = LaneMask<Real>(mask[s] | lane);
      if (s > 0) links = std::uint8_t(links | 1u << ((s - 1) / 3));
      ++springs_;
    }
  }
  if (links == 0) return;
  int directions_computed = 1;
  for (int r = 0; r < linked_rows; ++r) directions_computed += (links >> r & 1) != 0 ? 3 : 0;
  evaluated_ += std::size_t(directions_computed * grid_.slots * lanes_);
}

template <typename Real>
std::ptrdiff_t LaneStorage<Real>::slot_offset(int plane, int row, int slot) const {
  const std::ptrdiff_t line = std::ptrdiff_t(plane) * grid_.rows + row;
  return (line * (grid_.slots + 2) + slot + 1) * axes_per_slot * lanes_;
}

template <typename Real>
std::size_t LaneStorage<Real>::motion_count() const {
  return std::size_t(slot_offset(grid_.planes, 0, -1));
}

template <typename Real>
std::size_t LaneStorage<Real>::force_buffer() const {
  return motion_count() / std::size_t(grid_.planes);  // two planes of half as many components
}

template <typename Real>
void LaneStorage<Real>::put(Quantity quantity, const Eigen::Matrix3Xd& values) {
  const int first = quantity == Quantity::position ? 0 : 3;
  for (std::size_t n = 0; n < masses_.size(); ++n)
    for (int c = 0; c < 3; ++c)
      grid_.motion[masses_[n] + (first + c) * lanes_] = Real(values(c, Eigen::Index(n)));
  copy_seams();
}

template <typename Real>
Eigen::Matrix3Xd LaneStorage<Real>::get(Quantity quantity) const {
  const int first = quantity == Quantity::position ? 0 : 3;
  Eigen::Matrix3Xd values(3, Eigen::Index(masses_.size()));
  for (std::size_t n = 0; n < masses_.size(); ++n)
    for (int c = 0; c < 3; ++c)
      values(c, Eigen::Index(n)) = double(grid_.motion[masses_[n] + (first + c) * lanes_]);
  return values;
}

template <typename Real>
void LaneStorage<Real>::copy_seams() {
  for (int plane = 0; plane < grid_.planes; ++plane) {
    for (int row = 0; row < grid_.rows; ++row) {
      Real* const before = grid_.motion + slot_offset(plane, row, -1);
      Real* const first = grid_.motion + slot_offset(plane, row, 0);
      Real* const last = grid_.motion + slot_offset(plane, row, grid_.slots - 1);
      Real* const after = grid_.motion + slot_offset(plane, row, grid_.slots);
      for (int c = 0; c < axes_per_slot; ++c) {
        for (int l = 0; l < lanes_; ++l) {
          before[c * lanes_ + (l + 1) % lanes_] = last[c * lanes_ + l];
          after[c * lanes_ + l] = first[c * lanes_ + (l + 1) % lanes_];
        }
      }
    }
  }
}

template class Arena<double>;
template class Arena<float>;
template class LaneStorage<double>;
template class LaneStorage<float>;

}  // namespace fingertip::lattice::springs
