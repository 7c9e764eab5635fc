#include "edge_list.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/kernels/stencil.h"

namespace spring_peers {

using namespace fingertip;
using namespace fingertip::lattice;

EdgeList::EdgeList(const springs::SpringProblem& problem) : problem_(problem) {
  if (auto broken = problem.violations(); !broken.empty()) throw meshes::InvalidInput(broken);
  const std::vector<std::size_t> points = springs::mass_points(problem);
  std::vector<int> mass_at(problem.points(), -1);
  for (std::size_t n = 0; n < points.size(); ++n) mass_at[points[n]] = int(n);
  for (const std::size_t point : points) {
    const int x = int(point % std::size_t(problem.size[0]));
    const int y = int(point / std::size_t(problem.size[0]) % std::size_t(problem.size[1]));
    const int z = int(point / std::size_t(problem.size[0]) / std::size_t(problem.size[1]));
    for (const Direction& d : half_stencil) {
      if (!problem.occupied(x + d.dx, y + d.dy, z + d.dz)) continue;
      springs_.push_back({mass_at[point], mass_at[problem.index(x + d.dx, y + d.dy, z + d.dz)],
                          problem.stiffness[d.family],
                          problem.spacing * std::sqrt(double(d.family) + 1.0),
                          problem.damping[d.family]});
    }
  }
  masses_.resize(points.size());
  const Eigen::Matrix3Xd rest = springs::rest_positions(problem);
  set_motion(rest, Eigen::Matrix3Xd::Zero(3, rest.cols()));
}

void EdgeList::set_motion(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities) {
  if (positions.cols() != Eigen::Index(masses_.size()) || velocities.cols() != positions.cols())
    throw std::invalid_argument("EdgeList::set_motion: one column per mass");
  for (std::size_t n = 0; n < masses_.size(); ++n) {
    for (int c = 0; c < 3; ++c) {
      masses_[n].x[c] = positions(c, Eigen::Index(n));
      masses_[n].v[c] = velocities(c, Eigen::Index(n));
      masses_[n].f[c] = 0.0;
    }
  }
}

Eigen::Matrix3Xd EdgeList::positions() const {
  Eigen::Matrix3Xd result(3, Eigen::Index(masses_.size()));
  for (std::size_t n = 0; n < masses_.size(); ++n)
    for (int c = 0; c < 3; ++c) result(c, Eigen::Index(n)) = masses_[n].x[c];
  return result;
}

Eigen::Matrix3Xd EdgeList::velocities() const {
  Eigen::Matrix3Xd result(3, Eigen::Index(masses_.size()));
  for (std::size_t n = 0; n < masses_.size(); ++n)
    for (int c = 0; c < 3; ++c) result(c, Eigen::Index(n)) = masses_[n].v[c];
  return result;
}

void EdgeList::add_spring_forces() {
  for (const Spring& s : springs_) {
    Mass& a = masses_[std::size_t(s.i)];
    Mass& b = masses_[std::size_t(s.j)];
    const double d0 = b.x[0] - a.x[0], d1 = b.x[1] - a.x[1], d2 = b.x[2] - a.x[2];
    const double w0 = b.v[0] - a.v[0], w1 = b.v[1] - a.v[1], w2 = b.v[2] - a.v[2];
    const double length = std::sqrt(d0 * d0 + d1 * d1 + d2 * d2);
    const double inverse = 1.0 / length;
    const double rate = (w0 * d0 + w1 * d1 + w2 * d2) * inverse;
    const double pull = (s.stiffness * (length - s.rest_length) + s.damping * rate) * inverse;
    a.f[0] += pull * d0;
    a.f[1] += pull * d1;
    a.f[2] += pull * d2;
    b.f[0] -= pull * d0;
    b.f[1] -= pull * d1;
    b.f[2] -= pull * d2;
  }
}

void EdgeList::move() {
  const springs::PenaltyPlane& plane = problem_.plane;
  const double n[3] = {plane.normal[0], plane.normal[1], plane.normal[2]};
  const double gain = problem_.step / problem_.mass;
  for (Mass& m : masses_) {
    const double depth = plane.height - (n[0] * m.x[0] + n[1] * m.x[1] + n[2] * m.x[2]);
    double push = 0.0;
    if (depth > 0.0) {
      const double speed = n[0] * m.v[0] + n[1] * m.v[1] + n[2] * m.v[2];
      push = std::max(0.0, plane.stiffness * depth - plane.damping * speed);
    }
    for (int c = 0; c < 3; ++c) {
      m.v[c] += gain * (m.f[c] + push * n[c]) + problem_.step * problem_.gravity[c];
      m.x[c] += problem_.step * m.v[c];
      m.f[c] = 0.0;
    }
  }
}

void EdgeList::run(int steps) {
  for (int n = 0; n < steps; ++n) {
    add_spring_forces();
    move();
  }
}

}  // namespace spring_peers
