/// Selective mass scaling: inertia against deformation, so that neither the stiffness nor the
/// damping of the rubber limits the time step.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lattice/contact/tie_inertia.h"
#include "lattice/dynamics/scaling/carried_rubber.h"
#include "lattice/dynamics/scaling/edge_inertia.h"
#include "lattice/dynamics/scaling/multigrid.h"
#include "lattice/dynamics/scaling/restraint.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

/// What scalings of one model have in common.
struct ScalingGround {
  const LatticeModel* model;
  std::shared_ptr<const GridHierarchy> hierarchy;
  CarriedRubber rubber;
  EdgeInertiaRule rule;

  /// Throws as EdgeInertiaRule does.
  explicit ScalingGround(const LatticeModel& model);
};

/// Scratch for MassScaling.
struct AccelerationFields {
  MultigridFields grids;
  CarriedRubber::Scratch carried;
};

/// What acts from outside during a step, along the grid's axes; wrenches are (force, moment about
/// the origin).
struct OuterLoads {
  PlaneHold plane;
  meshes::Vector3 gravity = meshes::Vector3::Zero();  ///< on the rubber [m/s²]
  /// A free rod, its inertia against rigid motions and all that acts on it but for the bond; none
  /// if its motion is prescribed.
  struct Rod {
    Matrix6 inertia = Matrix6::Zero();
    Vector6 load = Vector6::Zero();
    Vector6 expected = Vector6::Zero();    ///< its acceleration, as far as it is known before
    const Restraint* restraint = nullptr;  ///< up to date (MassScaling::restrain); null: none
  };
  std::optional<Rod> rod;
};

/// What acts in the end, but for what a restraint keeps.
struct Reactions {
  Vector6 bond = Vector6::Zero();   ///< on the rod
  Vector6 plane = Vector6::Zero();  ///< on the tip
  Vector6 rod = Vector6::Zero();    ///< acceleration of a free rod
};

/// Weights for one step length about one state.
///
/// A symplectic Euler step takes v += dt M⁻¹ (f_el - C v) and is stable if dt² K + 2 dt C <= 4 M.
/// Relative to the rod a V-cycle B <= (D + S)⁻¹ (multigrid.h) takes the place of M⁻¹, D the
/// particles' mass with the inertia of their ties, S a graph Laplacian with dt² K + 2 dt C <= 4 S
/// (edge_inertia.h). So B (dt² K + 2 dt C) <= 4 (D + S)⁻¹ S < 4 and the step is stable at any
/// length, as long as S is that of the present state. Motions at frequency w are heavier by S, a
/// part w² (dt² + 2 dt tau)/4 times the modulus of their edges over their own. So it is for
/// presses, not for vibrations.
///
/// A free rod carries the rubber: particles accelerate by b + (G - Y) q, b = B f as if the rod did
/// not accelerate, G the rigid motion at each, and the rod's q = (a, w) is what all that acts from
/// outside gives to rod and rubber as one body, after what b takes:
///
///   (I_rod + I_rubber + I_plane) q = rod's load + weight + plane - Σ m b,
///
/// with moments alike. Y is what the plane keeps of it (restraint.h): where the plane holds the tip
/// the rod does not carry it along. With C the plane's inertia, (D + S + C) Y = C G would make b
/// and q orthogonal in what plane and deformation take (the rubber's mass `expected` sees to), and
/// leave the rod to feel I_plane = Gᵀ C (G - Y). Both vanish with the step. Y here is B C G for the
/// patch's motion as a whole, along the normal and across it; of how the rod turns about the
/// patch's centre it keeps nothing, for what turns S does not resist. The plane exerts what is then
/// missing in the balance of momentum: without a plane momentum and angular momentum are those of
/// the outer forces to round-off whatever B, and what does not deform moves as its mass does.
///
/// Of a part of a tip (LatticeModel::sector) all that acts on rod and plane is the whole's.
///
/// (Two ways that are stable for less: ties that act on the rod by themselves, with the rubber not
/// carried along, up to m/M = 1/3, m what they feel of the rubber: for stiff ties a deviation p
/// goes on as p' = -2 r p - q, q' = -r p, r = m/M. And rubber that follows the rod rigidly up to
/// the plane, up to I_plane of a tenth of the rest.)
///
/// Selective mass scaling: Olovsson, Simonsson & Unosson, Int. J. Numer. Meth. Engng 63 (2005)
/// 1436-1445.
class MassScaling {
 public:
  explicit MassScaling(std::shared_ptr<ScalingGround> ground);

  /// For steps of `step` [s] > 0 from `state` on, with particles bonded to the rod like `bond`. S
  /// is `allowance` times what cells ask for now; that it bears more (the largest eigenvalue of W
  /// (dt² K
  /// + 2 dt C) is 2.5 of 4 with allowance 1) is measured, not derived. Allocates nothing.
  void make(const State& state, std::span<const BondInertia> bond, double step, Team& team,
            double allowance = 1.1);
  double step() const { return step_; }  ///< of the last make() [s]; 0 before

  AccelerationFields fields() const;
  Restraint restraint() const;  ///< none yet, with room for one

  /// Brings the restraint up to date. Its shares are found anew if the plane's ties or S have grown
  /// by a tenth or lost a fifth since, or the patch has moved by a cell over the tip or turned by
  /// 8 degrees.
  void restrain(const State& state, const PlaneHold& plane, Team& team, AccelerationFields& fields,
                Restraint& restraint) const;

  /// Finds the accelerations above from the forces on the particles [N], which are m a of particles
  /// whose a is that of the forces by their inertia D (surfaces.h). They stay in `fields`.
  Reactions accelerate(const State& state, const OuterLoads& outer, const VectorField& force,
                       Team& team, AccelerationFields& fields) const;
  /// The step with them. What the restraint keeps is to be taken from the plane's reaction.
  CarriedRubber::Moved move(State& state, const OuterLoads& outer, const Reactions& reactions,
                            Team& team, AccelerationFields& fields) const;

 private:
  void set_contact(const PlaneHold& plane, MultigridFields::Level& finest) const;
  void find_shares(const PlaneHold& plane, Team& team, AccelerationFields& fields,
                   Restraint& restraint) const;
  void find_inertia(const State& state, const PlaneHold& plane, Restraint& restraint) const;
  void set_load(const Vector6& expected, const State& state, const VectorField& force,
                const PlaneHold& plane, Team& team, MultigridFields::Level& finest) const;

  std::shared_ptr<ScalingGround> ground_;
  std::vector<double> inertia_;        ///< per point: mass and bond [kg]
  std::vector<double> gain_;           ///< that over the mass; 0 where no particle is
  std::vector<std::uint32_t> bonded_;  ///< particles of the bond
  Multigrid grids_;
  double step_ = 0.0, sum_of_edges_ = 0.0;
};

}  // namespace fingertip::lattice::inline dynamics::inline scaling
