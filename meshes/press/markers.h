/// Markers: material points whose displacements a press tells, as the printed dots of a
/// camera-based tactile sensor or beads in the rubber.
#pragma once

#include <vector>

#include "meshes/base/errors.h"
#include "meshes/shape/geometry.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::meshes::inline press {

/// A row of markers.csv. Axes: the finger's own, those of the rod, which a camera in the finger
/// has.
struct MarkerRow {
  int sample = 0;                          ///< row of response.csv, from 1
  double indentation = unknown;            ///< there [m]
  int marker = 0;                          ///< from 1
  Vector3 place = Vector3::Zero();         ///< in the undeformed finger [m]
  Vector3 displacement = Vector3::Zero();  ///< seen from the rod [m]
  double error = unknown;                  ///< estimated length of what that is off [m]
};
consteval auto fields_of(const MarkerRow*) {
  return FINGERTIP_ALL_MEMBERS(MarkerRow, sample, indentation, marker, place, displacement, error)
      .in("m", "indentation place displacement error")
      .if_known("error")
      .called("place", "x,y,z");
}

/// A row per marker; sample, indentation and error are left to others.
std::vector<MarkerRow> marker_rows(const std::vector<Vector3>& places,
                                   const std::vector<Vector3>& displacements);
/// Appends the markers of a sample, row `sample` of response.csv, from 1, at an indentation [m].
void add_sample(const std::vector<MarkerRow>& markers, int sample, double indentation,
                std::vector<MarkerRow>& rows);

/// A marker's place [m]: as given, or the nearest one in the rubber where it lies off that by no
/// more than a thousandth of the finger's largest radius, as rounded numbers may. Throws
/// InvalidInput (key sensor.markers) where it lies farther off, in the rod or outside.
Vector3 marker_at(const Shape& shape, const Vector3& place);

/// Markers on a square grid as seen along the finger's axis, one of them on the axis, `pitch` [m] >
/// 0 apart, on that part of the surface that may touch which leans by no more than 60 degrees, and
/// from there `depth` [m] >= 0 into the rubber along the normal; by increasing y, then x. Throws
/// InvalidInput (sensor.marker_pitch) for more than most_markers or none, (sensor.marker_depth)
/// where one of them would leave the rubber.
std::vector<Vector3> marker_grid(const Shape& shape, double pitch, double depth);

inline constexpr std::size_t most_markers = 10000;

/// What marker_at throws, of all places.
std::vector<Violation> marker_violations(const std::vector<Vector3>& places,
                                         const Geometry& geometry);

}  // namespace fingertip::meshes::inline press
