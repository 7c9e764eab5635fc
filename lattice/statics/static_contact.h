/// Contact of a lattice body with a rigid plane or other obstacle by one-sided elastic ties.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "lattice/contact/contact_smoothing.h"
#include "lattice/model/plane.h"
#include "lattice/statics/elastic_system.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/press/contact_patch.h"
#include "meshes/press/press_protocol.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline statics {

/// What the plane exerts on the part computed.
struct PlaneReaction {
  meshes::Vector3 force = meshes::Vector3::Zero();   ///< [N]
  meshes::Vector3 moment = meshes::Vector3::Zero();  ///< about a given point [N m]
};

/// An outer point's way through the plane within a step. Places are relative to the plane's point.
struct FirstTouch {
  std::size_t point = 0;             ///< among the outer ones
  double before = 0.0, after = 0.0;  ///< gap at start and end of the step, the former >= 0 [m]
  meshes::Vector3 first, last;       ///< places at start and end of the step [m]
  meshes::Vector3 first_normal, last_normal;  ///< gradients of the gap there
  meshes::Vector3 anchor;                     ///< where it touches [m]
  /// Derivative of the anchor with respect to the place at `share` of the way.
  Eigen::Matrix3d projection;
  /// Until it is anchored: from where it ends, at its depth, to over where it began, which
  /// stretches its tie across [m]; derivative of the latter with respect to the place at the start.
  meshes::Vector3 across;
  Eigen::Matrix3d first_projection;

  /// Of the step until the gap closes; all of it where it does not.
  double share() const { return after < 0.0 ? before / (before - after) : 1.0; }
};

/// The ties between a body's outer points and the obstacle. With the gap g, an energy per point, k
/// its stiffness at rest and k w(d) what the body's TieLaw stores at the depth d = max(-g, 0), ½ k
/// d² if it is linear:
///   frictionless  k w(d)
///   stick         ½ k |x - anchor|² + k (w(d) - ½ d²); the anchor is the place of first touch,
///   lies
///                 on the obstacle and moves with it. Of a plane, whose d is the tie's length along
///                 the normal, this is w(d) and a linear tie across.
///   coulomb       k w(d) + h(q), q² = |x - anchor|² - d²; of a plane q is the tie's length across.
///                 h = ½ k q² up to the length at which friction gives way, q1 = mu w'(d); beyond
///                 it k q1 (q - ½ q1). Where it slides the anchor follows by what friction does not
///                 hold (end_step). A step is taken to be straight: friction points against its
///                 slip.
/// A point that touches within a step, whose gap was g0 and whose depth is d, has done the share s
/// = g0/(g0 + d) of its way before; what is across of its tie is 1 - s of its way over the plane.
/// So until the step ends it is tied across by (1 - s) k to where it was over the plane when the
/// step began: force and energy are continuous where it touches, and those of the anchor it is
/// given then (anchor_touching). Within an iteration s and q1 are those where it starts
/// (update_ties), so that there is an energy. Of a plane g = (x - plane point)·n, x = rest + u,
/// also at small strain. Of another obstacle at finite strain it is the distance of x from the
/// obstacle, with its normal there. At small strain it is less than that of the plane by the
/// obstacle's height at the point's foot (meshes::share_passed), with the plane's normal, and along
/// it |x - anchor| counts as -g: an anchor says where a point is held across alone. While
/// equilibrium is sought feet stand still (move_feet).
///
/// The plane's twist turns the obstacle about n, and anchors: at small strain these by a rotation
/// as small as displacements, about the axis through the shape's origin.
class StaticContact {
 public:
  /// Keeps a reference to `body`.
  StaticContact(const LatticeBody& body, const PressPlane& plane, const ContactLaw& law);

  /// Begins a step in which the plane moves, and the anchors with it, to a place of its path [m];
  /// the body is at `displacement` now.
  void begin_step(double place, const Eigen::VectorXd& displacement);
  double place() const { return place_; }
  meshes::PressPose pose() const { return plane_.path.at(place_); }
  const PressPlane& plane() const { return plane_; }

  /// [J]; continuously differentiable.
  double energy(const Eigen::VectorXd& displacement) const;
  /// Adds the ties' forces on the particles [N] and, unless null, their tangent [N/m]; returns the
  /// sum of the magnitudes of the forces [N].
  double add(const Eigen::VectorXd& displacement, const ElasticSystem& system,
             Eigen::VectorXd& force, Tangent* tangent) const;

  /// But for frictionless: the points without anchor that have crossed the plane on the way from
  /// `start` at the path's place `from` to `end` at the present one, both taken to go in a straight
  /// line.
  std::vector<FirstTouch> first_touches(const Eigen::VectorXd& start, double from,
                                        const Eigen::VectorXd& end) const;
  /// The way of any point between these; one that does not touch has its anchor over its end.
  FirstTouch touch(std::size_t point, const Eigen::VectorXd& start, double from,
                   const Eigen::VectorXd& end) const;
  /// Anchors them where they crossed it. Returns how many.
  int anchor_touching(const Eigen::VectorXd& start, double from, const Eigen::VectorXd& end);
  /// Stick: frees the anchored points that the plane would have to pull, but none a second time
  /// since `begin_step`. Returns how many.
  int release_pulled(const Eigen::VectorXd& displacement);
  /// Whether a point has an anchor.
  bool anchored(std::size_t point) const { return anchored_[point] != 0; }
  /// Whether Coulomb's law holds.
  bool rubs() const { return law_.mode == meshes::ContactMode::coulomb; }
  /// Whether anything holds points across.
  bool holds() const { return law_.mode != meshes::ContactMode::frictionless; }
  /// From now on ties across are those of this displacement: as stiff as the ways have it of points
  /// that touch, where `shares`, and giving way as the pushes have it.
  void update_ties(const Eigen::VectorXd& displacement, bool shares = true);
  /// Puts feet where the step ends, were it to end at `displacement`.
  void move_feet(const Eigen::VectorXd& displacement);
  /// Coulomb: anchors of what slides follow; what does not touch has none.
  void end_step(const Eigen::VectorXd& displacement);
  /// Whether a point slid in the last step, or is free of friction.
  bool slides(std::size_t point) const {
    return law_.mode == meshes::ContactMode::frictionless || slid_[point] != 0;
  }

