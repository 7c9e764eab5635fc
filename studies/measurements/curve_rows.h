/// Rows of a measured curve: their order, and bins for dense ones.
#pragma once

#include <cstddef>
#include <optional>
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

/// Turns about rows that begin at the largest x, and the largest y, and come down: a file in
/// reverse order, or an unloading; tells it.
void put_in_order(std::vector<CurveRow>& rows, const Abscissa& abscissa,
                  std::vector<std::string>& notes);

/// Leaves out isolated rows far from all others and tells their lines: those whose x or y stands
/// apart from both neighbours, which agree, by four usual steps and 3 % of the range; where x is to
/// `climb` also first and last rows that lie back on the way. At most two, or one in 25: more are
/// kept, and told.
void leave_out_odd(std::vector<CurveRow>& rows, const Abscissa& abscissa, bool climb,
                   std::vector<std::string>& notes);

/// Leaves out the last rows of a loading where y stays exactly at its largest value while x goes
/// on, four rows or more: a load cell at its limit; tells it.
void leave_out_clipped(std::vector<CurveRow>& rows, const Abscissa& abscissa,
                       std::vector<std::string>& notes);

/// Three rows or more at the beginning before x has moved by 0.2 % of its way, and five times as
/// many as such a step has on the way to 90 % of it.
struct RestRows {
  std::size_t count = 0;
  double x = 0.0, y = 0.0;  ///< their means
  double y_error = 0.0;     ///< standard error of the mean
};
std::optional<RestRows> rows_at_rest(const std::vector<CurveRow>& rows);

/// Whether five rows or more before touch tell a y there that is not zero: of b + a (x - touch)^p,
/// p = 1, 1.5 or 2, up to 30 % of the rise, the best one's b is four standard errors from zero and
/// 0.2 % of the rise.
bool zero_shows(const std::vector<CurveRow>& rows);

/// Of a travel the rows up to the largest x, without holds on the way. What comes later, holds and
/// the way back, goes into `course`; both are told in `notes`.
/// - Of cycles to larger and larger x what goes back and returns is left out.
/// - The loop is the area between loading and unloading over the work of the loading.
/// - Where the machine stands still (at the end, or on the way for five times as many rows as it
///   takes elsewhere for 1/200 of its way) it holds; the force's fall there over the force at the
///   end of the loading, both over that of the first row, is the relaxation of the longest hold.
/// With `holds` kept, which asks for times, they stay where they are, also the one at the largest
/// x.
enum class Holds { left_out, kept };
std::vector<CurveRow> loading(std::vector<CurveRow> rows, const Abscissa& abscissa,
                              calibration::LoadingHistory& course, std::vector<std::string>& notes,
                              Holds holds = Holds::left_out);

/// Standard deviation of a single y: root mean square of third differences of successive rows over
/// sqrt(20), which parabolas do not change. 0 for fewer than 8 rows. Of filtered forces, whose
/// errors follow each other, it is too small.
double noise_of(const std::vector<CurveRow>& rows);

/// `rows` as a curve: as they are up to so `many`, which must increase in x, or averaged in as many
/// bins (curve_file.h) with a note, as are fewer rows of a travel that does not increase strictly.
/// Adds what is wrong to `problems`; the curve then is empty.
calibration::Curve curve_of(const std::vector<CurveRow>& rows, const Abscissa& abscissa,
                            FileProblems& problems, std::vector<std::string>& notes,
                            std::size_t many = max_rows);

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
