/// Rows of a measured curve: their order, and bins for dense ones.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calibration/statistics/curve.h"
#include "studies/measurements/curve_text.h"

namespace fingertip::studies::inline measurements {

using calibration::CurveRow;

/// How x is called and shown to the user.
struct Abscissa {
  std::string name, unit;  ///< "indentation", "mm"
  double factor = 1.0;     ///< SI over `unit`
  bool is_travel = false;  ///< of a machine, whose encoder may stand still or tremble

  std::string shown(double si) const;
};

inline constexpr std::size_t max_rows = 200;

/// Of a travel the rows up to the largest x, without holds on the way. What comes later, holds and
/// the way back, goes into `course`; both are told in `notes`.
/// - The loop is the area between loading and unloading over the work of the loading.
/// - Where the machine stands still (at the end, or on the way for five times as many rows as it
///   takes elsewhere for 1/200 of its way) it holds; the force's fall there over the force at the
///   end of the loading, both over that of the first row, is the relaxation of the longest hold.
/// With `holds` kept, which asks for times, they stay where they are, also the one at the largest
/// x.
enum class Holds { left_out, kept };
std::vector<CurveRow> loading(std::vector<CurveRow> rows, calibration::LoadingHistory& course,
                              std::vector<std::string>& notes, Holds holds = Holds::left_out);

/// Standard deviation of a single y: root mean square of third differences of successive rows over
/// sqrt(20), which parabolas do not change. 0 for fewer than 8 rows. Of filtered forces, whose
/// errors follow each other, it is too small.
double noise_of(const std::vector<CurveRow>& rows);

/// `rows` as a curve: as they are up to `max_rows`, which must increase in x, or averaged in bins
/// (curve_file.h) with a note, as are fewer rows of a travel that does not increase strictly. Adds
/// what is wrong to `problems`; the curve then is empty.
calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes);

/// A loading with its holds, value after value in time (Curve::in_time): rows on the way as above,
/// those of a hold, where they are more than forty, averaged in bins whose width grows with the
/// time since it began.
struct TimedCurve {
  calibration::Curve curve;
  std::vector<std::size_t> lines;  ///< of every value: its row, or the first of its bin
};
TimedCurve curve_in_time(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                         FileProblems& problems, std::vector<std::string>& notes);

}  // namespace fingertip::studies::inline measurements
