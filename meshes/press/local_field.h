/// Polynomials through points of a contact field, in the plane of a piece of skin.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline press {

/// A point of a contact field as a piece of skin sees it.
struct FlatPoint {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();     ///< [m]
  Vector3 warped = Vector3::Zero();                 ///< from there to its place in the contact [m]
  Vector3 normal = Vector3::Zero();                 ///< of the contact, out of the obstacle
  double pressure = 0.0, area = 0.0;                ///< [Pa], [m²]
  double edge = 0.0;                                ///< 1 at the contact's edge, 0 far inside
  Eigen::Vector2d shear = Eigen::Vector2d::Zero();  ///< [Pa]
};

/// Of an outline of points.
struct Corner {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< [m]
  double area = 0.0;                             ///< of its point [m²]
};
using Outline = std::vector<Corner>;

/// The convex hull, counter-clockwise (Andrew 1979). Not of no points.
Outline hull_of(Outline points);

/// Where a place lies beside a hull.
struct Beside {
  double distance = 0.0;  ///< negative inside [m]
  Corner foot;            ///< the nearest place on it
};
Beside beside(const Outline& hull, const Eigen::Vector2d& place);

/// Per area of the undeformed surface [Pa].
struct Felt {
  double pressure = 0.0;
  Eigen::Vector2d shear = Eigen::Vector2d::Zero();
  bool beyond = false;  ///< of the outermost points
};

/// The field within a radius of a place: FootprintMeans says how. Not of no points.
class LocalField {
 public:
  LocalField(const std::vector<FlatPoint>& near, const Eigen::Vector2d& middle, double radius);

  Felt at(const Eigen::Vector2d& place) const;
  bool is_inside() const { return is_inside_; }  ///< no edge is nearer than the radius
  double spacing() const { return spacing_; }    ///< of the points [m]
  double scatter() const { return scatter_; }    ///< root mean square of what they are off [Pa]
  double edge() const { return edge_; }          ///< mean of FlatPoint::edge

  /// Points that determine the polynomials, three times as many as their coefficients.
  static constexpr std::size_t points = 18;
  /// No edge is farther from the outermost points, in spacings.
  static constexpr double farthest_edge = 2.0;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  Vector6 basis(const Eigen::Vector2d& place) const;
  double limited(double square) const;
  void fit(const std::vector<FlatPoint>& near, const std::vector<double>& squares);

  Eigen::Vector2d middle_;
  double reach_ = 0.0;                      ///< of points that matter [m]
  Matrix6 coefficients_ = Matrix6::Zero();  ///< rows: p², p times both shears, warped
  double smallest_ = 0.0, largest_ = 0.0;   ///< p² of the points
  double steepest_ = 0.0;                   ///< shear over pressure
  double scatter_ = 0.0;                    ///< root mean square of what the points are off [Pa]
  double spacing_ = 0.0, edge_ = 0.0;
  Vector3 normal_ = Vector3::Zero();
  Outline close_, hull_;
  bool has_gaps_ = false;   ///< between points that touch: pads
  bool is_inside_ = false;  ///< the disc lies within the hull
};

}  // namespace fingertip::meshes::inline press
