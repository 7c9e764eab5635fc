/// Means of a contact field over small discs of the skin, between the points that it is known at.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "meshes/press/contact_field.h"

namespace fingertip::meshes::inline press {

/// Over a disc on the undeformed surface, per area of that surface.
struct FootprintMean {
  double pressure = 0.0;                            ///< [Pa]
  Eigen::Vector2d shear = Eigen::Vector2d::Zero();  ///< along the disc's first two axes [Pa]
  double error = 0.0;    ///< estimated, of `pressure`, of telling a field by these points [Pa]
  double spacing = 0.0;  ///< of the points there [m]; 0 where the disc does not touch
};

/// The field of one sample as a function of place.
///
/// Around a place the points' p² is a polynomial of second order, laid by moving least squares
/// (Lancaster & Salkauskas 1981), and p its root. That is exact for Hertz, the edge included, where
/// p² vanishes linearly and p itself has no slope to go by; other round edges differ in higher
/// orders. p times shear is such a polynomial too, of slip under Coulomb's law and of full stick;
/// the shear over p is at most that of the points. Beyond the outermost points the field goes on to
/// the zero of p², which must lie within two spacings; else the edge is sharp and as far away as
/// the area of the outermost points says.
///
/// The points' areas times pressures are the contact's force, of which the field between them may
/// lack some, or have too much, where they do not tell the edge: a lattice's outermost points bear
/// what presses beyond them. The difference is a share of the pressure within 3.5 spacings of the
/// edge, most at the edge itself.
///
/// The points' places in the disc's plane are those of Lambert's equal-area projection, so that
/// on a sphere sums over a dense array of discs are the contact's forces. Places of the points in
/// the contact, a polynomial too, tell how much of it an area of the undeformed surface is.
///
/// Of a meridian's rings (meshes::turned_around), which are much narrower than their points are
/// apart, every point may be told at any angle.
class FootprintMeans {
 public:
  /// Keeps `points`. `axes`: two directions across the normal, more or less, in which the field is
  /// summed up (columns), along the points' axes.
  explicit FootprintMeans(std::span<const ContactPoint> points,
                          const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

  /// Over the disc of `radius` >= 0 about `middle` [m] across the third of the `axes` (columns),
  /// the normal out of the rubber, all along the axes of the points.
  FootprintMean over(const Vector3& middle, const Eigen::Matrix3d& axes, double radius) const;

 private:
  /// A ring about the z axis by its point at y = 0, which has all of its area.
  struct Ring {
    ContactPoint point;
    double width = 0.0;  ///< [m]
    double edge = 0.0;   ///< FlatPoint::edge
  };
  void list_rings();
  void look_along(const Eigen::Matrix3d& axes);
  void mark_edge();
  void balance();
  /// Points of the rings within a distance of a place, on each as far apart as it is wide, or
  /// `apart` where that is more [m].
  std::vector<Ring> images(const Vector3& middle, double apart, double within) const;

  std::span<const ContactPoint> points_;
  Eigen::Matrix3d frame_ = Eigen::Matrix3d::Identity();  ///< of the contact, seen along its normal
  std::vector<double> edges_;                            ///< FlatPoint::edge of each
  std::vector<Ring> rings_;                              ///< empty: no meridian
  double spacing_ = 0.0;                                 ///< mean [m]
  double lacking_ = 0.0;  ///< of the pressure at the edge, so that sums are the contact's force
};

}  // namespace fingertip::meshes::inline press
