#include "lattice/statics/static_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fingertip::lattice::inline statics {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using meshes::ContactMode;
using meshes::Vector3;
using TiePush = kernel::TiePush<double>;

namespace {

/// Gaps below this length [m] are round-off: a picometre.
constexpr double gap_noise = 1e-12;
/// What is left to the length at which friction gives way when a point slides: round-off.
constexpr double held_yet = 1e-9;
constexpr double endless = std::numeric_limits<double>::infinity();

}  // namespace

StaticContact::StaticContact(const LatticeBody& body, const PressPlane& plane,
                             const ContactLaw& law)
    : body_(&body),
      plane_(plane),
      axes_(plane.axes()),
      law_(law),
      anchored_(body.outer.size(), 0),
      released_(body.outer.size(), 0),
      start_(body.outer.size()),
      part_(body.outer.size(), 0.0),
      slid_(body.outer.size(), 0),
      anchor_(body.outer.size(), Vector3::Zero()),
      limit_(body.outer.size(), law.mode == ContactMode::stick ? endless : 0.0),
      anchor_normal_(body.outer.size(), plane.normal) {
  if (body.finite || plane.obstacle.is_plane()) return;
  for (std::size_t i = 0; i < body.outer.size(); ++i) foot_.push_back(rest_over(i, place_));
  first_foot_ = foot_;
}

Matrix3d StaticContact::turn(double place) const {
  return Eigen::AngleAxisd(plane_.twist(place), plane_.normal).toRotationMatrix();
}

void StaticContact::begin_step(double place, const VectorXd& displacement) {
  released_.assign(released_.size(), 0);
  move_feet(displacement);  // of the last step, by where it ended
  from_ = std::exchange(place_, place);
  turn_ = turn(place);
  axes_ = turn_ * plane_.axes();
  first_.clear();
  first_foot_ = foot_;
  for (std::size_t i = 0; holds() && i < start_.size(); ++i) {
    if (!anchored_[i]) part_[i] = 0.0;
    const Relative first = relative(i, displacement, from_);
    const GapAndNormal before = gap_and_normal(first);
    start_[i] = {std::max(before.gap, 0.0),
                 turned_back(i, first.now - before.gap * before.normal, from_)};
  }
  if (!has_feet()) return;
  const meshes::PressPose before = plane_.path.at(from_), now = pose();
  if (before.lateral == now.lateral && before.twist == now.twist) return;
  if (law_.mode == ContactMode::frictionless) {  // nothing takes the rubber along
    for (std::size_t i = 0; i < foot_.size(); ++i) foot_[i] = rest_over(i, place_);
    return;
  }
  for (const EmbeddedPoint& outer : body_->outer) first_.push_back(position(outer, displacement));
  move_feet(displacement);
}

Vector3 StaticContact::rest_over(std::size_t point, double place) const {
  return (turn(place) * plane_.axes()).transpose() *
         (body_->outer[point].rest - plane_.point(place));
}

/// The plane's motion counts as small as displacements, its turn too.
void StaticContact::move_feet(const VectorXd& displacement) {
  if (first_.empty()) return;
  const Matrix3d before = (turn(from_) * plane_.axes()).transpose(),
                 now = (turn(place_) * plane_.axes()).transpose();
  const Vector3 from = plane_.point(from_), to = plane_.point(place_);
  const double turned = plane_.twist(place_) - plane_.twist(from_);
  for (std::size_t i = 0; i < first_.size(); ++i) {
    const EmbeddedPoint& outer = body_->outer[i];
    const Vector3 way = from - to - turned * plane_.normal.cross(outer.rest),
                  own = position(outer, displacement) - first_[i] + way;
    const double share = meshes::share_passed(own.dot(plane_.t1), own.dot(plane_.t2),
                                              way.dot(plane_.t1), way.dot(plane_.t2));
    foot_[i] = first_foot_[i] + share * (now * (outer.rest - to) - before * (outer.rest - from));
  }
}

void StaticContact::update_ties(const VectorXd& displacement, bool shares) {
  for (std::size_t i = 0; holds() && i < body_->outer.size(); ++i) {
    if (anchored_[i] && !rubs()) continue;
    const double depth = std::max(-gap_and_normal(i, displacement).gap, 0.0);
    if (rubs()) limit_[i] = law_.friction * TiePush(body_->contact, depth).length;
    if (!anchored_[i] && shares) part_[i] = depth > 0.0 ? depth / (start_[i].gap + depth) : 0.0;
  }
}

