#include "lattice/statics/static_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fingertip::lattice::inline statics {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using meshes::Vector3;
using TiePush = kernel::TiePush<double>;

namespace {

/// Gaps below this length [m] are round-off: a picometre.
constexpr double gap_noise = 1e-12;

}  // namespace

StaticContact::StaticContact(const LatticeBody& body, const PressPlane& plane,
                             meshes::ContactMode mode)
    : body_(&body),
      plane_(plane),
      axes_(plane.axes()),
      stick_(mode == meshes::ContactMode::stick),
      anchored_(body.outer.size(), 0),
      released_(body.outer.size(), 0),
      anchor_(body.outer.size(), Vector3::Zero()),
      anchor_normal_(body.outer.size(), plane.normal) {}

StaticContact::Relative StaticContact::relative(std::size_t point, const VectorXd& displacement,
                                                double place) const {
  const EmbeddedPoint& outer = body_->outer[point];
  const Vector3 top = plane_.point(place);
  return {position(outer, displacement) - top, outer.rest - top};
}

StaticContact::GapAndNormal StaticContact::gap_and_normal(const Relative& point) const {
  const double over = point.now.dot(plane_.normal);
  if (plane_.obstacle.is_plane()) return {over, plane_.normal};
  if (!body_->finite)
    return {over - height(plane_.obstacle, axes_.transpose() * point.rest), plane_.normal};
  const auto found = hit(plane_.obstacle, axes_.transpose() * point.now);
  return {found.gap, axes_ * Vector3(found.normal)};
}

Matrix3d StaticContact::bend(const Relative& point) const {
  if (plane_.obstacle.is_plane() || !body_->finite) return Matrix3d::Zero();
  return axes_ * curvature(plane_.obstacle, axes_.transpose() * point.now) * axes_.transpose();
}

bool StaticContact::touches(std::size_t point, const VectorXd& displacement) const {
  return stick_ ? anchored_[point] != 0 : gap_and_normal(point, displacement).gap < 0.0;
}

Vector3 StaticContact::tie_force(std::size_t point, const VectorXd& displacement) const {
  const EmbeddedPoint& outer = body_->outer[point];
  if (stick_ && !anchored_[point]) return Vector3::Zero();
  const GapAndNormal now = gap_and_normal(point, displacement);
  const double depth = std::max(-now.gap, 0.0), push = TiePush(body_->contact, depth).length;
  if (!stick_) return outer.stiffness * push * now.normal;
  const Vector3 stretch = plane_.point(place_) + anchor_[point] - position(outer, displacement);
  return outer.stiffness * (stretch + (push - depth) * now.normal);
}

double StaticContact::energy(const VectorXd& displacement) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!touches(i, displacement)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const double depth = std::max(-gap_and_normal(i, displacement).gap, 0.0);
    double own = TiePush(body_->contact, depth).energy;
    if (stick_) {
      const Vector3 stretch = plane_.point(place_) + anchor_[i] - position(outer, displacement);
      own += 0.5 * (stretch.squaredNorm() - depth * depth);
    }
    sum += outer.stiffness * own;
  }
  return sum;
}

double StaticContact::add(const VectorXd& displacement, const ElasticSystem& system,
                          VectorXd& force, Tangent* tangent) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!touches(i, displacement)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 push = tie_force(i, displacement);
    sum += push.norm();
    for (std::size_t c = 0; c < 8; ++c)
      force.segment<3>(3 * Eigen::Index(outer.corners[c])) += outer.weights[c] * push;
    if (!tangent) continue;
    const Relative at = relative(i, displacement, place_);
    const GapAndNormal now = gap_and_normal(at);
    const double depth = std::max(-now.gap, 0.0);
    const TiePush tie(body_->contact, depth);
    const Matrix3d along = now.normal * now.normal.transpose();
    Matrix3d shape = tie.tangent * along - tie.length * bend(at);
    if (stick_) shape += Matrix3d::Identity() - along + depth * bend(at);
    system.add_embedded(outer, outer.stiffness * shape, *tangent);
  }
  return sum;
}

