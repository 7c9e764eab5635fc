/// Contact of the tip with the rigid plane or other obstacle, node by node, by a primal-dual active
/// set. Free of deal.II.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "fem_reference/contact/contact_solver.h"
#include "fem_reference/contact/contact_surface.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::fem_reference::inline contact {

/// Where the plane is: z >= height is behind it; it has moved along x by `shift`, and has turned
/// about its normal, against the z axis. The obstacle's top lies in it. Plane axes [m, rad].
struct PlanePose {
  double height = 0.0;
  double shift = 0.0;
  double twist = 0.0;

  /// Turns what is fixed to the plane, or back.
  Eigen::AngleAxisd turn() const { return {-twist, meshes::Vector3::UnitZ()}; }
};

enum class NodeStatus : char {
  open,   ///< away from the plane
  stick,  ///< on the plane, moves with it
  slide,  ///< on the plane, under the friction that its push allows (none when frictionless)
};

/// What is known beforehand of a step, in plane axes [m]: where the contact unknowns will be at its
/// end, and by how much they are off the straight line there at times between, 0 ... 1, increasing.
struct ForeknownStep {
  Eigen::VectorXd end;
  std::vector<double> times;
  std::vector<Eigen::VectorXd> bends;
};

struct ContactEffort {
  int rounds = 0;
  int cg_iterations = 0;
};

/// Finds which nodes touch. The gap of a node is height - (reference z + u_z): small and large
/// strain differ in the solver behind, not here, because the plane is flat and the gap is linear
/// in u. Another obstacle at small strain lowers the gap by its height at the foot of the node
/// (meshes::share_passed); feet are held while the contact state is sought, and then moved on until
/// they stay where they are. At large strain the gap is the distance of the deformed place from the
/// obstacle, linearised where `linearise` says: unknowns then count along axes of the node's own,
/// the third into the obstacle, and what is said of z holds for that one. A push, never a pull.
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
/// The error of the anchor is of second order in the step, or in the times at which the way is
/// foreknown. Anchors move and turn with the plane; at small strain its twist is as small as
/// displacements are, a rotation of places at rest about the z axis. A plane that moves laterally
/// may pull a node off that would penetrate as soon as it is let go: neither held where it was nor
/// open is a solution. It has come off and down again within the step; pulled off a second time, it
/// is anchored where it comes down, at the end of the step.
///
/// A node without area, the pole of a meridian, has no share of the pressure: its reaction says
/// nothing while its neighbours push. It follows the nearest node with area when that touches, and
/// decides for itself while that is open; of itself it comes on at most once in a solution. Left
/// out of contact it would rise through the plane, a pit in the meridian.
///
/// Coulomb: a node sticks while |t| <= mu p; beyond, it slides under t = mu p d. In each round the
/// force of a sliding node is projected anew, t <- mu p (t - rho s)/|t - rho s| with its slip s
/// since the start of the step and rho in proportion to G and its area, and it sticks again when |t
/// - rho s| <= mu p (Alart & Curnier 1991): a fixed point satisfies Coulomb's law whatever rho. As
/// long as the same nodes slide it is sought by AndersonMixing, for where many slide by little
/// their forces would turn back and forth together. After some rounds no node sticks again: one
/// whose friction holds is then led back to where it sticks, t <- t - rho s.
class PlaneContact {
 public:
  /// The first step starts from the tip at rest under the plane at `start`. `friction` is mu
  /// (contact coulomb only), `shear_modulus` [Pa] scales rho. `finite` asks for the distance from
  /// an obstacle that is no plane.
  PlaneContact(ContactUnknowns unknowns, meshes::ContactMode mode, const PlanePose& start,
               double friction, double shear_modulus, const meshes::Obstacle& obstacle = {},
               bool finite = false);

  /// Whether gaps are linearised, and nodes have axes of their own.
  bool curved() const { return !frames_.empty(); }
  /// Of a curved obstacle: gaps are from now on those linearised at the displacement of the contact
  /// unknowns (plane axes) under `pose`. Returns the largest distance from the obstacle of what
  /// touches [m].
  double linearise(const Eigen::VectorXd& displacement, const PlanePose& pose);
  /// Of the nodes, for the solver; none unless the obstacle is curved.
  std::vector<NodeAxes> axes() const;

