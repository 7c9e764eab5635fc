#include "lattice/press/static_pictures.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

StaticPictures::StaticPictures(const PressSetup& setup, const LatticeBody& body,
                               PressShapes& shapes)
    : setup_(setup),
      body_(body),
      whole_(setup, body.sectors, body.rest),
      view_(whole_.model(), setup.geometry),
      recorder_(view_, setup.protocol, Moment::first_touch, shapes) {}

/// What the contact holds of a surface point's cell it holds of its particles, as in motion.
std::vector<std::uint8_t> StaticPictures::held(const StaticContact& contact,
                                               const Eigen::VectorXd& displacement) const {
  std::vector<std::uint8_t> of_body(body_.rest.size(), 0);
  for (std::size_t i = 0; i < body_.outer.size(); ++i) {
    if (!(contact.pressure(i, displacement) > 0.0)) continue;
    for (std::size_t c = 0; c < 8; ++c)
      if (body_.outer[i].weights[c] != 0.0) of_body[body_.outer[i].corners[c]] = 1;
  }
  return whole_.boundary(of_body);
}

FingerPicture StaticPictures::take(const StaticContact& contact,
                                   const Eigen::VectorXd& displacement, const Wrench& on_rod) {
  const PressPlane& plane = contact.plane();
  const Vector3 travel = plane.point(0.0) - plane.point(contact.place());
  std::vector<Vector3> moved;
  for (std::size_t p = 0; p < body_.rest.size(); ++p)
    moved.emplace_back(displacement.segment<3>(3 * Eigen::Index(p)));
  FingerPicture picture;
  picture.time = meshes::unknown;
  picture.indentation = contact.pose().indentation;
  picture.rod.position = travel;
  picture.endpoint = setup_.geometry.rod_endpoint() + travel;
  picture.on_rod = on_rod;
  picture.plane.point = plane.point(0.0);
  picture.plane.normal = plane.normal;
  picture.plane.obstacle = plane.obstacle;
  picture.boundary = view_.deformed(whole_.state(moved, travel));
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

}  // namespace fingertip::lattice::inline press
