/// Surfaces in space, twice from the same scene: printed by gnuplot, turned by the page's script.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline figure {

/// The part of a gnuplot script that draws the surfaces of the figure's panels.
std::string surface_script(const Figure& figure);

/// A panel's surface and its axes as the page's script draws them where gnuplot printed them, in a
/// square `side` [px] wide: view [azimuth, elevation in degrees], points [px from the middle; third
/// axis upward], pieces [colour, points' numbers; two for a line, four for a facet], labels [text,
/// place, direction of its axis where it is written along it].
nlohmann::ordered_json turning_surface(const Panel& panel, double side);

/// Left of this lies what turns, right of it the colour scale [px].
double colour_scale_at(const Figure& figure);

}  // namespace fingertip::studies::report::inline figure
