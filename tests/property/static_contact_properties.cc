// Properties of the ties between a lattice body and the plane, for any tip, deformation and plane.
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "lattice/statics/static_contact.h"
#include "tests/property/random_bodies.h"

using namespace fingertip;
using namespace fingertip::random;
using lattice::ElasticSystem;
using lattice::EmbeddedPoint;
using lattice::StaticContact;
using lattice::Tangent;

namespace {

meshes::Obstacle random_obstacle(const meshes::Geometry& geometry) {
  using enum meshes::ObstacleShape;
  meshes::Obstacle obstacle;
  obstacle.shape = *rc::gen::element(sphere, cylinder, edge);
  obstacle.radius = uniform(0.1, 2.0) * geometry.tip_radius;
  obstacle.along = *rc::gen::element(meshes::ObstacleAxis::x, meshes::ObstacleAxis::y);
  obstacle.offset = uniform(-0.7, 0.7) * geometry.tip_radius;
  return obstacle;
}

enum class Against { plane, obstacle };

/// A tip and a plane, or another obstacle, that comes at it anyhow.
struct Contact {
  explicit Contact(meshes::ContactMode mode, Against against = Against::plane)
      : specimen(random_tip(random_model())), system(specimen.body) {
    meshes::PressProtocol protocol;
    protocol.depth = uniform(0.05, 0.9) * specimen.geometry.thickness();
    protocol.tilt = uniform(-0.78, 0.78);
    protocol.lateral = uniform(-0.5, 0.5) * protocol.depth;
    if (against == Against::obstacle) protocol.obstacle = random_obstacle(specimen.geometry);
    plane = lattice::press_plane(protocol, specimen.geometry);
    depth = protocol.depth;
    contact = std::make_unique<StaticContact>(specimen.body, plane, mode);
  }

  /// From the tip at rest, whose feet are where its points are.
  void begin_step(double place) {
    contact->begin_step(place, VectorXd::Zero(specimen.body.unknowns()));
  }
  double gap(const EmbeddedPoint& point, const VectorXd& u) const {
    const Vector3 top = plane.point(contact->place()), from = position(point, u) - top;
    if (plane.obstacle.is_plane()) return from.dot(plane.normal);
    const Eigen::Matrix3d to_obstacle = plane.axes().transpose();
    if (specimen.body.finite) return hit(plane.obstacle, to_obstacle * from).gap;
    return from.dot(plane.normal) - height(plane.obstacle, to_obstacle * (point.rest - top));
  }
  /// Of the gap.
  Vector3 gradient(const EmbeddedPoint& point, const VectorXd& u) const {
    if (!specimen.body.finite || plane.obstacle.is_plane()) return plane.normal;
    const Vector3 from = position(point, u) - plane.point(contact->place());
    return plane.axes() * Vector3(hit(plane.obstacle, plane.axes().transpose() * from).normal);
  }
  VectorXd forces(const VectorXd& u) const {
    VectorXd force = VectorXd::Zero(u.size());
    contact->add(u, system, force, nullptr);
    return force;
  }
  double stiffness() const {
    double sum = 0.0;
    for (const EmbeddedPoint& point : specimen.body.outer) sum += point.stiffness;
    return sum;
  }

  Specimen specimen;
  ElasticSystem system;
  lattice::PressPlane plane;
  double depth = 0.0;
  std::unique_ptr<StaticContact> contact;
};

/// Energy, force and tangent fit together, and force and moment on the particles are the plane's.
void check_derivatives(const Contact& c, const VectorXd& u) {
  const LatticeBody& body = c.specimen.body;
  const VectorXd motion = random_field(body, 1.0);
  const double h = 1e-7 * c.specimen.spacing;
  VectorXd force = VectorXd::Zero(u.size());
  Tangent tangent = c.system.empty_tangent();
  const double sum = c.contact->add(u, c.system, force, &tangent);
  const double scale = sum + c.stiffness() * c.specimen.spacing;
  const double before = c.contact->energy(u - h * motion),
               after = c.contact->energy(u + h * motion);
  const double slope = (after - before) / (2.0 * h);
  // Each energy is a sum over the points, rounded as often.
  const double round_off = std::numeric_limits<double>::epsilon() *
                           std::sqrt(double(body.outer.size())) * (before + after) / (2.0 * h);
  RC_ASSERT(std::abs(slope + force.dot(motion)) <= 1e-7 * scale + round_off);
  const VectorXd differences = (c.forces(u - h * motion) - c.forces(u + h * motion)) / (2.0 * h);
  const VectorXd computed = tangent.selfadjointView<Eigen::Lower>() * motion;
  // Of an edge, differences may lie across the place where rounding and face meet.
  if (c.plane.obstacle.shape != meshes::ObstacleShape::edge)
    RC_ASSERT((computed - differences).norm() <= 1e-7 * c.stiffness());

  const Vector3 about = c.specimen.geometry.rod_endpoint();
  const lattice::PlaneReaction reaction = c.contact->reaction(u, about);
  Vector3 total = Vector3::Zero(), moment = Vector3::Zero();
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    const Vector3 f = force.segment<3>(3 * Eigen::Index(p));
    Vector3 at = body.rest[p];
    if (body.finite) at += u.segment<3>(3 * Eigen::Index(p));
    total += f;
    moment += (at - about).cross(f);
  }
  RC_ASSERT((total - reaction.force).norm() <= 1e-12 * scale);
  RC_ASSERT((moment - reaction.moment).norm() <= 1e-11 * scale * c.specimen.geometry.tip_radius);
}

