/// Pressure and shear in the contact, point by point: contact_field.csv.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "meshes/base/names.h"
#include "meshes/shape/geometry.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline press {

/// What a point that touches does.
enum class ContactState {
  stick,  ///< goes with the obstacle
  slip,   ///< slides on it under the friction that its pressure allows, or without any
};
constexpr auto names_of(ContactState) {
  return names<ContactState>({{ContactState::stick, "stick"}, {ContactState::slip, "slip"}});
}

/// A point of the tip that the obstacle pushes, and the part of the contact for which it stands.
///
/// Axes: x along t1, y along t2, z along -n, right-handed, the rod's starting axes where there is
/// no tilt; origin that of the finger's shape. At small strain places are those at rest, which
/// moments are about there; at large strain those where the forces act.
struct ContactPoint {
  int sample = 0;                   ///< row of response.csv, from 1
  double indentation = unknown;     ///< there [m]
  Vector3 place = Vector3::Zero();  ///< [m]
  /// At small strain that seen along n, else as it is; of the pole of a meridian 0 [m²].
  double area = 0.0;
  double normal_traction = unknown;    ///< pressure, >= 0 [Pa]
  Vector3 shear = Vector3::Zero();     ///< of the obstacle on the tip, across `normal` [Pa]
  Vector3 normal = -Vector3::UnitZ();  ///< out of the obstacle; of small strain n itself
  ContactState state = ContactState::stick;
  Vector3 rest = Vector3::Zero();  ///< in the undeformed finger, along the same axes [m]
  double reach = 0.0;  ///< half the longer side of its part, where that is no square [m]

  /// Of the obstacle on the tip [Pa], [N].
  Vector3 traction() const { return normal_traction * normal + shear; }
  Vector3 force() const { return area * traction(); }
  /// Of its part, along the longer side [m].
  double width() const { return std::max(std::sqrt(area), 2.0 * reach); }
  /// Tractions from a force [N]; normal and area are known by then.
  void set_force(const Vector3& force);
  /// All that turns when the axes do.
  std::array<Vector3*, 4> vectors() { return {&place, &shear, &normal, &rest}; }
};

/// The columns of contact_field.csv. What does not touch is not listed.
consteval auto fields_of(const ContactPoint*) {
  return FINGERTIP_ALL_MEMBERS(ContactPoint, sample, indentation, place, area, normal_traction,
                               shear, normal, state, rest, reach)
      .in("m", "indentation place rest reach")
      .in("m^2", "area")
      .in("Pa", "normal_traction shear")
      .newer("rest reach")
      .called("place", "x,y,z");
}

/// Appends the points of a sample, row `sample` of response.csv, from 1, at an indentation [m].
void add_sample(std::span<const ContactPoint> points, int sample, double indentation,
                std::vector<ContactPoint>& field);

/// The rows of each sample, points of a field or others that know theirs, in their order, where
/// those of one stand together.
template <class Rows>
auto samples_of(const Rows& rows) {
  using Sample = std::span<const typename Rows::value_type>;
  std::vector<Sample> samples;
  for (Sample rest(rows); !rest.empty(); rest = rest.subspan(samples.back().size())) {
    const auto end = std::ranges::find_if(
        rest, [first = rest.front().sample](const auto& row) { return row.sample != first; });
    samples.push_back(rest.first(std::size_t(end - rest.begin())));
  }
  return samples;
}

/// With its images: of a quarter (`sectors` 4) in x and y, of a half (2) in y. A point on a mirror
/// plane, which bears what is on this side of it, becomes one with its image.
std::vector<ContactPoint> unfolded(std::span<const ContactPoint> points, int sectors);
/// A ring about the z axis, given by its point at y = 0 and all of its area, as `count` points.
std::vector<ContactPoint> turned_around(const ContactPoint& ring, int count);

/// What the obstacle does to the tip.
struct ContactSums {
  Vector3 force = Vector3::Zero();   ///< [N]
  Vector3 torque = Vector3::Zero();  ///< about a given point [N m]
};
ContactSums sums_of(std::span<const ContactPoint> points, const Vector3& about);

/// Of the circle that has the area of the points as seen along n [m].
double contact_radius(std::span<const ContactPoint> points);

/// Where the resultant of the normal forces acts, their mean place [m]; not of no points.
Vector3 centre_of_pressure(std::span<const ContactPoint> points);

/// About n, against the z axis, at the centre of pressure; 0 of no points [N m].
double spin_torque(std::span<const ContactPoint> points);

}  // namespace fingertip::meshes::inline press
