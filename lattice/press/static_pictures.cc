#include "lattice/press/static_pictures.h"

#include <array>
#include <cmath>
#include <utility>

#include "lattice/model/cut_model.h"

namespace fingertip::lattice {

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
  const Vector3 place = grid.coordinates(rest);
  return grid.index(int(std::lround(place.x())), int(std::lround(place.y())),
                    int(std::lround(place.z())));
}

}  // namespace

StaticPictures::StaticPictures(const PressSetup& setup, const LatticeBody& body,
                               PressShapes& shapes)
    : setup_(setup),
      body_(body),
      model_(build_tip(setup.geometry, setup.rubber, setup.lattice)),
      view_(model_, setup.geometry),
      recorder_(view_, setup.protocol, Moment::first_touch, shapes),
      state_(model_) {
  for (const Vector3& mirror : mirrors(body.sectors))
    for (std::size_t p = 0; p < body.rest.size(); ++p)
      images_.push_back({p, grid_point(model_.grid, mirror.cwiseProduct(body.rest[p])), mirror});
}

/// What the contact holds of a surface point's cell it holds of its particles, as in motion.
std::vector<std::uint8_t> StaticPictures::held(const StaticContact& contact,
                                               const Eigen::VectorXd& displacement) const {
  std::vector<std::uint8_t> of_body(body_.rest.size(), 0), of_model(model_.points(), 0);
  for (std::size_t i = 0; i < body_.outer.size(); ++i) {
    if (!(contact.pressure(i, displacement) > 0.0)) continue;
    for (std::size_t c = 0; c < 8; ++c)
      if (body_.outer[i].weights[c] != 0.0) of_body[body_.outer[i].corners[c]] = 1;
  }
  for (const Image& image : images_) of_model[image.point] = of_body[image.particle];
  std::vector<std::uint8_t> result;
  for (const std::uint32_t point : model_.boundary) result.push_back(of_model[point]);
  return result;
}

FingerPicture StaticPictures::take(const StaticContact& contact,
                                   const Eigen::VectorXd& displacement, const Wrench& on_rod) {
  const PressPlane& plane = contact.plane();
  const Vector3 travel = plane.point(0.0) - plane.point(contact.place());
  for (const auto& [particle, point, mirror] : images_) {
    const Vector3 moved = displacement.segment<3>(3 * Eigen::Index(particle));
    state_.displacement.set(point,
                            model_.grid.axes.transpose() * (mirror.cwiseProduct(moved) + travel));
  }
  FingerPicture picture;
  picture.time = meshes::unknown;
  picture.indentation = contact.pose().indentation;
  picture.rod.position = travel;
  picture.endpoint = setup_.geometry.rod_endpoint() + travel;
  picture.on_rod = on_rod;
  picture.plane.point = plane.point(0.0);
  picture.plane.normal = plane.normal;
  picture.plane.obstacle = plane.obstacle;
  picture.boundary = view_.deformed(state_);
  picture.held = view_.held(held(contact, displacement));
  return picture;
}

void StaticPictures::look(const StaticContact& contact, const Eigen::VectorXd& displacement,
                          const Wrench& on_rod) {
  // An equilibrium at indentation 0 touches, without force.
  if (recorder_.due(contact.pose().indentation, true))
    recorder_.keep(take(contact, displacement, on_rod));
}

void StaticPictures::finish(const StaticContact& contact, const Eigen::VectorXd& displacement,
                            const Wrench& on_rod) {
  recorder_.finish(take(contact, displacement, on_rod));
}

}  // namespace fingertip::lattice
