#include "lattice/press/boundary_view.h"

#include <algorithm>

#include "lattice/model/cut_tip.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

BoundaryView::BoundaryView(const LatticeModel& model, const meshes::Geometry& geometry)
    : model_(&model) {
  const std::vector<Candidate> all = candidates(geometry);
  std::vector<int> number(model.points(), -1);
  for (std::size_t b = 0; b < all.size(); ++b) {
    const bool on_surface = all[b].tie || all[b].rest.z() < lowest_contact(geometry);
    if (model.is_cut() && !on_surface) continue;
    number[model.boundary[b]] = int(rest_.size());
    rest_.push_back(all[b].rest);
    entry_.push_back(b);
    drawn_.push_back(all[b].tie);
  }
  for (const std::size_t i : model.boundary) {
    if (number[i] < 0) continue;
    for (int s = 0; s < directions; ++s) {
      if (half_stencil[std::size_t(s)].family != axis) continue;
      const std::size_t j = i + std::size_t(neighbour_offset(model.grid.size, s));
      if (number[j] >= 0) springs_.push_back({number[i], number[j]});
    }
  }
}

std::vector<BoundaryView::Candidate> BoundaryView::candidates(
    const meshes::Geometry& geometry) const {
  std::vector<Candidate> all;
  std::vector<int> number(model_->points(), -1);
  const auto shape = meshes::shape_of(geometry);
  for (const std::uint32_t particle : model_->boundary) {
    number[particle] = int(all.size());
    const Vector3 rest = model_->rest_position(particle);
    // Cut cells reach beyond the surface.
    const Vector3 place =
        model_->is_cut() ? shape->nearest(meshes::ProfileSurface::contact, rest).position : rest;
    all.push_back({place, nullptr});
  }
  const std::vector<Candidate> nominal = all;
  for (const EmbeddedPoint& tie : model_->outer) {
    for (const std::uint32_t corner : tie.corners) {
      if (number[corner] < 0) continue;
      const auto b = std::size_t(number[corner]);
      const Vector3& wanted = nominal[b].rest;
      if (all[b].tie && (all[b].rest - wanted).norm() <= (tie.rest - wanted).norm()) continue;
      all[b] = {tie.rest, &tie};
    }
  }
  return all;
}

std::vector<Vector3> BoundaryView::deformed(const State& state) const {
  std::vector<Vector3> places;
  places.reserve(size());
  for (std::size_t p = 0; p < size(); ++p) {
    const Vector3 moved = drawn_[p] ? shift(*drawn_[p], state, 0.0)
                                    : state.displacement.at(model_->boundary[entry_[p]]);
    places.push_back(rest_[p] + model_->grid.axes * moved);
  }
  return places;
}

std::vector<std::uint8_t> BoundaryView::held(const std::vector<std::uint8_t>& of_boundary) const {
  std::vector<std::uint8_t> result;
  result.reserve(size());
  for (const std::size_t b : entry_) result.push_back(of_boundary[b]);
  return result;
}

FingerPicture bare_picture(const Finger& finger, double indentation) {
  FingerPicture picture;
  picture.time = finger.time();
  picture.indentation = indentation;
  picture.rod = finger.rod().pose();
  picture.endpoint = finger.rod().endpoint();
  picture.on_rod = finger.bond();
  picture.plane = finger.plane();
  return picture;
}

}  // namespace fingertip::lattice::inline press