  /// Before the first `solve` of a step to `pose`: touching are from now on also the nodes that are
  /// expected to touch at its end, each anchored at its first touch on the way there.
  void foresee(ForeknownStep step, const PlanePose& pose);
  /// Finds the contact state under the plane at `pose` for the solver's present linear system.
  /// Newton's method calls it repeatedly, each time starting from the last answer; the state stays
  /// a trial until `commit`. Throws NotConverged.
  ContactEffort solve(ContactSolver& solver, const PlanePose& pose);
  /// The trial becomes the state from which the next step starts.
  void commit();
  /// Back to the last committed state.
  void abandon();

  const ContactUnknowns& unknowns() const { return unknowns_; }
  /// Of the trial, one per candidate node.
  const std::vector<NodeStatus>& status() const { return trial_.status; }
  int active_nodes() const;
  /// Force of the plane on a candidate node, plane axes [N].
  meshes::Vector3 reaction(std::size_t node) const;
  /// Of the obstacle where a node touches it, into the tip, plane axes.
  meshes::Vector3 normal(std::size_t node) const { return -axes(node).row(2).transpose(); }
  /// Its part into the tip, against the third axis of the node [N], and the length of the rest.
  double push(std::size_t node) const { return -own_reaction(node).z(); }
  double shear(std::size_t node) const { return own_reaction(node).head<2>().norm(); }
  /// What of the forces on the contact unknowns (plane axes) [N] neither contact nor what it holds
  /// balances; along the axes of the nodes.
  Eigen::VectorXd out_of_balance(const Eigen::VectorXd& force) const;
  /// The node whose pressure is this one's: itself, or the one that it follows.
  std::size_t leader(std::size_t node) const { return leaders_[node]; }
  /// One flag per contact unknown that the trial holds.
  std::vector<char> held() const;
  /// Forces of the plane on all contact unknowns, along the axes of the nodes [N].
  const Eigen::VectorXd& reactions() const { return trial_.reaction; }
  double gap(std::size_t node) const {
    return gap_and_normal(node, of_node(node, trial_.displacement), trial_.pose, 1.0).gap;
  }
  /// Of any place of the tip at a displacement, plane axes [m]; its foot is where it is at rest.
  double gap(const meshes::Vector3& rest, const meshes::Vector3& displacement,
             const PlanePose& pose) const {
    return gap_and_normal(rest, displacement, pose, over_obstacle(rest, pose)).gap;
  }

  /// What a checkpoint needs to restore the committed state.
  struct State {
    PlanePose pose;
    std::vector<NodeStatus> status;
    std::vector<std::array<double, 3>> anchors;  ///< displacement, were the plane not moved [m]
    Eigen::VectorXd displacement;                ///< of the contact unknowns, plane axes [m]
    Eigen::VectorXd reaction;                    ///< on them, along the axes of the nodes [N]
    /// Of the nodes, along x and y of the obstacle; none where no gap is told by them [m].
    std::vector<std::array<double, 2>> feet;
  };
  const State& committed() const { return committed_; }
  void restore(State state);

