#include "lattice/model/sector.h"

namespace fingertip::lattice::inline model {

using meshes::Vector3;

namespace {

/// A mirror turns round the force across it and the torques along it.
Vector6 even_under(const std::array<bool, 3>& mirrors) {
  Vector6 even = Vector6::Ones();
  for (Eigen::Index across = 0; across < 3; ++across) {
    if (!mirrors[std::size_t(across)]) continue;
    for (Eigen::Index c = 0; c < 3; ++c) even[c == across ? c : 3 + c] = 0.0;
  }
  return even;
}

Matrix6 all_of(int count, const Vector6& even, const Matrix6& part) {
  return count * Matrix6(even.asDiagonal() * part * even.asDiagonal());
}

}  // namespace

Sector::Sector(int count, const Eigen::Matrix3d& axes)
    : count_(count), world_(even_under({count > 2, count > 1, false})) {
  for (Eigen::Index c = 0; c < 3; ++c) {
    const bool x = axes(0, c) != 0.0, y = axes(1, c) != 0.0;
    mirrors_[std::size_t(c)] = (count > 2 && x) || (count > 1 && y);
  }
  grid_ = even_under(mirrors_);
}

void Sector::crop(meshes::CubicGrid& grid) const {
  const std::array<int, 3> middle = grid.nearest(Vector3::Zero());
  for (std::size_t d = 0; d < 3; ++d) {
    if (!mirrors_[d]) continue;
    grid.size[d] -= middle[d] - 1;
    grid.origin[Eigen::Index(d)] = -grid.spacing;
  }
}

bool Sector::is_before(const std::array<int, 3>& index) const {
  for (std::size_t d = 0; d < 3; ++d)
    if (mirrors_[d] && index[d] == 0) return true;
  return false;
}

void Sector::hold(const std::array<int, 3>& index, Eigen::Matrix3d& matrix) const {
  for (std::size_t d = 0; d < 3; ++d) {
    if (!holds(d, index[d])) continue;
    matrix.row(Eigen::Index(d)).setZero();
    matrix.col(Eigen::Index(d)).setZero();
  }
}

double Sector::share(const std::array<int, 3>& index) const {
  double share = 1.0;
  for (std::size_t d = 0; d < 3; ++d)
    if (holds(d, index[d])) share *= 0.5;
  return share;
}

Wrench Sector::whole(const Wrench& part) const {
  const Wrench even = this->even(part);
  return {count_ * even.force, count_ * even.torque};
}

Vector3 Sector::whole(const Vector3& part) const {
  return count_ * world_.head<3>().cwiseProduct(part);
}

Matrix6 Sector::whole(const Matrix6& part) const {
  return all_of(count_, world_, part);
}

Vector6 Sector::whole_on_grid(const Vector6& part) const {
  return count_ * grid_.cwiseProduct(part);
}

Matrix6 Sector::whole_on_grid(const Matrix6& part) const {
  return all_of(count_, grid_, part);
}

Wrench Sector::even(const Wrench& wrench) const {
  return {world_.head<3>().cwiseProduct(wrench.force),
          world_.tail<3>().cwiseProduct(wrench.torque)};
}

}  // namespace fingertip::lattice::inline model