  /// Whether the obstacle acts on an outer point.
  bool touches(std::size_t point, const Eigen::VectorXd& displacement) const;
  /// Force of the plane on an outer point [N].
  meshes::Vector3 tie_force(std::size_t point, const Eigen::VectorXd& displacement) const;
  /// Stick: along the obstacle's normal where the point is anchored [N].
  double anchored_push(std::size_t point, const Eigen::VectorXd& displacement) const {
    return tie_force(point, displacement).dot(turn_ * anchor_normal_[point]);
  }
  /// Sum of the ties' forces; moments at positions of rest at small strain, at present ones at
  /// finite strain.
  PlaneReaction reaction(const Eigen::VectorXd& displacement, const meshes::Vector3& about) const;
  /// All outer points of the part computed, along the field's axes.
  std::vector<TiedPoint> points(const Eigen::VectorXd& displacement) const;

 private:
  /// Where a point is [m]: from the plane's point, and its foot, if it has one, in the obstacle's
  /// axes; and these then.
  struct Relative {
    meshes::Vector3 now, foot;
    Eigen::Matrix3d axes;
  };
  /// Whether gaps are told by feet.
  bool has_feet() const { return !foot_.empty(); }
  /// A point at rest in the obstacle's axes, at a place of its path [m].
  meshes::Vector3 rest_over(std::size_t point, double place) const;
  /// Of the plane, at a place of its path.
  Eigen::Matrix3d turn(double place) const;
  /// Its gap [m] and the gradient of that.
  struct GapAndNormal {
    double gap;
    meshes::Vector3 normal;
  };
  Relative relative(std::size_t point, const Eigen::VectorXd& displacement, double place) const;
  GapAndNormal gap_and_normal(const Relative& point) const;
  GapAndNormal gap_and_normal(std::size_t point, const Eigen::VectorXd& displacement) const {
    return gap_and_normal(relative(point, displacement, place_));
  }
  /// Derivative of the normal with respect to the place [1/m].
  Eigen::Matrix3d bend(const Relative& point) const;
  /// What stretches the tie of an anchored point: from it to its anchor [m].
  meshes::Vector3 stretch(std::size_t point, const Eigen::VectorXd& displacement) const;
  /// By what the plane's turn carries a place of the plane on, from its point [m].
  meshes::Vector3 turned(std::size_t point, const meshes::Vector3& fixed) const;
  /// The other way, when the plane is at `place` [m] of its path.
  meshes::Vector3 turned_back(std::size_t point, const meshes::Vector3& at, double place) const;
  /// Whether a point is pulled back, too.
  bool pulls(std::size_t point) const {
    return law_.mode == meshes::ContactMode::stick && anchored_[point] != 0;
  }
  /// How deep a point's tie is held along the normal.
  double tied_depth(std::size_t point, double gap) const {
    return pulls(point) ? std::max(-gap, 0.0) : -gap;
  }
  /// Stiffness of a tie across over k, with what friction holds of it, and how long it is [m].
  struct Hold {
    double length, share;
    bool slips;
  };
  Hold hold(std::size_t point, const meshes::Vector3& stretch, double depth) const;
  /// At small strain as seen along the plane's normal [m²].
  double area(std::size_t point, const Eigen::VectorXd& displacement) const;

  const LatticeBody* body_;
  PressPlane plane_;
  Eigen::Matrix3d axes_;  ///< of the obstacle, as columns
  ContactLaw law_;
  double place_ = 0.0, from_ = 0.0;  ///< of the plane on its path, now and as the step began [m]
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  ///< the plane's, there
  std::vector<std::uint8_t> anchored_, released_;
  /// Of a point as the step began: how far from the plane, >= 0, and over which place of it, fixed
  /// to the plane as anchors are [m].
  struct Start {
    double gap = 0.0;
    meshes::Vector3 foot = meshes::Vector3::Zero();
  };
  std::vector<Start> start_;
  std::vector<double> part_;  ///< stiffness of a tie across over k, were there no slip
  std::vector<std::uint8_t> slid_;              ///< in the last step (coulomb)
  std::vector<meshes::Vector3> anchor_;         ///< fixed to the plane, from plane_.point [m]
  std::vector<double> limit_;                   ///< tie's length across that friction holds [m]
  std::vector<meshes::Vector3> anchor_normal_;  ///< of the obstacle there, fixed to the plane
  /// Of points that have feet [m]: these, in the obstacle's axes, now and as the step began; and
  /// places then, from the origin. Where the step leaves feet alone there are no places.
  std::vector<meshes::Vector3> foot_, first_foot_, first_;
};

}  // namespace fingertip::lattice::inline statics
