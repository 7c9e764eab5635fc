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
  double time = 0.0;  ///< 0 in every row where unknown
};

/// How x is called and shown to the user.
struct Abscissa {
  std::string name, unit;  ///< "indentation", "mm"
  double factor = 1.0;     ///< SI over `unit`
  bool is_travel = false;  ///< of a machine, whose encoder may stand still or tremble

  std::string shown(double si) const;
};

inline constexpr std::size_t most_rows = 200;

/// Of a travel the rows up to the largest x; what comes later, and the area between loading and
/// unloading over the work of the loading, is told in `notes`.
std::vector<CurveRow> loading(std::vector<CurveRow> rows, std::vector<std::string>& notes);

/// `rows` as a curve: as they are up to `most_rows`, which must increase in x, or averaged in bins
/// (curve_file.h) with a note, as are fewer rows of a travel that does not increase strictly. Adds
/// what is wrong to `problems`; the curve then is empty.
calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes);

}  // namespace fingertip::studies
