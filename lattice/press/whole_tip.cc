#include "lattice/press/whole_tip.h"

#include "lattice/model/cut_model.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

namespace {

/// Signs of the mirror images that make the whole tip of one of 1, 2 (y >= 0) or 4 parts.
std::vector<Vector3> mirrors(int sectors) {
  std::vector<Vector3> signs{{1.0, 1.0, 1.0}};
  if (sectors > 1) signs.emplace_back(1.0, -1.0, 1.0);
  if (sectors > 2) {
    signs.emplace_back(-1.0, 1.0, 1.0);
    signs.emplace_back(-1.0, -1.0, 1.0);
  }
  return signs;
}

std::size_t grid_point(const meshes::CubicGrid& grid, const Vector3& rest) {
  const auto [i, j, k] = grid.nearest(rest);
  return grid.index(i, j, k);
}

}  // namespace

WholeTip::WholeTip(const PressSetup& setup, int sectors, const std::vector<Vector3>& rest)
    : model_(build_tip(setup.geometry, setup.rubber, setup.lattice)), state_(model_) {
  for (const Vector3& mirror : mirrors(sectors))
    for (std::size_t p = 0; p < rest.size(); ++p)
      images_.push_back({p, grid_point(model_.grid, mirror.cwiseProduct(rest[p])), mirror});
}

const State& WholeTip::state(const std::vector<Vector3>& moved, const Vector3& travel) {
  const Eigen::Matrix3d to_grid = model_.grid.axes.transpose();
  for (const auto& [particle, point, mirror] : images_)
    state_.displacement.set(point, to_grid * (mirror.cwiseProduct(moved[particle]) + travel));
  return state_;
}

std::vector<std::uint8_t> WholeTip::boundary(const std::vector<std::uint8_t>& of_part) const {
  std::vector<std::uint8_t> of_model(model_.points(), 0), result;
  for (const Image& image : images_) of_model[image.point] = of_part[image.particle];
  for (const std::uint32_t point : model_.boundary) result.push_back(of_model[point]);
  return result;
}

}  // namespace fingertip::lattice::inline press
