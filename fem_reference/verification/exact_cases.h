/// The boundary value problems with exact solutions that several parts of the verification share.
#pragma once

#include "fem_reference/analytic/cantilever.h"
#include "fem_reference/analytic/thick_shell.h"
#include "fem_reference/verification/elastic_problem.h"

namespace fingertip::fem_reference::inline verification {

/// Walls of the tip's proportions, 0.5 to 1 cm, 400 Pa inside and 150 Pa outside.
analytic::ThickSphere sphere(const meshes::Rubber& rubber);
BodyMesh sphere_body(int divisions, Meshed meshed = Meshed::solid);
Loading sphere_loading();

/// The same as a pipe of 0.5 cm length between smooth walls; twice as many elements around, one
/// along the axis.
analytic::ThickCylinder cylinder(const meshes::Rubber& rubber);
BodyMesh cylinder_body(int divisions, Meshed meshed = Meshed::solid);
Loading cylinder_loading();

/// Plate 4 cm x 0.5 cm x 1 cm between smooth walls, 1 N/m in +z at its end; `divisions` elements
/// in z, as long in x.
analytic::PlaneStrainCantilever cantilever(const meshes::Rubber& rubber);
BodyMesh cantilever_body(int divisions);
/// Keeps a reference to `exact`.
Loading cantilever_loading(const analytic::PlaneStrainCantilever& exact);

inline constexpr double disc_radius = 0.01;  // [m]
/// A disc of that radius and `thickness` [m] bonded to plates at both faces: an eighth of it, or
/// the upper half of its meridian.
BodyMesh disc_body(double thickness, int divisions, int local_refinements,
                   Meshed meshed = Meshed::solid);
/// The upper plate moves down by half of `approach` [m].
Loading disc_loading(double approach);

}  // namespace fingertip::fem_reference::inline verification