Vector3 StaticContact::turned(std::size_t point, const Vector3& fixed) const {
  if (body_->finite) return turn_ * fixed;
  return fixed + plane_.twist(place_) * plane_.normal.cross(body_->outer[point].rest);
}

Vector3 StaticContact::turned_back(std::size_t point, const Vector3& at, double place) const {
  const double twist = plane_.twist(place);
  if (body_->finite) return Eigen::AngleAxisd(-twist, plane_.normal) * at;
  return at - twist * plane_.normal.cross(body_->outer[point].rest);
}

StaticContact::Relative StaticContact::relative(std::size_t point, const VectorXd& displacement,
                                                double place) const {
  const Vector3 now = position(body_->outer[point], displacement) - plane_.point(place);
  const bool present = place == place_;
  Relative result{now, Vector3::Zero(), present ? axes_ : Matrix3d(turn(place) * plane_.axes())};
  if (has_feet()) result.foot = (present ? foot_ : first_foot_)[point];
  return result;
}

StaticContact::GapAndNormal StaticContact::gap_and_normal(const Relative& point) const {
  const double over = point.now.dot(plane_.normal);
  if (plane_.obstacle.is_plane()) return {over, plane_.normal};
  if (has_feet()) return {over - height(plane_.obstacle, point.foot), plane_.normal};
  const auto found = hit(plane_.obstacle, point.axes.transpose() * point.now);
  return {found.gap, point.axes * Vector3(found.normal)};
}

Matrix3d StaticContact::bend(const Relative& point) const {
  if (plane_.obstacle.is_plane() || !body_->finite) return Matrix3d::Zero();
  return point.axes * curvature(plane_.obstacle, point.axes.transpose() * point.now) *
         point.axes.transpose();
}

bool StaticContact::touches(std::size_t point, const VectorXd& displacement) const {
  return part_[point] > 0.0 || gap_and_normal(point, displacement).gap < 0.0;
}

Vector3 StaticContact::stretch(std::size_t point, const VectorXd& displacement) const {
  const Vector3& held = anchored_[point] ? anchor_[point] : start_[point].foot;
  const Vector3 pull =
      plane_.point(place_) + turned(point, held) - position(body_->outer[point], displacement);
  if (!has_feet()) return pull;
  const GapAndNormal now = gap_and_normal(point, displacement);
  return pull - (pull.dot(now.normal) + now.gap) * now.normal;
}

StaticContact::Hold StaticContact::hold(std::size_t point, const Vector3& stretch,
                                        double depth) const {
  const double length = std::sqrt(std::max(0.0, stretch.squaredNorm() - depth * depth));
  const double limit = limit_[point], part = part_[point];
  if (!(limit > 0.0)) return {length, 0.0, true};
  const bool slips = limit < part * length;
  return {length, slips ? limit / length : part, slips};
}

Vector3 StaticContact::tie_force(std::size_t point, const VectorXd& displacement) const {
  if (!touches(point, displacement)) return Vector3::Zero();
  const EmbeddedPoint& outer = body_->outer[point];
  const GapAndNormal now = gap_and_normal(point, displacement);
  Vector3 length = TiePush(body_->contact, std::max(-now.gap, 0.0)).length * now.normal;
  if (part_[point] > 0.0) {
    const Vector3 pull = stretch(point, displacement);
    const double depth = tied_depth(point, now.gap);
    length += hold(point, pull, depth).share * (pull - depth * now.normal);
  }
  return outer.stiffness * length;
}

double StaticContact::energy(const VectorXd& displacement) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!touches(i, displacement)) continue;
    const EmbeddedPoint& outer = body_->outer[i];
    const double gap = gap_and_normal(i, displacement).gap;
    double own = TiePush(body_->contact, std::max(-gap, 0.0)).energy;
    if (part_[i] > 0.0) {
      const Vector3 pull = stretch(i, displacement);
      const double depth = tied_depth(i, gap);
      const Hold held = hold(i, pull, depth);
      own += held.slips ? limit_[i] * (held.length - 0.5 * limit_[i] / part_[i])
                        : 0.5 * part_[i] * (pull.squaredNorm() - depth * depth);
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
    const TiePush tie(body_->contact, std::max(-now.gap, 0.0));
    const Matrix3d along = now.normal * now.normal.transpose();
    Matrix3d shape = tie.tangent * along - tie.length * bend(at);
    if (!pulls(i) && now.gap > 0.0) shape.setZero();  // what is across is still tied
    if (part_[i] > 0.0) {
      const double depth = tied_depth(i, now.gap);
      const Vector3 pull = stretch(i, displacement), across = pull - depth * now.normal;
      const Hold held = hold(i, pull, depth);
      shape += held.share * (Matrix3d::Identity() - along + depth * bend(at));
      if (held.slips && held.share > 0.0)
        shape -= held.share / (held.length * held.length) * across * across.transpose();
    }
    system.add_embedded(outer, outer.stiffness * shape, *tangent);
  }
  return sum;
}

