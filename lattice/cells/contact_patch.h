/// Size and pressure of a contact that is known by the forces on scattered points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fingertip::lattice {

/// A point of the outer surface as seen along the plane's normal.
struct LoadedPoint {
  Eigen::Vector2d place;  ///< along t1 and t2 [m]
  double force = 0.0;     ///< of the plane, along its normal [N]
  double area = 0.0;      ///< of the surface it stands for, projected on the plane [m²]
};

/// Sums over loaded points, from which the radius follows.
struct ForceMoments {
  double force = 0.0;                                ///< [N]
  Eigen::Vector2d first = Eigen::Vector2d::Zero();   ///< Σ force place [N m]
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  ///< Σ force place placeᵀ [N m²]
  double area = 0.0;                                 ///< Σ force area [N m²]
};

struct ContactPatch {
  double radius = 0.0;        ///< of the circle that has the contact's area [m]
  double max_pressure = 0.0;  ///< [Pa]
};

/// Both from moments of the forces, for neighbouring points share their load unevenly (their ties
/// outnumber the particles around them) while sums over a few of them are right.
///
/// Radius: under the semi-ellipsoidal pressure of Hertz a contact with half axes A and B has the
/// second moments S = diag(A², B²)/5 of pressure about its centre, so sqrt(A B) = (25 det S)^(1/4).
/// A point's own patch counts as a disc. (In continuum presses of the default tip the pressure at
/// the pole is 1.48 to 1.50 times the mean; Hertz has 1.5.)
///
/// Pressure: the largest of Σ w force / Σ w area around a loaded point, w = 1 - (distance/width)²
/// over the points within `width` > 0 [m]. Of a paraboloid the top comes out too low by the share
/// (width/radius)²/3.
///
/// `sectors` (1, 2 or 4): the points are the whole contact, its half t2 >= 0 or its quarter
/// t1, t2 >= 0. Zeros without a loaded point.
ContactPatch contact_patch(std::vector<LoadedPoint> points, int sectors, double width);

/// The radius alone [m], of a whole contact: its cost grows with the number of points, that of the
/// pressure with its square.
double contact_radius(const std::vector<LoadedPoint>& points);
double contact_radius(const ForceMoments& moments);

}  // namespace fingertip::lattice
