/// Rows of a measured curve: their order, and bins for dense ones.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/curves/curve.h"
#include "studies/run/curve_text.h"

namespace fingertip::studies {

/// One row, SI.
struct CurveRow {
  double x = 0.0, y = 0.0, sigma = 0.0;  ///< sigma 0: unknown, then in every row
  std::size_t line = 0;
};

/// How x is called and shown to the user.
struct Abscissa {
  std::string name, unit;  ///< "indentation", "mm"
  double factor = 1.0;     ///< SI over `unit`

  std::string shown(double si) const;
};

inline constexpr std::size_t most_rows = 200;

/// `rows` (x > 0) as a curve: as they are up to `most_rows`, which must increase in x, or averaged
/// in bins (curve_file.h) with a note. Adds what is wrong to `problems`; the curve then is empty.
calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes);

}  // namespace fingertip::studies