 private:
  /// Gap of a node [m] and its gradient, at a displacement in plane axes.
  struct GapAndNormal {
    double gap;
    meshes::Vector3 normal;
  };
  GapAndNormal gap_and_normal(const meshes::Vector3& rest, const meshes::Vector3& displacement,
                              const PlanePose& pose, const Eigen::Vector2d& foot) const;
  /// Of a node, at a time of the step, 0 ... 1.
  GapAndNormal gap_and_normal(std::size_t node, const meshes::Vector3& displacement,
                              const PlanePose& pose, double time) const {
    return gap_and_normal(unknowns_.nodes[node].position, displacement, pose, foot(node, time));
  }
  bool has_feet() const { return !finite_ && !obstacle_.is_plane(); }
  /// A place along x and y of the obstacle [m].
  Eigen::Vector2d over_obstacle(const meshes::Vector3& place, const PlanePose& pose) const;
  /// Of a node, at a time of the step, 0 ... 1 [m].
  Eigen::Vector2d foot(std::size_t node, double time) const;
  /// To where they are when the step ends at `displacement`; by how much that changes heights [m].
  double move_feet(const Eigen::VectorXd& displacement);
  /// Of the contact unknowns at the end of the step: what sticks goes along, the rest stays [m].
  Eigen::VectorXd expected() const;
  /// How deep the obstacle would go in, were the tip at rest [m].
  double deepest() const;
  /// The third component along the axes of a node at which it touches [m].
  double reach(std::size_t node) const;
  /// The linearised gap at a displacement along the axes of the nodes.
  double gap_of_solution(std::size_t node, const Eigen::VectorXd& displacement) const {
    return reach(node) - displacement[unknowns_.of_node[node][2]];
  }
  Eigen::Matrix3d axes(std::size_t node) const {
    return curved() ? frames_[node].axes : Eigen::Matrix3d::Identity();
  }
  meshes::Vector3 of_node(std::size_t node, const Eigen::VectorXd& values) const;
  void set_node(std::size_t node, const meshes::Vector3& value, Eigen::VectorXd& values) const;
  meshes::Vector3 own_reaction(std::size_t node) const { return of_node(node, trial_.reaction); }
  /// From the axes of the nodes to those of the plane.
  Eigen::VectorXd in_plane_axes(const Eigen::VectorXd& values) const;
  /// The displacement of a node that the plane has carried along since it had one of `anchor`
  /// under a plane that had not moved [m], and the other way.
  meshes::Vector3 carried(std::size_t node, const meshes::Vector3& anchor,
                          const PlanePose& pose) const;
  meshes::Vector3 carried_back(std::size_t node, const meshes::Vector3& displacement,
                               const PlanePose& pose) const;
  /// Where a node is held that sticks, along its axes [m].
  meshes::Vector3 held_at(std::size_t node) const;
  ConstrainedSolution solve(ContactSolver& solver) const;
  void touch_at_start();
  bool is_open(std::size_t node) const { return trial_.status[node] == NodeStatus::open; }
  bool follows(std::size_t node) const { return leader(node) != node; }
  /// Of each node along its third axis [N]; what one without area carries counts for its leader,
  /// too.
  std::vector<double> pulls_of(const ConstrainedSolution& solution) const;
  std::vector<std::size_t> offenders(const ConstrainedSolution& solution, double noise) const;
  /// `end` is the solution in plane axes.
  void change(std::size_t node, const ConstrainedSolution& solution, const Eigen::VectorXd& end);
  NodeStatus touching() const {
    return mode_ == meshes::ContactMode::frictionless ? NodeStatus::slide : NodeStatus::stick;
  }
  /// The contact state for the feet as they are.
  void settle(ContactSolver& solver, ContactEffort& effort);
  PlanePose pose_on_the_way(double time) const;
  /// Displacement of a node at a time of the step that ends at `end` [m].
  meshes::Vector3 on_the_way(std::size_t node, const Eigen::VectorXd& end, double time) const;
  /// When, 0 ... 1, a node first touches on the way to `end`, where its gap is `gap_at_end` [m].
  double first_touch(std::size_t node, const Eigen::VectorXd& end, double gap_at_end) const;
  /// Anchors a node where it is at `time`, 0 ... 1, of the step that ends at `end`.
  void anchor(std::size_t node, const Eigen::VectorXd& end, double time);
  /// One round of Coulomb's law; the largest change of a friction force over the largest push,
  /// infinite when a node sticks or slides from now on.
  double update_friction(const ConstrainedSolution& solution, bool may_stick, double noise);
  /// Of a solution's nodes: those whose force is less than friction holds stick.
  void stick_where_friction_holds(const ConstrainedSolution& solution);
  /// Those that friction loads, among the contact unknowns.
  std::vector<int> sliding_unknowns() const;

  ContactUnknowns unknowns_;
  std::vector<std::size_t> leaders_;  ///< of each node: itself, or the one that it follows
  meshes::ContactMode mode_;
  double friction_, shear_modulus_;
  meshes::Obstacle obstacle_;
  bool finite_;
  struct Frame {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< as rows
    double reach = 0.0;                                  ///< [m]
  };
  std::vector<Frame> frames_;  ///< of the nodes under a curved obstacle
  State committed_, trial_;
  ForeknownStep foreknown_;    ///< of the present step, if anything is
  std::vector<int> releases_;  ///< of each node, since `solve` began
};

}  // namespace fingertip::fem_reference::inline contact
