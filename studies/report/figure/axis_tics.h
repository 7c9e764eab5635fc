/// Where the tics of a logarithmic axis stand and what is written beside them.
#pragma once

#include <string>
#include <vector>

#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline figure {

/// Powers of ten that enclose `extent`, that of the data, over few decades with 2 and 5 times them.
/// Where an axis that shows `range` would have one or two of these, multiples of 1, 2 or 5 times a
/// power of ten within it. All ends are positive.
std::vector<double> logarithmic_tics(const Range& extent, const Range& range);

/// "200", "2×10⁵"; `value` is positive.
std::string tic_label(double value);

}  // namespace fingertip::studies::report::inline figure
