/// Measured displacements among the data of a fit. They tell Poisson's ratio and nothing of E,
/// which forces beside them tell.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/files/displacement_fit_file.h"
#include "calibration/press_fit/displacement_fit.h"
#include "fem_reference/job/job.h"
#include "lattice/press/press_setup.h"
#include "studies/config/loader.h"
#include "studies/measurements/displacement_file.h"

namespace fingertip::studies::inline fits::inline setup {

/// What was measured, and what answers for it: the press of `continuum`, or where `by_lattice` that
/// of `press`, a `hookean` or `network` lattice; both have the points as their markers and samples
/// at all indentations measured.
struct DisplacementFitInput {
  DisplacementFile measured;
  bool by_lattice = false;
  lattice::PressSetup press;
  fem_reference::ReferenceJob continuum;
  calibration::FrameMotion frame = calibration::FrameMotion::fitted;
  calibration::FreedPress freed = {};
  std::string place;  ///< stem of the folders of the continua that answer
};

/// The press of `loaded` at rest for what was measured of it, by calibration.forward: of lattices
/// the network where nobody chose one, of both at large strain unless lattice.kinematics says
/// small; calibration.parameters tells what is freed. Throws ConfigError, also for points outside
/// of the rubber and for too few.
DisplacementFitInput displacement_input(const LoadedConfig& loaded, DisplacementFile measured,
                                        const std::string& place);

/// The points as markers. Throws ConfigError naming `place` for points outside of the rubber.
void put_markers(const DisplacementFile& measured, const meshes::Geometry& geometry,
                 const std::string& place, meshes::PressProtocol& protocol);

/// A fit's data, apart.
struct SplitData {
  /// The configuration without displacements and what they alone free; of both kinds of data the
  /// forces tell `modulus`, at the ratio that displacements tell.
  LoadedConfig forces;
  bool has_forces = true;
  std::optional<DisplacementFitInput> displacements = {};
  std::vector<std::string> notes = {};  ///< for people
};

/// Of calibration.data, of which one entry may be displacements (has_displacements). Throws
/// ConfigError, also for what such a file has wrong.
SplitData split_data(const LoadedConfig& loaded);

/// At the ratio that was found, known as well as its interval tells.
LoadedConfig with_ratio(const LoadedConfig& loaded, const calibration::DisplacementFitFile& fit);

}  // namespace fingertip::studies::inline fits::inline setup
