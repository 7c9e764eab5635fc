/// Contact of the published model: boundary particles anchored on a rigid plane (paper, section
/// II.F).
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::lattice::inline contact {

/// Which boundary particles the plane holds, and what that costs it. One pass over the boundary
/// per step; allocates only in the constructor.
///
/// A held particle, velocity v before the step and force f, goes with the plane if that gives it
/// the impulse J = m (v_plane - v) - f dt. J_n is its part along the normal, J_t the rest:
///   stick         J, till the end (paper)
///   frictionless  J_n; released when J_n would be a pull
///   coulomb       likewise released; J while |J_t| <= mu J_n: it sticks, or sticks again because
///   it
///                 would else reverse within the step; else it slides under J_n and mu J_n along
///                 J_t, which is against its slip (Moreau, CISM Courses 302, 1988, sec. 8)
/// A particle that crosses the plane is put back to where it crossed it (linear between the ends of
/// the step) and stopped: an impulse of the same kind, without f. From there it moves with its new
/// velocity, so that linear and angular momentum balance to round-off.
class PlaneContact {
 public:
  /// The finger must start clear of the plane. Model must outlive the contact.
  PlaneContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law);

  /// To be called after particles moved freely through a step of length `step` under `force`, while
  /// `plane`, that of the step's start, moves at its velocities. Returns the impulse of the plane
  /// on the particles: [N s], and [N m s] about the world's origin.
  Wrench resolve(State& state, const VectorField& force, const Plane& plane, double step);

  int anchored() const { return anchored_; }  ///< of the whole tip
  int sliding() const { return sliding_; }    ///< of these (coulomb)
  /// Largest distance at rest of a held particle from the axis through the origin along the
  /// normal [m]; 0 without contact.
  double radius() const;
  bool holds(std::size_t boundary_number) const { return candidates_[boundary_number].held; }
  bool slides(std::size_t boundary_number) const { return candidates_[boundary_number].sliding; }

 private:
  struct Candidate {
    std::uint32_t particle = 0;
    int images = 1;  ///< particles of the whole tip that it stands for
    bool held = false;
    bool sliding = false;                            ///< of a held one, in the last step (coulomb)
    meshes::Vector3 rest = meshes::Vector3::Zero();  ///< [m]
    /// At the end of the last step; kept, for the particle has moved since [m], [m/s].
    meshes::Vector3 displacement = meshes::Vector3::Zero(), velocity = meshes::Vector3::Zero();
  };
  /// The plane's motion in the step.
  struct Sweep {
    Plane start, end;
    double step;  ///< [s]
  };

  meshes::Vector3 world(const VectorField& field, std::size_t particle) const;
  meshes::Vector3 place(const Candidate& c, const meshes::Vector3& displacement) const;
  Wrench hold(Candidate& c, State& state, const VectorField& force, const Sweep& sweep);
  Wrench touch(Candidate& c, State& state, const Sweep& sweep);
  bool gives(Candidate& c, const meshes::Vector3& sticking, const meshes::Vector3& normal,
             meshes::Vector3& given);
  void set_state(Candidate& c, State& state, const meshes::Vector3& displacement,
                 const meshes::Vector3& velocity);

  const LatticeModel* model_;
  Plane plane_;  ///< as it was at the end of the last step
  ContactLaw law_;
  std::vector<Candidate> candidates_;  ///< in the order of model.boundary
  int anchored_ = 0, sliding_ = 0;
};

}  // namespace fingertip::lattice::inline contact
