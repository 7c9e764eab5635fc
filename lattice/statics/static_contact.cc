#include "lattice/statics/static_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fingertip::lattice {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using meshes::Vector3;

namespace {

/// Gaps below this length [m] are round-off: a picometre.
constexpr double gap_noise = 1e-12;

}  // namespace

StaticContact::StaticContact(const LatticeBody& body, const PressPlane& plane,
                             meshes::ContactMode mode)
    : body_(&body),
      plane_(plane),
      stick_(mode == meshes::ContactMode::stick),
      anchored_(body.outer.size(), 0),
      released_(body.outer.size(), 0),
      anchor_(body.outer.size(), Vector3::Zero()) {}

double StaticContact::gap(std::size_t point, const VectorXd& displacement, double place) const {
  return (position(body_->outer[point], displacement) - plane_.point(place)).dot(plane_.normal);
}

bool StaticContact::touches(std::size_t point, const VectorXd& displacement) const {
  return stick_ ? anchored_[point] != 0 : gap(point, displacement, place_) < 0.0;
}

Vector3 StaticContact::tie_force(std::size_t point, const VectorXd& displacement) const {
  const EmbeddedPoint& outer = body_->outer[point];
  if (!stick_) {
    const double g = gap(point, displacement, place_);
    return -outer.stiffness * std::min(g, 0.0) * plane_.normal;
  }
  if (!anchored_[point]) return Vector3::Zero();
  return outer.stiffness * (plane_.point(place_) + anchor_[point] - position(outer, displacement));
}

double StaticContact::pressure(std::size_t point, const VectorXd& displacement) const {
  return tie_force(point, displacement).dot(plane_.normal) / body_->outer[point].area;
}

double StaticContact::energy(const VectorXd& displacement) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i)
    sum += tie_force(i, displacement).squaredNorm() / (2.0 * body_->outer[i].stiffness);
  return sum;
}

double StaticContact::add(const VectorXd& displacement, const ElasticSystem& system,
                          VectorXd& force, Tangent* tangent) const {
  const Matrix3d shape =
      stick_ ? Matrix3d(Matrix3d::Identity()) : Matrix3d(plane_.normal * plane_.normal.transpose());
  double sum = 0.0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!touches(i, displacement)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 push = tie_force(i, displacement);
    sum += push.norm();
    for (std::size_t c = 0; c < 8; ++c)
      force.segment<3>(3 * Eigen::Index(outer.corners[c])) += outer.weights[c] * push;
    if (tangent) system.add_embedded(outer, outer.stiffness * shape, *tangent);
  }
  return sum;
}

std::vector<FirstTouch> StaticContact::first_touches(const VectorXd& start, double from,
                                                     const VectorXd& end) const {
  std::vector<FirstTouch> touches;
  if (!stick_) return touches;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (anchored_[i]) continue;
    const double after = gap(i, end, place_);
    if (after >= -gap_noise) continue;
    touches.push_back({i, std::max(gap(i, start, from), 0.0), after,
                       position(body_->outer[i], start) - plane_.point(from),
                       position(body_->outer[i], end) - plane_.point(place_)});
  }
  return touches;
}

int StaticContact::anchor_touching(const VectorXd& start, double from, const VectorXd& end) {
  const std::vector<FirstTouch> touches = first_touches(start, from, end);
  for (const FirstTouch& touch : touches) {
    const Vector3 place = (1.0 - touch.share()) * touch.first + touch.share() * touch.last;
    anchor_[touch.point] = place - place.dot(plane_.normal) * plane_.normal;
    anchored_[touch.point] = 1;
  }
  return int(touches.size());
}

int StaticContact::release_pulled(const VectorXd& displacement) {
  int count = 0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!anchored_[i] || released_[i]) continue;
    if (gap(i, displacement, place_) <= gap_noise) continue;
    anchored_[i] = 0;
    released_[i] = 1;
    ++count;
  }
  return count;
}

PlaneReaction StaticContact::reaction(const VectorXd& displacement, const Vector3& about) const {
  PlaneReaction result;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 push = tie_force(i, displacement);
    const Vector3 place = body_->finite ? position(outer, displacement) : outer.rest;
    result.force += push;
    result.moment += (place - about).cross(push);
  }
  return result;
}

std::vector<LoadedPoint> StaticContact::loaded_points(const VectorXd& displacement) const {
  std::vector<LoadedPoint> points;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    const double push = tie_force(i, displacement).dot(plane_.normal);
    if (!(push > 0.0)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 place = body_->finite ? position(outer, displacement) : outer.rest;
    points.push_back({{place.dot(plane_.t1), place.dot(plane_.t2)},
                      push,
                      outer.area * std::abs(outer.normal.dot(plane_.normal))});
  }
  return points;
}

}  // namespace fingertip::lattice
