#include "lattice/press/marker_points.h"

#include <algorithm>

#include "lattice/kernels/stencil.h"
#include "lattice/model/cut_tip.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

MarkerPoints::MarkerPoints(const PressSetup& setup, int sectors, const std::vector<Vector3>& rest)
    : rest_(setup.protocol.markers) {
  if (setup.protocol.markers.empty()) return;
  const meshes::CubicGrid grid = tip_grid(setup.geometry, setup.lattice, sectors);
  std::vector<std::uint32_t> particle_at(grid.points(), GridCells::none);
  for (std::uint32_t p = 0; p < rest.size(); ++p) {
    const auto [i, j, k] = grid.nearest(rest[p]);
    particle_at[grid.index(i, j, k)] = p;
  }
  const auto corners_of = [&](const std::array<int, 3>& lowest) {
    std::array<std::uint32_t, 8> corners;
    corners.fill(GridCells::none);
    for (std::size_t d = 0; d < 3; ++d)
      if (lowest[d] < 0 || lowest[d] + 1 >= grid.size[d]) return corners;
    for (int c = 0; c < 8; ++c)
      corners[std::size_t(c)] =
          particle_at[cell_corner(grid.size, grid.index(lowest[0], lowest[1], lowest[2]), c)];
    return corners;
  };
  const auto is_whole = [&](const std::array<int, 3>& lowest) {
    return std::ranges::count(corners_of(lowest), GridCells::none) == 0;
  };
  for (const Vector3& marker : setup.protocol.markers) {
    const Vector3 mirror(sectors > 2 && marker.x() < 0.0 ? -1.0 : 1.0,
                         sectors > 1 && marker.y() < 0.0 ? -1.0 : 1.0, 1.0);
    const auto place = place_in_cell(grid.coordinates(mirror.cwiseProduct(marker)), is_whole);
    if (!place)
      throw meshes::InvalidInput({"lattice.spacing", meshes::to_text(grid.spacing) + " m",
                                  "every marker needs a cell near it (sensor.markers)",
                                  "choose a finer lattice"});
    images_.push_back({corners_of(place->lowest), place->weights, mirror});
  }
}

std::vector<Vector3> MarkerPoints::displacements(
    const std::function<Vector3(std::uint32_t)>& moved) const {
  std::vector<Vector3> result;
  for (const Image& image : images_) {
    Vector3 sum = Vector3::Zero();
    for (std::size_t c = 0; c < 8; ++c) sum += image.weights[c] * moved(image.corners[c]);
    result.push_back(image.mirror.cwiseProduct(sum));
  }
  return result;
}

std::vector<Vector3> MarkerPoints::places(const LatticeModel& model, const State& state,
                                          double ahead) const {
  std::vector<Vector3> result = displacements([&](std::uint32_t particle) {
    const std::uint32_t point = model.particles[particle];
    return Vector3(model.grid.axes *
                   (state.displacement.at(point) + ahead * state.velocity.at(point)));
  });
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += rest_[i];
  return result;
}

}  // namespace fingertip::lattice::inline press
