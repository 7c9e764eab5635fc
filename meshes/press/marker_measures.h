/// Displacements of markers in figures, how two fields of them differ, and how far they are off.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"

namespace fingertip::meshes::inline press {

/// How long displacements of markers are, or differences of two such fields [m].
struct MarkerLengths {
  double rms = unknown, largest = unknown;  ///< root mean square; the largest
  int marker = 0;                           ///< whose that is
  double error = unknown;  ///< root mean square of the markers' errors; unknown where one is
};
/// Of one sample.
inline MarkerLengths marker_lengths(std::span<const MarkerRow> sample) {
  if (sample.empty()) return {};
  MarkerLengths lengths{0.0, 0.0, sample.front().marker, 0.0};
  for (const MarkerRow& row : sample) {
    const double length = row.displacement.norm();
    lengths.rms += length * length;
    lengths.error += row.error * row.error;
    if (length > lengths.largest) {
      lengths.largest = length;
      lengths.marker = row.marker;
    }
  }
  lengths.rms = std::sqrt(lengths.rms / double(sample.size()));
  lengths.error = std::sqrt(lengths.error / double(sample.size()));
  return lengths;
}

/// The displacements of a sample less those of another one. Errors: the sums of both, of one where
/// the other is unknown. Empty where the two do not have the same markers.
inline std::vector<MarkerRow> marker_differences(std::span<const MarkerRow> sample,
                                                 std::span<const MarkerRow> other) {
  constexpr double same_marker = 1e-6;  // of the places of one marker in two runs [m]
  const auto same = [](const MarkerRow& a, const MarkerRow& b) {
    return a.marker == b.marker && (a.place - b.place).norm() <= same_marker;
  };
  if (!std::ranges::equal(sample, other, same)) return {};
  std::vector<MarkerRow> differences(sample.begin(), sample.end());
  for (std::size_t i = 0; i < differences.size(); ++i) {
    MarkerRow& row = differences[i];
    row.displacement -= other[i].displacement;
    const double own = row.error, its = other[i].error;
    row.error = std::isnan(own) ? its : std::isnan(its) ? own : own + its;
  }
  return differences;
}

/// How much of what is off of a press's way its displacement is off. What makes a force wrong, a
/// grid or a mesh, makes the displacements around the contact wrong by as large a share of
/// themselves; next to the contact, where they change sign, by what is left of it there:
///
///   max(|u|/way, (a/r)²),  a/r <= 1,
///
/// a the contact's radius, r the distance from the place `touched` first, the way that of the
/// obstacle: indentation, lateral displacement, twist times a.
inline double marker_share(const MarkerRow& marker, const Vector3& touched, double contact_radius,
                           double way) {
  const double near = std::min(1.0, contact_radius / (marker.place - touched).norm());
  return std::max(marker.displacement.norm() / way, near * near);
}

/// Sets the errors of a sample's markers from those of its forces, each a share of the way that it
/// goes with; unknown where the normal force's error or the contact is.
inline void set_marker_errors(const PressSample& sample, const Vector3& touched,
                              std::vector<MarkerRow>& markers) {
  const double normal = sample.force_error / std::abs(sample.normal_force);
  const auto share = [&](double error, double load) {
    const double own = std::min(error / std::abs(load), 1.0);
    return own > normal ? own : normal;
  };
  const auto moved = [](double value) { return std::isnan(value) ? 0.0 : std::abs(value); };
  const double aside = moved(sample.lateral_displacement),
               turned = moved(sample.twist) * sample.contact_radius,
               off = normal * sample.indentation +
                     share(sample.lateral_force_error, sample.force().head<2>().norm()) * aside +
                     share(sample.torque_error, sample.spin_torque) * turned;
  const double way = sample.indentation + aside + turned;
  for (MarkerRow& marker : markers)
    marker.error = off * marker_share(marker, touched, sample.contact_radius, way);
}

}  // namespace fingertip::meshes::inline press
