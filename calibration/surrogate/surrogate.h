/// Force and stiffness of a calibrated press as one smooth monotone curve, for gain scheduling.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::calibration::inline surrogate {

/// What the calibrated model answers at one indentation.
struct SurrogateSample {
  double indentation = 0.0;  ///< [m], > 0
  double force = 0.0;        ///< [N], > 0
  double deviation = 0.0;    ///< standard deviation of the force, from the parameters' covariance
                             ///< and the model's error [N], >= 0
};

/// A curve by its values at knots, between which F is a cubic (Hermite) and the band linear.
struct SurrogateTable {
  std::vector<double> knots;      ///< indentation [m], increasing from 0, at least 2
  std::vector<double> force;      ///< [N], 0 at first
  std::vector<double> stiffness;  ///< dF/d(indentation) [N/m], >= 0
  std::vector<double> band;       ///< half width of the error band of F [N], >= 0
  std::string condition;          ///< of the press: "frictionless", may be empty
  std::string statement;          ///< how the curve was made, in words

  /// Every broken rule, among them a cubic that falls somewhere between its knots.
  std::vector<meshes::Violation> violations() const;
};

/// Evaluated in some ten nanoseconds, without allocation; safe from several threads.
class Surrogate {
 public:
  /// Throws InvalidInput for a table that breaks a rule.
  explicit Surrogate(SurrogateTable table);

  /// F [N] at an indentation [m]: 0 below zero, where nothing touches; beyond the last knot a
  /// straight line with the last stiffness.
  double force(double indentation) const;
  /// dF/d(indentation) [N/m]: 0 below zero, the last one beyond the last knot.
  double stiffness(double indentation) const;
  /// Half width of the band about F [N]: 0 below zero; beyond the last knot it grows like F, which
  /// is a guess.
  double band(double indentation) const;
  /// The last knot [m]: up to here the curve rests on samples.
  double depth() const { return table_.knots.back(); }
  const SurrogateTable& table() const { return table_; }

 private:
  /// The last knot at or below, but not the last of all.
  std::size_t interval(double indentation) const;

  SurrogateTable table_;
};

/// A C² cubic spline with F(0) = 0, F' >= 0 and F' > 0 beyond 0, through the samples but for their
/// roughness; a lattice has some, for points join the contact one by one. Knots at D (k/12)², so
/// that Hertz's F' ∝ sqrt(indentation) is a straight line over the index: its curvature is
/// penalised (P-splines, Eilers & Marx 1996), its B-spline coefficients are not negative
/// (I-splines, Ramsay 1988). Band: 1.96 deviations and the largest residual, in units of F^(2/3),
/// or more where the samples beside a knot have more; it contains every sample. Throws InvalidInput
/// for fewer than 5 samples, indentations that do not increase from 0, forces that are not
/// positive, negative deviations. `condition`: that of the press.
Surrogate fit_surrogate(const std::vector<SurrogateSample>& samples,
                        const std::string& condition = "");

/// `indentation [m],force [N],stiffness [N/m],force_lower [N],force_upper [N]` at 64 equal steps
/// from 0 to the last knot. Throws std::runtime_error when the file cannot be written.
void write_surrogate_csv(const Surrogate& surrogate, const std::filesystem::path& file);

/// knots, force, stiffness, band, statement, condition, units: the table, to its last bit. Throws
/// std::runtime_error when the file cannot be written.
void write_surrogate_json(const Surrogate& surrogate, const std::filesystem::path& file);

/// Throws InvalidInput naming the file for one that cannot be read, is no JSON, lacks an entry, has
/// other units, or holds a table that breaks a rule.
Surrogate read_surrogate_json(const std::filesystem::path& file);

}  // namespace fingertip::calibration::inline surrogate
