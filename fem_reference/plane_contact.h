/// Contact of the tip with the rigid plane, node by node, by a primal-dual active set. Free of
/// deal.II.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem_reference/contact_solver.h"
#include "fem_reference/contact_surface.h"
#include "meshes/press_protocol.h"

namespace fingertip::fem_reference {

/// Where the plane is: z >= height is behind it; it has moved along x by `shift`. Plane axes [m].
struct PlanePose {
  double height = 0.0;
  double shift = 0.0;
};

enum class NodeStatus : char {
  open,   ///< away from the plane
  stick,  ///< on the plane, moves with it
  slide,  ///< on the plane, under the friction that its push allows (none when frictionless)
};

struct ContactEffort {
  int rounds = 0;
  int cg_iterations = 0;
};

/// Finds which nodes touch. The gap of a node is height - (reference z + u_z): small and large
/// strain differ in the solver behind, not here, because the plane is flat and the gap is linear
/// in u. A push, never a pull.
///
/// In a round every node is on the plane (its z held) or open. An open node that penetrates is put
/// on the plane and one that is pulled comes off, all at once, until nothing changes (Hintermüller,
/// Ito & Kunisch 2002). This can cycle when the condensed stiffness is no M-matrix. When the number
/// of offenders has not fallen for some rounds, they are therefore changed one at a time, smallest
/// index first, which for frictionless contact ends after finitely many rounds (Júdice & Pires
/// 1994, following Murty 1974).
///
/// Stick: a node put on the plane is anchored at its lateral position at first touch, interpolated
/// linearly between the start of the step and the trial state in which it was found penetrating.
/// The error of the anchor is of second order in the step. Anchors move with the plane. A plane
/// that moves laterally may pull a node off that would penetrate as soon as it is let go: neither
/// held where it was nor open is a solution. It has come off and down again within the step; pulled
/// off a second time, it is anchored where it comes down, at the end of the step.
///
/// A node without area, the pole of a meridian, has no share of the pressure: its reaction says
/// nothing while its neighbours push. It follows the nearest node with area when that touches, and
/// decides for itself while that is open; of itself it comes on at most once in a solution. Left
/// out of contact it would rise through the plane, a pit in the meridian.
///
/// Coulomb: a node sticks while |t| <= mu p; beyond, it slides under t = mu p d. In each round the
/// force of a sliding node is projected anew, t <- mu p (t - rho s)/|t - rho s| with its slip s
/// since the start of the step and rho = G SurfaceNode::extent, and it sticks again when |t - rho
/// s| <= mu p (Alart & Curnier 1991): a fixed point satisfies Coulomb's law whatever rho.
class PlaneContact {
 public:
  /// The first step starts from the tip at rest under the plane at `start`. `friction` is mu
  /// (contact coulomb only), `shear_modulus` [Pa] scales rho.
  PlaneContact(ContactUnknowns unknowns, meshes::ContactMode mode, const PlanePose& start,
               double friction, double shear_modulus);

  /// Finds the contact state under the plane at `pose` for the solver's present linear system.
  /// Newton's method calls it repeatedly, each time starting from the last answer; the state stays
  /// a trial until `commit`. Throws NotConverged.
  ContactEffort solve(ContactSolver& solver, const PlanePose& pose);
  /// The trial becomes the state from which the next step starts.
  void commit();
  /// Back to the last committed state.
  void abandon() { trial_ = committed_; }

  const ContactUnknowns& unknowns() const { return unknowns_; }
  /// Of the trial, one per candidate node.
  const std::vector<NodeStatus>& status() const { return trial_.status; }
  int active_nodes() const;
  /// Force of the plane on a candidate node [N].
  meshes::Vector3 reaction(std::size_t node) const;
  /// The node whose pressure is this one's: itself, or the one that it follows.
  std::size_t leader(std::size_t node) const { return leaders_[node]; }
  /// One flag per contact unknown that the trial holds.
  std::vector<char> held() const;
  /// Forces of the plane on all contact unknowns [N].
  const Eigen::VectorXd& reactions() const { return trial_.reaction; }
  double gap(std::size_t node) const { return gap(node, trial_.displacement, trial_.pose); }

  /// What a checkpoint needs to restore the committed state.
  struct State {
    PlanePose pose;
    std::vector<NodeStatus> status;
    std::vector<std::array<double, 2>> anchors;  ///< lateral displacement relative to the plane [m]
    Eigen::VectorXd displacement, reaction;      ///< of the contact unknowns
  };
  const State& committed() const { return committed_; }
  void restore(State state);

 private:
  double gap(std::size_t node, const Eigen::VectorXd& displacement, const PlanePose& pose) const;
  ConstrainedSolution solve(ContactSolver& solver) const;
  void touch_at_start();
  bool is_open(std::size_t node) const { return trial_.status[node] == NodeStatus::open; }
  bool follows(std::size_t node) const { return leader(node) != node; }
  std::vector<std::size_t> offenders(const ConstrainedSolution& solution, double noise) const;
  void change(std::size_t node, const ConstrainedSolution& solution);
  /// Anchors a node where it was at `time`, 0 ... 1, between the start of the step and `trial`.
  void anchor(std::size_t node, const Eigen::VectorXd& trial, double time);
  /// One round of Coulomb's law; the largest change of a friction force over the largest push.
  double update_friction(const ConstrainedSolution& solution, double relaxation);

  ContactUnknowns unknowns_;
  std::vector<std::size_t> leaders_;  ///< of each node: itself, or the one that it follows
  meshes::ContactMode mode_;
  double friction_, shear_modulus_;
  State committed_, trial_;
  std::vector<int> releases_;  ///< of each node, since `solve` began
};

}  // namespace fingertip::fem_reference