FirstTouch StaticContact::touch(std::size_t point, const VectorXd& start, double from,
                                const VectorXd& end) const {
  const Relative first = relative(point, start, from), last = relative(point, end, place_);
  const GapAndNormal before = gap_and_normal(first), after = gap_and_normal(last);
  FirstTouch touch{.point = point,
                   .before = std::max(before.gap, 0.0),
                   .after = after.gap,
                   .first = first.now,
                   .last = last.now,
                   .first_normal = before.normal,
                   .last_normal = after.normal,
                   .anchor = {},
                   .projection = {},
                   .across = stretch(point, end) + after.gap * after.normal,
                   .first_projection = Matrix3d::Identity() -
                                       before.normal * before.normal.transpose() -
                                       before.gap * bend(first)};
  // The gap is linear in the place for a plane and at small strain; else nearly so within a step.
  const double share = touch.share();
  const Matrix3d turned_axes = turn(from + share * (place_ - from)) * plane_.axes();
  const Relative there{(1.0 - share) * first.now + share * last.now,
                       (1.0 - share) * first.foot + share * last.foot, turned_axes};
  const GapAndNormal left = gap_and_normal(there);
  touch.anchor = there.now - left.gap * left.normal;
  touch.projection =
      Matrix3d::Identity() - left.normal * left.normal.transpose() - left.gap * bend(there);
  return touch;
}

std::vector<FirstTouch> StaticContact::first_touches(const VectorXd& start, double from,
                                                     const VectorXd& end) const {
  std::vector<FirstTouch> touches;
  for (std::size_t i = 0; holds() && i < body_->outer.size(); ++i)
    if (!anchored_[i] && gap_and_normal(i, end).gap < -gap_noise)
      touches.push_back(touch(i, start, from, end));
  return touches;
}

int StaticContact::anchor_touching(const VectorXd& start, double from, const VectorXd& end) {
  const std::vector<FirstTouch> touches = first_touches(start, from, end);
  for (const FirstTouch& first : touches) {
    const std::size_t i = first.point;
    const double there = from + first.share() * (place_ - from);
    anchor_[i] = turned_back(i, first.anchor, there);
    anchored_[i] = 1;
    part_[i] = 1.0;
    const Matrix3d turned = turn(there);
    if (body_->finite)
      anchor_normal_[i] =
          turned.transpose() *
          gap_and_normal({first.anchor, Vector3::Zero(), turned * plane_.axes()}).normal;
  }
  return int(touches.size());
}

void StaticContact::end_step(const VectorXd& displacement) {
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!anchored_[i]) continue;
    const GapAndNormal now = gap_and_normal(i, displacement);
    if (!(now.gap < 0.0)) {
      anchored_[i] = 0;
      part_[i] = 0.0;
      continue;
    }
    const Vector3 pull = stretch(i, displacement), across = pull + now.gap * now.normal;
    const Hold held = hold(i, pull, -now.gap);
    slid_[i] = held.length >= (1.0 - held_yet) * limit_[i];
    const Vector3 place = turned(i, anchor_[i]) - (1.0 - held.share) * across;
    anchor_[i] = turned_back(i, place, place_);
  }
}

int StaticContact::release_pulled(const VectorXd& displacement) {
  if (law_.mode != ContactMode::stick) return 0;
  int count = 0;
  for (std::size_t i = 0; i < body_->outer.size(); ++i) {
    if (!anchored_[i] || released_[i]) continue;
    if (anchored_push(i, displacement) >= -gap_noise * body_->outer[i].stiffness) continue;
    anchored_[i] = 0;
    released_[i] = 1;
    part_[i] = 0.0;
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
    point.rest = to_plane * outer.rest;
    point.place = body_->finite ? to_plane * position(outer, displacement) : point.rest;
    point.normal = to_plane * gap_and_normal(i, displacement).normal;
    point.area = area(i, displacement);
    point.set_force(to_plane * tie_force(i, displacement));
    point.state = slides(i) ? meshes::ContactState::slip : meshes::ContactState::stick;
    if (law_.mode == ContactMode::frictionless) point.shear.setZero();  // but for round-off it is
  }
  return points;
}

}  // namespace fingertip::lattice::inline statics
