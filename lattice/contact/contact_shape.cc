#include "lattice/contact/contact_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace fingertip::lattice::inline contact {

using meshes::Vector3;

namespace {

using Cell = std::array<std::uint32_t, 8>;  // its corners

/// The points of every cell, in the order of the cells' first points.
std::vector<std::vector<std::uint32_t>> points_by_cell(const std::vector<EmbeddedPoint>& points) {
  std::vector<std::vector<std::uint32_t>> result;
  std::map<Cell, std::size_t> number;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    const auto [found, is_new] = number.emplace(points[p].corners, result.size());
    if (is_new) result.emplace_back();
    result[found->second].push_back(p);
  }
  return result;
}

/// Lane `lane` of a group becomes this point, or if it only fills up one that is tied to nothing.
void set_point(kernel::ContactGroup& group, std::size_t lane, const EmbeddedPoint& tie,
               const Eigen::Matrix3d& to_grid, bool fills_up) {
  const Vector3 rest = to_grid * tie.rest, facing = tie.area * (to_grid * tie.normal);
  double size = 0.0;
  for (const double weight : tie.weights) size += std::abs(weight);
  group.stiffness.at[lane] = fills_up ? 0.0 : tie.stiffness;
  group.inertia.at[lane] = size * group.stiffness.at[lane];
  for (std::size_t c = 0; c < 3; ++c) {
    group.rest[c].at[lane] = rest[Eigen::Index(c)];
    group.facing[c].at[lane] = facing[Eigen::Index(c)];
  }
  for (std::size_t c = 0; c < 8; ++c) {  // trilinear weights have their point as their mean
    for (std::size_t d = 0; d < 3; ++d)
      group.local[d].at[lane] += double(c >> d & 1) * tie.weights[c];
  }
}

/// Up to eight points of a cell, from the `first` on. `number`: of contact particles, by grid
/// index.
void add_group(const LatticeModel& model, const std::map<std::uint32_t, std::uint32_t>& number,
               const std::vector<std::uint32_t>& cell, std::size_t first, ContactShape& shape) {
  kernel::ContactGroup group{};
  for (std::size_t c = 0; c < 8; ++c) {
    group.corner[c] = model.outer[cell[first]].corners[c];
    group.particle[c] = number.at(group.corner[c]);
  }
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const bool fills_up = first + lane >= cell.size();
    const std::uint32_t point = cell[fills_up ? first : first + lane];
    const EmbeddedPoint& tie = model.outer[point];
    set_point(group, lane, tie, model.grid.axes.transpose(), fills_up);
    shape.points.push_back(point);
    shape.reach = std::max(shape.reach, (tie.rest - shape.centre).norm());
  }
  shape.groups.push_back(group);
}

void list_places(ContactShape& shape) {
  shape.first_place.assign(shape.particles.size() + 1, 0);
  for (const kernel::ContactGroup& group : shape.groups) {
    for (const std::uint32_t particle : group.particle) ++shape.first_place[particle + 1];
  }
  std::partial_sum(shape.first_place.begin(), shape.first_place.end(), shape.first_place.begin());
  shape.places.resize(shape.first_place.back());
  std::vector<std::uint32_t> next(shape.first_place.begin(), shape.first_place.end() - 1);
  for (std::uint32_t g = 0; g < shape.groups.size(); ++g) {
    for (std::uint32_t c = 0; c < lanes; ++c) {
      shape.places[next[shape.groups[g].particle[c]]++] = {g, c};
    }
  }
}

}  // namespace

std::shared_ptr<const ContactShape> contact_shape(const LatticeModel& model) {
  const Eigen::Matrix3d to_grid = model.grid.axes.transpose();
  auto shape = std::make_shared<ContactShape>();
  std::map<std::uint32_t, std::uint32_t> number;
  for (const EmbeddedPoint& tie : model.outer) {
    for (const std::uint32_t corner : tie.corners) number.emplace(corner, 0);
    shape->centre += tie.rest / double(model.outer.size());
  }
  for (auto& [particle, n] : number) {
    n = std::uint32_t(shape->particles.size());
    shape->particles.push_back(particle);
    shape->rest.push_back(to_grid * model.rest_position(particle));
  }
  for (const std::vector<std::uint32_t>& cell : points_by_cell(model.outer)) {
    for (std::size_t first = 0; first < cell.size(); first += lanes) {
      add_group(model, number, cell, first, *shape);
    }
  }
  list_places(*shape);
  shape->bonded.resize(shape->particles.size(), 0);
  for (const EmbeddedPoint& tie : model.bond) {
    for (const std::uint32_t corner : tie.corners) {
      const auto found = number.find(corner);
      if (found != number.end()) shape->bonded[found->second] = 1;
    }
  }
  return shape;
}

}  // namespace fingertip::lattice::inline contact