/// Whether differences taken this near to `u` see no tie open or close.
bool away_from_kinks(const Contact& c, const VectorXd& u) {
  return std::ranges::all_of(c.specimen.body.outer, [&](const EmbeddedPoint& point) {
    return std::abs(c.gap(point, u)) > 1e-5 * c.specimen.spacing;
  });
}

bool frictionless_contact_only_pushes(Against against) {
  return rc::check("frictionless contact pushes along the normal, by its energy", [=] {
    Contact c(meshes::ContactMode::frictionless, against);
    const VectorXd u = random_displacement(c.specimen);
    c.begin_step(c.depth);
    RC_PRE(away_from_kinks(c, u));
    double work = 0.0;
    for (std::size_t i = 0; i < c.specimen.body.outer.size(); ++i) {
      const EmbeddedPoint& point = c.specimen.body.outer[i];
      const Vector3 force = c.contact->tie_force(i, u);
      const Vector3 normal = c.gradient(point, u);
      const double push = force.dot(normal), gap = c.gap(point, u);
      RC_ASSERT((force - push * normal).norm() <= 1e-14 * push);
      const bool pushes_where_crossed = gap < 0.0 ? push > 0.0 : push == 0.0;
      RC_ASSERT(pushes_where_crossed);
      if (gap < 0.0)
        work += point.stiffness *
                lattice::kernel::TiePush<double>(c.specimen.body.contact, -gap).energy;
    }
    RC_ASSERT(std::abs(c.contact->energy(u) - work) <= 1e-12 * work);
    check_derivatives(c, u);
    c.begin_step(-20.0 * c.specimen.geometry.tip_radius);
    RC_ASSERT(c.contact->energy(u) == 0.0);
    RC_ASSERT(c.forces(u).isZero(0.0));
  });
}

bool sticking_contact_holds_on_any_obstacle() {
  return rc::check("points that stick to an obstacle lie on it, until they are pulled", [] {
    Contact c(meshes::ContactMode::stick, Against::obstacle);
    const VectorXd rest = VectorXd::Zero(c.specimen.body.unknowns());
    const VectorXd u = random_displacement(c.specimen);
    c.begin_step(c.depth);
    RC_PRE(away_from_kinks(c, u));
    c.contact->anchor_touching(rest, 0.0, u);
    for (std::size_t i = 0; i < c.specimen.body.outer.size(); ++i)
      RC_ASSERT(c.contact->anchored(i) == (c.gap(c.specimen.body.outer[i], u) < 0.0));
    check_derivatives(c, u);
    c.begin_step(c.depth);
    c.contact->release_pulled(u);
    for (std::size_t i = 0; i < c.specimen.body.outer.size(); ++i)
      RC_ASSERT(!c.contact->anchored(i) ||
                c.contact->anchored_push(i, u) >= -2e-12 * c.specimen.body.outer[i].stiffness);
  });
}

bool sticking_contact_holds_what_it_touched() {
  return rc::check("sticking contact holds what crossed the plane until it is pulled", [] {
    Contact c(meshes::ContactMode::stick);
    const VectorXd rest = VectorXd::Zero(c.specimen.body.unknowns());
    const VectorXd u = random_displacement(c.specimen);
    c.begin_step(c.depth);
    RC_PRE(away_from_kinks(c, u));
    const int anchored = c.contact->anchor_touching(rest, 0.0, u);
    int crossed = 0;
    for (std::size_t i = 0; i < c.specimen.body.outer.size(); ++i) {
      const EmbeddedPoint& point = c.specimen.body.outer[i];
      // Seen from the plane the point goes straight from `first` to `last`; the plane holds it
      // where it crossed.
      const Vector3 first = point.rest - c.plane.point(0.0);
      const Vector3 last = position(point, u) - c.plane.point(c.depth);
      const double before = first.dot(c.plane.normal), after = last.dot(c.plane.normal);
      const Vector3 back = after / (before - after) * (last - first);
      // Beyond what a linear tie would push, that of a layer that stiffens.
      const double more =
          lattice::kernel::TiePush<double>(c.specimen.body.contact, std::max(-after, 0.0)).length -
          std::max(-after, 0.0);
      const Vector3 expected =
          after < 0.0 ? Vector3(point.stiffness * (back + more * c.plane.normal)) : Vector3::Zero();
      crossed += after < 0.0 ? 1 : 0;
      RC_ASSERT((c.contact->tie_force(i, u) - expected).norm() <=
                1e-11 * point.stiffness * c.specimen.geometry.tip_radius);
    }
    RC_ASSERT(anchored == crossed);
    check_derivatives(c, u);

    c.begin_step(uniform(-0.2, 1.0) * c.depth);
    c.contact->release_pulled(u);
    for (std::size_t i = 0; i < c.specimen.body.outer.size(); ++i)
      RC_ASSERT(!c.contact->anchored(i) ||
                c.contact->anchored_push(i, u) >= -2e-12 * c.specimen.body.outer[i].stiffness);
    c.begin_step(-20.0 * c.specimen.geometry.tip_radius);
    c.contact->release_pulled(u);
    RC_ASSERT(c.contact->energy(u) == 0.0);
    RC_ASSERT(c.forces(u).isZero(0.0));
  });
}

}  // namespace

int main() {
  bool good = frictionless_contact_only_pushes(Against::plane);
  good = frictionless_contact_only_pushes(Against::obstacle) && good;
  good = sticking_contact_holds_on_any_obstacle() && good;
  good = sticking_contact_holds_what_it_touched() && good;
  return good ? 0 : 1;
}
