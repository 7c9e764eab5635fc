/// What forces over a machine's travel tell of its rig before a fit.
#pragma once

#include "calibration/statistics/curve.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline press_fit {

/// The travel at first touch [m]: F^(2/3) of Hertz is straight in delta, from 5 to 40 % of the
/// largest `force` over `zero` [N], a machine of this `compliance` [m/N] taken off. The first value
/// where no line grows through them.
double apparent_touch(const Curve& curve, double zero, double compliance, double force);

/// What a rigid blank tells of its machine: the line F = (x - x0)/c through its forces from a tenth
/// of the largest on. The deviation is that of the slope, as wide as Student's t, and of c between
/// the lower and the upper half of these forces where they differ by more. Throws InvalidInput for
/// fewer than six such forces, and where the force does not grow.
Prior compliance_of_blank(const Curve& curve);

}  // namespace fingertip::calibration::inline press_fit
