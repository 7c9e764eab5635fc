/// What the presses of a study say together: errors, orders of convergence, error budgets.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "studies/cases/case_file.h"

namespace fingertip::studies {

/// A variant's press beside its continuum, at the samples of the press. NaN where a press did not
/// get that far.
struct VariantResult {
  double spacing = 0.0;                               ///< [m]
  std::vector<double> depth, force, reference_force;  ///< [m], [N]
  std::vector<double> reference_error;                ///< estimated, relative
  std::vector<double> error;                          ///< force over reference_force minus 1
  double worst() const;                               ///< largest |error|; NaN with a gap
};

/// In the order of the case's variants.
using VariantResults = std::vector<VariantResult>;

/// One series as numbers. NaN where a press is missing or there is too little to tell.
struct SeriesMeasures {
  double worst_error = 0.0;   ///< largest |error| of all its presses
  double finest_error = 0.0;  ///< of the press with the smallest spacing (the last of several)
  double spread = 0.0;        ///< largest range of errors at one depth
  /// Slope of log worst() against log spacing by least squares, three spacings or more.
  double order = 0.0;
};

/// A press's force error in parts, per depth.
struct Budget {
  std::vector<double> depth, total;
  std::vector<std::vector<double>> parts;  ///< per CaseBudget::parts, per depth
  std::vector<double> rest;                ///< total minus all parts
};

/// Names of the series in the order of their first variants, without the empty one.
std::vector<std::string> series_names(const Case& one);

/// Places of a series' variants.
std::vector<std::size_t> variants_of(const Case& one, const std::string& series);

/// Places of a series' variants with x >= 1, increasing; empty when none has x = 1.
std::vector<std::size_t> soft_variants(const Case& one, const std::string& series);

SeriesMeasures measure_series(const Case& one, const std::string& series,
                              const VariantResults& results);

/// Errors at x = 0 of the polynomial through those at `x`, all different, by Lagrange.
double continued_to_zero(const std::vector<double>& x, const std::vector<double>& error);

/// Parts from the softer side, x >= 1: stiffer ties than the press has may lock the lattice, which
/// is no longer the compliance's doing. The total is the press at x = 1 of the first part.
Budget take_budget(const Case& one, const CaseBudget& budget, const VariantResults& results);

/// All measures a criterion of this case may name (studies/cases/README.md says what each is).
std::vector<std::string> variant_measure_names(const Case& one);

/// Their values; what could not be taken is absent. `not_converged`: how many presses.
std::map<std::string, double> take_variant_measures(const Case& one, const VariantResults& results,
                                                    std::size_t not_converged);

}  // namespace fingertip::studies
