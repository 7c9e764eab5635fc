/// Measured curves from CSV files, with units, into SI.
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/statistics/curve.h"
#include "studies/measurements/curve_columns.h"

namespace fingertip::studies::inline measurements {

/// A comment "# press.contact = "stick"": how the curve was measured, for --set.
struct MeasuredSetting {
  std::string key;       ///< "press.contact"
  std::string value;     ///< TOML literal or bare text as it stands
  std::size_t line = 0;  ///< counted from 1
  std::string assignment() const { return key + "=" + value; }
};

struct MeasuredFile {
  calibration::Curve
      curve;  ///< SI; its name is the source's, with the number of the table of several
  std::string x_quantity, y_quantity;  ///< names of the pair found, e.g. "indentation", "force"
  std::string x_title, x_unit;         ///< as the file has them, "Weg [mm]" and "mm"
  std::vector<std::size_t>
      lines;                      ///< of every point of the curve: its row, or the first of its bin
  std::vector<std::size_t> rows;  ///< the same as `rows` counts them, from 1 in the table
  std::vector<MeasuredSetting> settings;  ///< in the order of the file, each key once
  std::vector<std::string> notes;         ///< what was ignored, left out or averaged
  std::string sha256;                     ///< of the file
};

/// Reads the tables of a file, in general one, in UTF-8, UTF-16 or Latin-1 (text_table.h): a header
/// of titles `name [unit]` and rows of numbers. studies/manual/files.md tells the format to users.
/// - The pair is the first of `allowed` whose columns are both there, or what the source says.
///   `normal_force`, `load`, `kraft` ... are `force`; `travel`, `extension`, `weg` ... `position`.
///   Units are any of the right dimension (units.h), [1] alone where there is none.
/// - `sigma`, in a unit of y, is the standard deviation of every y. Without it a `force_error`,
///   but of a lattice (`boundary.csv` stands beside it), serves where it is known and positive in
///   every row. Further columns are ignored with a note.
/// - Rows with indentation or time <= 0 lie before the start and are left out with a note; a
///   frequency must be positive.
/// - Of presses isolated odd rows, and a load cell at its limit, are left out with a note, and rows
///   in reverse order are turned about (curve_rows.h).
/// - A position may have any sign and stand still or tremble: then its rows are averaged as below.
///   Rows after the largest one, a hold or an unloading, are left out with a note that tells the
///   loop's share of the work. A column time goes along,
///   counted from the first row.
/// - Another x must increase from row to row. More than 200 rows are averaged in at most 200 bins
/// of equal
///   width, with weights 1/sigma² and the mean's sigma (sum of the weights)^(-1/2), which supposes
///   independent errors; there the means of blocks of successive rows (a thousand blocks) may step
///   back by a bin's width and single rows by two: that is noise, and more is unloading.
/// - Forces are positive in compression: their sum must be, single ones may be negative (a note
///   tells how many).
/// Throws InvalidInput with up to ten problems of the file, each with its line, its column and what
/// to do: unreadable or empty file, another encoding, no header, missing or wrong units, cells
/// that are no finite numbers or absurdly large or small (beyond 1e-60 ... 1e60 SI), rows of
/// another length, sigma <= 0, equal or decreasing x, a setting given twice.
///
/// `in_time`, for a rubber that relaxes: presses whose file has a column time keep their holds,
/// over a position or an indentation (curve_in_time); times must increase.
std::vector<MeasuredFile> read_measured(const CurveSource& source,
                                        const std::vector<CurveQuantities>& allowed,
                                        bool in_time = false);

/// Measured files, each of them read once, however often a fit is set up.
class MeasuredFiles {
 public:
  /// As read_measured does.
  const std::vector<MeasuredFile>& of(const CurveSource& source,
                                      const std::vector<CurveQuantities>& allowed,
                                      bool in_time = false);

 private:
  struct Read {
    CurveSource source;
    std::vector<CurveQuantities> allowed;
    bool in_time = false;
    std::vector<MeasuredFile> files;
  };
  std::list<Read> read_;
};

}  // namespace fingertip::studies::inline measurements
