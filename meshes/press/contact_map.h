/// Contact fields on a raster, whatever points they are known at, and how much two of them differ.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "meshes/press/contact_field.h"

namespace fingertip::meshes::inline press {

/// Places of a square raster: x = origin.x + i step, y = origin.y + j step, i, j < count.
struct Raster {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< [m]
  double step = 0.0;                                 ///< [m]
  Eigen::Index count = 0;

  double x(Eigen::Index i) const { return origin.x() + double(i) * step; }
  double y(Eigen::Index j) const { return origin.y() + double(j) * step; }
};
/// One of `count` >= 2 places along each side that reaches a tenth beyond all points of the fields.
Raster raster_around(std::span<const std::span<const ContactPoint>> fields, Eigen::Index count);

/// A field at a raster's places, x along the rows; zero outside the contact.
struct ContactMap {
  Raster raster;
  Eigen::ArrayXXd pressure, shear_x, shear_y;  ///< [Pa]
  Eigen::ArrayXXd touches;                     ///< 1 where it does, else 0
};

/// The field of one sample, seen along n: planes laid by least squares through a place's nearest
/// point and its neighbours, two rings of Voronoi cells, of both shears and of the
/// pressure over the profile of contact_patch, which knows the edge better than points of a coarse
/// field. Where the contact is no ellipse, of the pressure itself, near points and within their
/// hull.
ContactMap contact_map(std::span<const ContactPoint> field, const Raster& raster);

/// Of a field from another one, the first; relative but for the centre.
struct ContactDifference {
  double pressure_l2 = unknown;  ///< sqrt(∫(p - q)² dA/A_first) over the first's largest pressure
  double shear_l2 = unknown;     ///< of both shears, likewise
  double peak = unknown;         ///< of the largest pressure on the raster
  double radius = unknown;       ///< of that of the circle with the contact's area
  double spread = unknown;       ///< of the pressure's root mean square distance from its centre
  double centre = unknown;       ///< distance between the centres of pressure [m]
};
ContactDifference difference_of(const ContactMap& map, const ContactMap& first);

}  // namespace fingertip::meshes::inline press
