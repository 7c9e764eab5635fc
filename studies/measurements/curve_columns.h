/// Which columns of a file make a measured curve, and in which units they stand.
#pragma once

#include <cmath>
#include <optional>

#include "studies/measurements/curve_source.h"

namespace fingertip::studies::inline measurements {

/// A column's name and SI unit, "1" for a number without dimension.
struct Quantity {
  std::string_view name, unit;

  bool operator==(const Quantity&) const = default;
};

/// What a file may hold: y over x.
struct CurveQuantities {
  Quantity x, y;

  bool operator==(const CurveQuantities&) const = default;
};

/// The pairs that calibrations know.
namespace measured {
inline constexpr CurveQuantities press{{"indentation", "m"}, {"force", "N"}};
inline constexpr CurveQuantities travel{{"position", "m"}, {"force", "N"}};
inline constexpr CurveQuantities vibration{{"frequency", "Hz"}, {"loss_factor", "1"}};
inline constexpr CurveQuantities creep{{"time", "s"}, {"creep", "1"}};
inline constexpr CurveQuantities relaxation{{"time", "s"}, {"force", "N"}};
}  // namespace measured

/// A column that is read.
struct CurveColumn {
  std::size_t index = 0;
  std::string title, unit;
  double factor = 1.0;    ///< SI over a number, with scale and sign
  bool is_clock = false;  ///< h:min:s may stand in it
  ColumnZero zero = {};
  double taken_off = 0.0;  ///< by zero, of every number

  /// 1/1000 is no binary number, 1000 is: dividing by it rounds once, so that 0.3 mm is 3e-4 m.
  double si(double value) const {
    value -= taken_off;
    const double inverse = std::round(1.0 / factor);
    return std::abs(factor) < 1.0 && 1.0 / inverse == factor ? value / inverse : value * factor;
  }
};

/// Whether a title alone says that a column is a length: "Displacement", "Weg"; not "Extension",
/// which may be a strain.
bool names_a_length(const TableTitle& title);

/// Those that the source describes, else those that go by the name of a quantity, or one of its
/// other names. What is wrong with titles and units is added to the problems.
class CurveColumns {
 public:
  CurveColumns(const CurveSource& source, const std::vector<CurveQuantities>& allowed,
               FileProblems& problems)
      : source_(source), allowed_(allowed), problems_(problems) {}

  /// What the source says of a quantity; null: nothing.
  const DescribedColumn* wish(std::string_view quantity) const;
  /// The file's tables; their columns are those of the source, or the first pair that is there.
  TextTables tables(std::string_view text);
  /// No line of the text has the columns that are needed.
  void refuse_header(std::string_view text);
  std::optional<std::size_t> find(const TextTable& table, std::string_view name);
  CurveColumn column(const TextTable& table, std::size_t index, const Quantity& quantity,
                     std::vector<std::string>& notes);

 private:
  const CurveSource& source_;
  const std::vector<CurveQuantities>& allowed_;
  FileProblems& problems_;
};

}  // namespace fingertip::studies::inline measurements
