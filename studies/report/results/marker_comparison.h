/// Displacements of markers of several runs at the samples that they share with the first one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "meshes/press/marker_measures.h"
#include "studies/report/results/contact_comparison.h"

namespace fingertip::studies::report::inline results {

using MarkerField = std::span<const meshes::MarkerRow>;

struct MarkersAtSample {
  int sample = 0;                        ///< row of the first run's response.csv, from 1
  double indentation = meshes::unknown;  ///< there [m]
  std::vector<MarkerField> fields = {};  ///< per run; empty where it has none there
  /// Per run from the first one; empty of that and where it has no field.
  std::vector<std::vector<meshes::MarkerRow>> differences = {};

  /// Of a run from the first one.
  meshes::MarkerLengths difference(std::size_t run) const {
    return meshes::marker_lengths(differences[run]);
  }
  /// Its root mean square over that of the first run's displacements; unknown where those vanish.
  double relative(std::size_t run) const;
  /// What the errors of both leave open of that.
  double relative_error(std::size_t run) const;
};

struct MarkerComparison {
  std::vector<RunContact> runs;          ///< those with markers
  std::vector<MarkersAtSample> samples;  ///< of the first run, of several those that another has
};

/// Of the runs those are left out that have no markers, or other ones than the first that has some.
MarkerComparison compared_markers(std::vector<RunContact> runs);

}  // namespace fingertip::studies::report::inline results
