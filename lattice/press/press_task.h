/// What a press asks of finger and controller: whoever runs one builds both from here.
#pragma once

#include "lattice/control/task.h"
#include "lattice/control/virtual_finger.h"
#include "lattice/press/press_setup.h"
#include "meshes/press/press_motion.h"

namespace fingertip::lattice::inline press {

/// The rod's straight way toward the plane (and along it, if it moves laterally). The tip hangs
/// straight in its frame, the plane may be tilted.
struct PressWay {
  PressPlane plane;
  meshes::Vector3 direction;  ///< travel per distance along the plane's normal

  PressWay(const meshes::PressProtocol& protocol, const meshes::Geometry& geometry)
      : plane(press_plane(protocol, geometry)),
        direction(-plane.normal - plane.path.slope() * plane.t1) {}

  /// Where the endpoint, at `start` in the beginning, should be at a set point of the way.
  Target at(const meshes::Vector3& start, const meshes::SetPoint& point) const;
  /// Travel along the normal since first touch, negative before [m].
  double indentation(const meshes::Vector3& start, const meshes::Vector3& endpoint,
                     double clearance) const {
    return (start - endpoint).dot(plane.normal) - clearance;
  }
  /// Displacement of the plane along t1 as the rod sees it, 0 at first touch on the way [m].
  double lateral(const meshes::Vector3& start, const meshes::Vector3& endpoint,
                 double clearance) const {
    return (start - endpoint).dot(plane.t1) - plane.path.slope() * clearance;
  }
};

/// The finger of `setup`, clear of the plane.
FingerSetup finger_setup(const PressSetup& setup, const PressWay& way);

/// The same as it is pressed: with scaled masses as far as they serve.
FingerSetup pressed_finger(const PressSetup& setup, const PressWay& way);

/// 4, 2 or 1: how many parts of a moving press are each other's mirror images, of which one is
/// computed: those of grid, obstacle and way (way_symmetry). 1 where something may push the rod off
/// the mirror planes: a controller but the built-in servo, or noise; or where nobody wants it
/// (PressSetup::symmetry). What would sway on such a rod does not sway: swaying_hand tells.
int moving_sectors(const PressSetup& setup);
/// V/a³ of the part that is computed.
double moving_particles(const PressSetup& setup);

/// What the controller is asked to do: to follow the way of the press.
ControlTask control_task(const PressSetup& setup, const PressWay& way, const RodBody& rod);

}  // namespace fingertip::lattice::inline press
