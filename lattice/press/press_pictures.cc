#include "lattice/press/press_pictures.h"

#include <utility>

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

}  // namespace

std::vector<Vector3> rest_places(const LatticeModel& model) {
  std::vector<Vector3> places;
  for (const std::uint32_t p : model.particles) places.push_back(model.rest_position(p));
  return places;
}

ComputedParticles particles_of(const Finger& finger) {
  const LatticeModel& model = finger.model();
  const std::vector<std::uint8_t> of_boundary = finger.held();
  std::vector<std::uint8_t> of_point(model.points(), 0);
  for (std::size_t b = 0; b < of_boundary.size(); ++b) of_point[model.boundary[b]] = of_boundary[b];
  ComputedParticles result;
  for (const std::uint32_t p : model.particles) {
    result.moved.emplace_back(model.grid.axes * finger.state().displacement.at(p));
    result.held.push_back(of_point[p]);
  }
  return result;
}

PressPictures::PressPictures(const PressSetup& setup, int sectors, const std::vector<Vector3>& rest,
                             const LatticeModel* whole, Moment first, PressShapes& shapes)
    : built_(whole ? std::optional<LatticeModel>()
                   : build_tip(setup.geometry, setup.rubber, setup.lattice)),
      model_(whole ? whole : &*built_),
      state_(*model_),
      view_(*model_, setup.geometry),
      next_(first),
      before_contact_(-0.5 * setup.protocol.clearance),
      half_depth_(0.5 * setup.protocol.depth),
      shapes_(&shapes) {
  for (const Vector3& mirror : mirrors(sectors)) {
    for (std::size_t p = 0; p < rest.size(); ++p) {
      const auto [i, j, k] = model_->grid.nearest(mirror.cwiseProduct(rest[p]));
      images_.push_back({p, model_->grid.index(i, j, k), mirror});
    }
  }
  shapes.boundary_rest = view_.rest();
  shapes.boundary_springs = view_.springs();
}

FingerPicture PressPictures::draw(FingerPicture bare, const ComputedParticles& now,
                                  const Vector3& travel) {
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  std::vector<std::uint8_t> of_point(model_->points(), 0), of_boundary;
  for (const auto& [particle, point, mirror] : images_) {
    state_.displacement.set(point, to_grid * (mirror.cwiseProduct(now.moved[particle]) + travel));
    of_point[point] = now.held[particle];
  }
  for (const std::uint32_t point : model_->boundary) of_boundary.push_back(of_point[point]);
  bare.boundary = view_.deformed(state_);
  bare.held = view_.held(of_boundary);
  return bare;
}

bool PressPictures::due(double indentation, bool touching) const {
  switch (next_) {
    case Moment::before_contact: return indentation >= before_contact_;
    case Moment::first_touch: return touching;
    case Moment::half_depth: return indentation >= half_depth_;
    case Moment::end: return false;
  }
  return false;
}

void PressPictures::keep(FingerPicture picture) {
  shapes_->snapshots.push_back({std::move(picture), next_});
  next_ = Moment(int(next_) + 1);
}

void PressPictures::finish(FingerPicture picture) {
  next_ = Moment::end;
  keep(std::move(picture));
}

}  // namespace fingertip::lattice::inline press
