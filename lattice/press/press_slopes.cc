#include "lattice/press/press_slopes.h"

#include "meshes/base/files.h"
#include "meshes/press/no_equilibrium.h"

namespace fingertip::lattice::inline press {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::Vector3;

namespace {

/// Sum of the forces of a body's ties on the rod [N].
Vector3 pull(const std::vector<EmbeddedPoint>& bond, const VectorXd& displacement) {
  Vector3 sum = Vector3::Zero();
  for (const EmbeddedPoint& point : bond) sum += point.stiffness * shift(point, displacement);
  return sum;
}

/// ds/dp of the share s = before/(before - after) of its way at which a point touched, from those
/// of its places at start and end of the step.
double share_slope(const FirstTouch& touch, const Vector3& first, const Vector3& last) {
  const double closing = touch.before - touch.after;
  // At the start the gap of a point within the plane by round-off counts as zero.
  const double before = touch.before > 0.0 ? first.dot(touch.first_normal) : 0.0,
               after = last.dot(touch.last_normal);
  return (touch.before * after - touch.after * before) / (closing * closing);
}

/// d(anchor)/dp of such a point.
Vector3 anchor_slope(const FirstTouch& touch, const Vector3& first, const Vector3& last) {
  const double share = touch.share();
  return touch.projection * ((1.0 - share) * first + share * last +
                             share_slope(touch, first, last) * (touch.last - touch.first));
}

/// Of displacements with what touches: a round takes a tenth to a hundredth of what the one before
/// has left.
constexpr double settled = 1e-10;
constexpr int most_rounds = 100;

}  // namespace

SlopeSystem::SlopeSystem(const PressSetup& setup, const LatticeBody& body,
                         const PressDirections& directions)
    : body_(&body) {
  for (Index j = 0; j < directions.rates.cols(); ++j)
    parts_.push_back(std::make_unique<const Part>(body_slope(body, setup, directions, j)));
}

StateSlopes SlopeSystem::at_rest() const {
  const Index columns = Index(parts_.size());
  return {MatrixXd::Zero(body_->unknowns(), columns),
          MatrixXd::Zero(3 * Index(body_->outer.size()), columns)};
}

/// df/dp of the material, and of the contact's ties through their stiffness and their anchors.
MatrixXd SlopeSystem::forces(const StaticContact& contact, const VectorXd& displacement,
                             const StateSlopes& slopes) const {
  MatrixXd result(slopes.displacement.rows(), slopes.displacement.cols());
  VectorXd force;
  for (std::size_t j = 0; j < parts_.size(); ++j) {
    const Index column = Index(j);
    parts_[j]->system.assemble(displacement, force, nullptr);
    for (std::size_t i = 0; i < body_->outer.size(); ++i) {
      const EmbeddedPoint& outer = body_->outer[i];
      Vector3 push =
          parts_[j]->body.outer[i].stiffness / outer.stiffness * contact.tie_force(i, displacement);
      if (contact.anchored(i))
        push += outer.stiffness * slopes.anchors.col(column).segment<3>(3 * Index(i));
      if (push.isZero(0.0)) continue;
      for (std::size_t c = 0; c < 8; ++c)
        force.segment<3>(3 * Index(outer.corners[c])) += outer.weights[c] * push;
    }
    for (std::size_t i = 0; i < body_->fixed.size(); ++i)
      if (body_->fixed[i]) force[Index(i)] = 0.0;
    result.col(column) = force;
  }
  return result;
}

void SlopeSystem::add_touching(const std::vector<FirstTouch>& touches, const StateSlopes& start,
                               const StateSlopes& end, MatrixXd& forces) const {
  for (Index j = 0; j < forces.cols() && !touches.empty(); ++j) {
    const VectorXd first = start.displacement.col(j), last = end.displacement.col(j);
    for (const FirstTouch& touch : touches) {
      const EmbeddedPoint& outer = body_->outer[touch.point];
      const Vector3 from = shift(outer, first),
                    push = outer.stiffness *
                           ((1.0 - touch.share()) * touch.first_projection * from -
                            share_slope(touch, from, shift(outer, last)) * touch.across);
      for (std::size_t c = 0; c < 8; ++c)
        forces.col(j).segment<3>(3 * Index(outer.corners[c])) += outer.weights[c] * push;
    }
  }
  for (std::size_t i = 0; i < body_->fixed.size(); ++i)
    if (body_->fixed[i]) forces.row(Index(i)).setZero();
}

/// How much of a tie across holds depends on the answer itself, not symmetrically: in rounds.
void SlopeSystem::respond(EquilibriumSolver& solver, const StaticContact& contact,
                          const VectorXd& displacement, const std::vector<FirstTouch>& touches,
                          const StateSlopes& start, StateSlopes& slopes) const {
  const MatrixXd pushes = forces(contact, displacement, slopes);
  for (int round = 0; round < most_rounds; ++round) {
    const MatrixXd before = slopes.displacement;
    MatrixXd all = pushes;
    add_touching(touches, start, slopes, all);
    if (!solver.respond(contact, displacement, all, slopes.displacement)) break;
    if (touches.empty() ||
        (slopes.displacement - before).norm() <= settled * slopes.displacement.norm())
      return;
  }
  const double indentation = contact.pose().indentation;
  throw meshes::NoEquilibrium("the force has no derivative at an indentation of " +
                                  meshes::to_text(indentation) +
                                  " m, where the lattice's tangent stiffness is not positive "
                                  "definite; press less deep, or take a finer lattice",
                              indentation);
}

void SlopeSystem::anchor(const std::vector<FirstTouch>& touches, const StateSlopes& start,
                         StateSlopes& end) const {
  for (Index j = 0; j < end.anchors.cols() && !touches.empty(); ++j) {
    const VectorXd first = start.displacement.col(j), last = end.displacement.col(j);
    for (const FirstTouch& touch : touches) {
      const EmbeddedPoint& outer = body_->outer[touch.point];
      end.anchors.col(j).segment<3>(3 * Index(touch.point)) =
          anchor_slope(touch, shift(outer, first), shift(outer, last));
    }
  }
}

Eigen::Matrix3Xd SlopeSystem::force(const VectorXd& displacement, const StateSlopes& slopes) const {
  Eigen::Matrix3Xd result(3, slopes.displacement.cols());
  for (std::size_t j = 0; j < parts_.size(); ++j) {
    result.col(Index(j)) = pull(parts_[j]->body.bond, displacement) +
                           pull(body_->bond, slopes.displacement.col(Index(j)));
  }
  // Mirror images cancel what lies across their planes.
  if (body_->sectors > 1) result.row(1).setZero();
  if (body_->sectors > 2) result.row(0).setZero();
  return body_->sectors * result;
}

}  // namespace fingertip::lattice::inline press
