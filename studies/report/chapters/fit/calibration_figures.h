/// The figures of fits and their predictions. A figure without panels has nothing to show.
#pragma once

#include <string>
#include <vector>

#include "studies/report/figure/figure.h"
#include "studies/report/results/calibration_data.h"

namespace fingertip::studies::report::inline chapters::inline fit {

/// Measured against fitted curves, the residuals beneath: those whose squares are chi-square, or in
/// per cent of what was measured where no sigma is given. One figure for each pair of quantities
/// among the curves; names begin with `prefix`.
std::vector<Figure> curve_figures(const Fit& fit, const std::string& prefix);

/// Singular values on a logarithmic axis with the limit below which a direction counts as open.
Figure singular_value_figure(const Fit& fit, const std::string& prefix);

/// Where the profile's increase of chi-square reaches 2.30, 5.99 and 9.21, the 68.3, 95 and 99 %
/// regions of two parameters; the estimate, the truth where it is known, and dashed the 95 %
/// ellipse of the covariance. Squares at the nodes in place of lines where the grid is too coarse
/// for the valley.
Figure profile_figure(const Fit& fit, const std::string& prefix);

/// Force with its band, and stiffness, against indentation; the knots are marked.
Figure surrogate_figure(const Fit& fit, const std::string& prefix);

/// Whether the fit seeks constants of springs for a rubber that is known, in place of a rule's.
bool finds_springs(const Fit& fit);

/// E(n) of the fitted lattice, where that finds springs beside the published rule's lattice.
/// Without panels for an isotropic one that measurements told.
Figure fitted_moduli_figure(const Fit& fit, const std::string& prefix);

/// Force error against indentation, a panel per prediction, a curve per fit.
Figure transfer_figure(const CalibrationData& data);

/// The share of the largest singular value below which fits call a direction open
/// (CurveFitOptions::relative_singular_value).
inline constexpr double open_share = 0.02;

}  // namespace fingertip::studies::report::inline chapters::inline fit
