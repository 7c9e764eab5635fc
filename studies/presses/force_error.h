/// The error of a lattice's forces: how far they are from the continuum's in the same press.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fem_reference/job/job.h"
#include "lattice/press/press_deviation.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "studies/config/loaded_config.h"
#include "studies/files/press_summary.h"
#include "studies/jobs/cache.h"

namespace fingertip::studies::inline presses {

/// Where the error comes from.
struct ErrorSource {
  /// The continuum's press at rest; empty: none.
  std::optional<fem_reference::ReferenceJob> continuum;
  bool estimated = false;  ///< by lattice::ForceEstimator
  /// "from the continuum at small strain", "estimated, for the continuum is a solid", or why there
  /// is no error; empty where none is wanted.
  std::string statement;
};

/// What `run.error` means for this press. The continuum's strain is the lattice's unless
/// reference.strain is given. Where the continuum cannot, or takes long, the error is estimated.
ErrorSource error_source(const LoadedConfig& loaded);
/// The same, but for a continuum that is not built yet, not asked for and not kept.
ErrorSource source_at_hand(const LoadedConfig& loaded, const Cache& cache);

/// The response of a continuum's press, from the cache or computed for it, without a run folder.
/// Throws as its job does, Interrupted once `stop` says so.
meshes::PressResponse pressed(const fem_reference::ReferenceJob& reference, const Cache& cache,
                              const std::function<bool()>& stop);

/// What is left where the continuum is not to be had: `why` is a sentence's end.
ErrorSource estimated_source(lattice::ModelKind model, const std::string& why);

/// "force error estimated, for ...: at most 2 %, at 1 mm".
std::string error_words(const ForceErrorEntry& entry);

/// Where an error is above lattice.tolerance, which an automatic spacing is to keep: from which
/// depth on that is, and what makes the error smaller. Else empty.
std::string beyond_tolerance(const LoadedConfig& loaded, const ForceErrorEntry& entry);

/// `response` with force_error = |F - F_continuum| plus the continuum's own error [N], from the
/// first depth of the continuum to its last, and of a lateral motion where both have the same
/// displacement; unknown elsewhere. Between depths the continuum's force is interpolated, and its
/// relative error is the larger one of both sides. At the continuum's depths likewise the errors of
/// lateral force and torque, where symmetry leaves any, and of radius, area and largest pressure.
meshes::PressResponse with_force_error(const meshes::PressResponse& response,
                                       const meshes::PressResponse& continuum);

/// `response`, whose force_error is known, with pressure_error: the same share of the largest
/// pressure, and ForceEstimate::profile.
meshes::PressResponse with_pressure_error(const meshes::PressResponse& response,
                                          const lattice::ForceEstimator& estimator);

/// `response` with the estimate as its errors (PressSample::set_errors, set_pressure_error);
/// unknown where there is none.
meshes::PressResponse with_estimated_error(const meshes::PressResponse& response,
                                           const lattice::ForceEstimator& estimator);

/// Rows of markers.csv beside `response` with the estimate as their error; unknown where there is
/// none.
std::vector<meshes::MarkerRow> with_estimated_error(std::vector<meshes::MarkerRow> markers,
                                                    const meshes::PressResponse& response,
                                                    const lattice::ForceEstimator& estimator);
/// The same where the continuum has pressed: how far a marker is off its own of `of_continuum`,
/// plus that one's error; unknown at samples that the continuum does not have.
std::vector<meshes::MarkerRow> with_marker_error(std::vector<meshes::MarkerRow> markers,
                                                 const meshes::PressResponse& response,
                                                 const std::vector<meshes::MarkerRow>& of_continuum,
                                                 const meshes::PressResponse& continuum);

}  // namespace fingertip::studies::inline presses