std::vector<FirstTouch> StaticContact::first_touches(const VectorXd& start, double from,
                                                     const VectorXd& end) const {
  std::vector<FirstTouch> touches;
  if (!stick_) return touches;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (anchored_[i]) continue;
    const Relative last = relative(i, end, place_);
    const GapAndNormal after = gap_and_normal(last);
    if (after.gap >= -gap_noise) continue;
    const Relative first = relative(i, start, from);
    const GapAndNormal before = gap_and_normal(first);
    FirstTouch touch{.point = i,
                     .before = std::max(before.gap, 0.0),
                     .after = after.gap,
                     .first = first.now,
                     .last = last.now,
                     .first_normal = before.normal,
                     .last_normal = after.normal,
                     .anchor = {},
                     .projection = {}};
    // The gap is linear in the place for a plane and at small strain; else nearly so within a step.
    const double share = touch.share();
    const Relative there{(1.0 - share) * first.now + share * last.now,
                         (1.0 - share) * first.rest + share * last.rest};
    const GapAndNormal left = gap_and_normal(there);
    touch.anchor = there.now - left.gap * left.normal;
    touch.projection =
        Matrix3d::Identity() - left.normal * left.normal.transpose() - left.gap * bend(there);
    touches.push_back(touch);
  }
  return touches;
}

int StaticContact::anchor_touching(const VectorXd& start, double from, const VectorXd& end) {
  const std::vector<FirstTouch> touches = first_touches(start, from, end);
  for (const FirstTouch& touch : touches) {
    const std::size_t i = touch.point;
    anchor_[i] = touch.anchor;
    anchored_[i] = 1;
    if (body_->finite) anchor_normal_[i] = gap_and_normal({touch.anchor, touch.anchor}).normal;
  }
  return int(touches.size());
}

int StaticContact::release_pulled(const VectorXd& displacement) {
  int count = 0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!anchored_[i] || released_[i]) continue;
    if (anchored_push(i, displacement) >= -gap_noise * body_->outer[i].stiffness) continue;
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

double StaticContact::area(std::size_t point, const VectorXd& displacement) const {
  const EmbeddedPoint& outer = body_->outer[point];
  if (!body_->finite) return seen_area(outer, plane_.normal);
  const auto edge = [&](std::size_t c) -> Vector3 {
    return body_->rest[outer.corners[c]] - body_->rest[outer.corners[0]];
  };
  const Matrix3d edges = (Matrix3d() << edge(1), edge(2), edge(4)).finished();
  if (edges.isZero(0.0)) return outer.area;  // a particle itself
  Eigen::Matrix<double, 3, 8> moved;
  for (int c = 0; c < 8; ++c)
    moved.col(c) = displacement.segment<3>(3 * Eigen::Index(outer.corners[std::size_t(c)]));
  return carried_surface(outer, moved, edges).norm();
}

std::vector<TiedPoint> StaticContact::points(const VectorXd& displacement) const {
  const Matrix3d to_plane = field_axes(plane_.normal).transpose();
  std::vector<TiedPoint> points;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    const EmbeddedPoint& outer = body_->outer[i];
    points.push_back({{}, outer.corners, outer.weights});
    meshes::ContactPoint& point = points.back().point;
    point.place = to_plane * (body_->finite ? position(outer, displacement) : outer.rest);
    point.normal = to_plane * gap_and_normal(i, displacement).normal;
    point.area = area(i, displacement);
    point.set_force(to_plane * tie_force(i, displacement));
    point.state = stick_ ? meshes::ContactState::stick : meshes::ContactState::slip;
    if (!stick_) point.shear.setZero();  // but for round-off it is
  }
  return points;
}

std::vector<meshes::LoadedPoint> StaticContact::loaded_points(const VectorXd& displacement) const {
  std::vector<meshes::LoadedPoint> points;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    const double push = tie_force(i, displacement).dot(plane_.normal);
    if (!(push > 0.0)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 place = body_->finite ? position(outer, displacement) : outer.rest;
    points.push_back(
        {{place.dot(plane_.t1), place.dot(plane_.t2)}, push, seen_area(outer, plane_.normal)});
  }
  return points;
}

}  // namespace fingertip::lattice::inline statics
