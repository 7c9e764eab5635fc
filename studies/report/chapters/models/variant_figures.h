/// The presses of a study, read back from variants.csv, and the figures drawn of them.
#pragma once

#include <string>
#include <vector>

#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline models {

/// One static press beside its continuum; SI, NaN where it did not get that far.
struct VariantPress {
  std::string series, name, model, continuum, status;
  double x = meshes::unknown;  ///< its place on the study's abscissa
  double spacing = 0.0, volume_defect = 0.0, wall_time = 0.0;
  std::vector<double> depth, force, reference, error;

  /// Largest |error|; NaN when there is none.
  double worst() const { return largest_magnitude(error); }
};

/// In the order of the case.
std::vector<VariantPress> read_variants(const std::vector<VariantRow>& table);

/// Series in the order of their first presses; the empty name, too.
std::vector<std::string> series_of(const std::vector<VariantPress>& presses);
std::vector<std::string> series_of(const std::vector<LaterRow>& table);

/// Force error against the study's abscissa, a panel for each of up to four depths. No panel when
/// no press has an x.
Figure variant_error_figure(const std::vector<VariantPress>& presses, const std::string& x_label);

/// Largest force error against spacing, both logarithmic, of the series for which `study`, the
/// entry "variants" of summary.json, has an order. No panel when there is none.
Figure convergence_figure(const std::vector<VariantPress>& presses, const StudyEntry& study);

/// Force against indentation, a panel per series, the continua black.
Figure variant_force_figure(const std::vector<VariantPress>& presses);

/// Force error against indentation, a figure per series (the legends need the room).
std::vector<Figure> variant_depth_figures(const std::vector<VariantPress>& presses);

/// Of programs: force against time and its distance from the continuum's over the largest force, a
/// figure per series of `table`.
std::vector<Figure> variant_later_figures(const std::vector<LaterRow>& table);

}  // namespace fingertip::studies::report::inline chapters::inline models
