/// Pictures of the continuum that several chapters use: mesh section and contact pressure.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "fem_reference/analytic/hertz.h"
#include "meshes/press/obstacle.h"
#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline continuum {

/// A rectangle of the section, in the units shown; a NaN bound does not bind.
struct Window {
  double x_from = meshes::unknown, x_to = meshes::unknown;
  double z_from = meshes::unknown, z_to = meshes::unknown;
};

/// Appends the line from (x1, z1) to (x2, z2) and a break.
void add_segment(Series& series, double x1, double z1, double x2, double z2);
/// A thin solid line.
Style thin(const std::string& colour, double width = 0.7);
/// The mesh's edges in y = 0 that touch `window`, each once, mirrored when only x >= 0 was
/// computed; in the units shown.
Series section_series(const RunData& run, bool deformed, const Style& style,
                      const Window& window = {});
/// Only x >= 0 was computed.
bool is_half_section(const RunData& run);

/// Those of `computed` [m] that a figure shows: the depths of the verdict, or else six at most,
/// evenly chosen with both ends; and the one where the relative force error is worst.
std::vector<double> shown_depths(const RunData& run, const std::vector<double>& computed);
/// Two indentations [m] that are the same but for rounding.
bool same_depth(double a, double b);
/// "3 mm"
std::string depth_label(double depth);

/// What a press was pressed against; what the entry leaves out has its default.
meshes::Obstacle obstacle_of(const ObstacleEntry& entry);
/// The same of a run, by the continuum's job or the first lattice that tells it; else a plane.
meshes::Obstacle obstacle_of(const RunData& run);
/// First touch, by the mesh section or the lattices' boundaries at rest, in the units shown. Not
/// tilted.
struct FirstTouch {
  double x = 0.0;  ///< where the finger is touched
  /// Height of the plane that touches the obstacle at its top.
  double plane = -std::numeric_limits<double>::infinity();
};
FirstTouch first_touch(const RunData& run);
/// The obstacle's outline in y = 0 over `x`, with that plane at height `plane`; in the units shown.
Series obstacle_series(const RunData& run, const Range& x, double plane);

/// Radius of the tip [m] by the continuum's job; NaN without one.
double tip_radius(const RunData& run);
/// Hertz's contact of a sphere of the run's rubber and radius with a plane, or with a ball under
/// its axis (1/R = 1/R_tip + 1/R_ball); none without the continuum's job, none for other obstacles.
std::optional<fem_reference::analytic::Hertz> hertz_contact(const RunData& run);

/// The finest mesh as a whole and near the contact.
Figure mesh_figure(const RunData& run);
/// Pressure over radius, with Hertz's at the same indentation where it is known.
Figure pressure_figure(const RunData& run);

}  // namespace fingertip::studies::report::inline chapters::inline continuum
