/// Unilateral contact of the elastic tip with the rigid plane, by a primal-dual active set.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fem_reference/contact_solver.h"
#include "meshes/press_protocol.h"

namespace fingertip::fem_reference {

/// The contact unknowns of a press: candidate nodes and which of their unknowns contact may hold.
struct ContactUnknowns {
  std::vector<SurfaceNode> nodes;           ///< candidates
  std::vector<int> unknowns;                ///< numbers in the tip's system
  std::vector<std::array<int, 3>> of_node;  ///< per node: position in `unknowns`, -1 if none
};

/// Candidates are the nodes of the outer surface above `lowest` [m]. Frictionless contact holds
/// their z unknowns only; stick all that symmetry leaves free.
ContactUnknowns contact_unknowns(const ElasticTip& tip, meshes::ContactMode mode, double lowest);

struct ContactStep {
  int active_set_iterations = 0;
  int cg_iterations = 0;
};

/// Marches the plane z = R - indentation toward the rod. The gap of a node is taken on the
/// reference surface: reference z + u_z <= R - indentation, with a push, never a pull.
///
/// In a step every node belongs to the active set (held on the plane) or is free. A free node that
/// penetrates joins the set and an active one that is pulled leaves it, all at once, until nothing
/// changes (Hintermüller, Ito & Kunisch 2002). This can cycle when the condensed stiffness is no
/// M-matrix. When the number of offenders has not fallen for some rounds, they are therefore
/// changed one at a time, smallest index first, which for frictionless contact ends after finitely
/// many rounds (Júdice & Pires 1994, following Murty 1974).
///
/// Stick: a node that joins is anchored at its lateral position at first touch, interpolated
/// linearly between the start of the step and the trial state in which it was found penetrating.
/// The error of the anchor is of second order in the step.
class PlaneContact {
 public:
  PlaneContact(ContactUnknowns unknowns, double tip_radius, ContactSolver& solver);

  /// Advances from the present indentation to `indentation` [m] in one step. Throws NotConverged
  /// and leaves the state as it was.
  ContactStep advance(double indentation);

  double indentation() const { return indentation_; }
  const ContactUnknowns& unknowns() const { return unknowns_; }
  const std::vector<char>& active() const { return active_; }  ///< one flag per candidate node
  int active_nodes() const;
  /// Force of the plane on a candidate node [N].
  meshes::Vector3 reaction(std::size_t node) const;
  /// Gap of a candidate node, negative when it penetrates [m].
  double gap(std::size_t node) const;

 private:
  double gap(std::size_t node, const Eigen::VectorXd& displacement, double indentation) const;
  HeldSolution solve(const std::vector<char>& active, double indentation) const;
  std::vector<std::size_t> offenders(const std::vector<char>& active, const HeldSolution& trial,
                                     double indentation) const;
  /// When in the step, 0 ... 1, a node that penetrates in the trial state touched the plane.
  double touch_time(std::size_t node, const Eigen::VectorXd& trial, double indentation) const;
  /// Anchors a node where it was at `time` between the start of the step and the trial state.
  void anchor(std::size_t node, const Eigen::VectorXd& trial, double time);

  ContactUnknowns unknowns_;
  double tip_radius_;
  ContactSolver& solver_;
  double indentation_ = 0.0;
  std::vector<char> active_;
  std::vector<std::array<double, 2>> anchors_;  ///< lateral displacement at first touch [m]
  Eigen::VectorXd displacement_, reaction_;     ///< of the contact unknowns
};

}  // namespace fingertip::fem_reference
