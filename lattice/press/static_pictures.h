/// Takes the pictures of a press without time.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lattice/model/rod.h"
#include "lattice/press/press_setup.h"
#include "lattice/press/press_shapes.h"
#include "lattice/press/whole_tip.h"
#include "lattice/statics/lattice_body.h"
#include "lattice/statics/static_contact.h"

namespace fingertip::lattice::inline press {

/// Fills PressShapes as a press in motion does: world axes in which the plane stands still and the
/// rod, at its starting place at first touch, comes nearer. The part computed is mirrored to the
/// whole tip, whose skin a BoundaryView of the moving lattice shows.
class StaticPictures {
 public:
  /// All of them must outlive it. Throws InvalidInput as build_tip does.
  StaticPictures(const PressSetup& setup, const LatticeBody& body, PressShapes& shapes);

  /// A state in equilibrium; `on_rod` is the whole tip's wrench about the endpoint.
  void look(const StaticContact& contact, const Eigen::VectorXd& displacement,
            const Wrench& on_rod);
  /// To be called with the last one.
  void finish(const StaticContact& contact, const Eigen::VectorXd& displacement,
              const Wrench& on_rod);

 private:
  FingerPicture take(const StaticContact& contact, const Eigen::VectorXd& displacement,
                     const Wrench& on_rod);
  std::vector<std::uint8_t> held(const StaticContact& contact,
                                 const Eigen::VectorXd& displacement) const;

  const PressSetup& setup_;
  const LatticeBody& body_;
  WholeTip whole_;
  const BoundaryView view_;
  ShapeRecorder recorder_;
};

}  // namespace fingertip::lattice::inline press
