/// What a page by itself presses: made by the program, read by the module. JSON, SI.
#pragma once

#include <string>
#include <vector>

#include "lattice/press/setup_fields.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/shown_units.h"

namespace fingertip::studies::inline web {

/// A place of the continuum's curve.
struct WebSample {
  double indentation = 0.0;              ///< [m]
  double normal_force = 0.0;             ///< [N]
  double force_error = meshes::unknown;  ///< estimated [N]
};
FINGERTIP_FIELDS(WebSample, indentation, normal_force, force_error);

/// One finger at one spacing.
struct WebPress {
  lattice::PressSetup setup;
  std::vector<lattice::PressSetup> coarser;  ///< by increasing spacing: what may take its place
  std::vector<WebSample> reference;          ///< by increasing indentation; empty without one
  UnitSystem units = UnitSystem::si;
};
FINGERTIP_FIELDS(WebPress, setup, coarser, reference, units);

}  // namespace fingertip::studies::inline web
