/// The presses of a study, read back from variants.csv, and the figures drawn of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "studies/report/page/document.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline models {

/// One static press beside its continuum; NaN where it did not get that far.
using VariantPress = std::span<const VariantRow>;
/// In the order of the case.
std::vector<VariantPress> presses_of(const std::vector<VariantRow>& table);
/// Largest |error|; NaN when there is none.
double worst_error(const VariantPress& press);

/// Force error against the study's abscissa, a panel for each of up to four depths. No panel when
/// no press has an x.
Figure variant_error_figure(const std::vector<VariantRow>& table, const std::string& x_label);

/// Largest force error against spacing, both logarithmic, of the series for which `study`, the
/// entry "variants" of summary.json, has an order. No panel when there is none.
Figure convergence_figure(const std::vector<VariantRow>& table, const StudyEntry& study);

/// Force against indentation, a panel per series, the continua black.
Figure variant_force_figure(const std::vector<VariantRow>& table);

/// Force error against indentation, a figure per series (the legends need the room).
std::vector<Figure> variant_depth_figures(const std::vector<VariantRow>& table);

/// Of programs: force against time and its distance from the continuum's over the largest force, a
/// figure per series of `table`.
std::vector<Figure> variant_later_figures(const std::vector<LaterRow>& table);

}  // namespace fingertip::studies::report::inline chapters::inline models
