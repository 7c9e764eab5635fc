/// What runs are measured by (studies/manual/files.md says what each measure is): a run alone, by
/// the one table in run_measures.cc; a series; the whole case, under the names of criteria.
#pragma once

#include "studies/cases/run_result.h"

namespace fingertip::studies::inline cases {

/// Names of the measures that the run is meant to have.
std::vector<std::string> measures_meant(const CaseRun& run);

/// Their values, from what the run left in `place`; what could not be taken is absent. What an
/// incomplete press in time or grasp did so far must not pass for what it did: it has none.
Measures measures_of_run(const Case& study_case, const RunResult& result,
                         const std::filesystem::path& place);

/// All measures a criterion of this case may name: of every run by its full name, of a series the
/// largest of its runs, and those of the whole case.
std::vector<std::string> measure_names(const Case& study_case);

/// Their values; what could not be taken is absent. A series has a measure when all of its runs
/// have that are meant to have it.
Measures take_measures(const Case& study_case, const RunResults& results);

using Members = std::vector<const RunResult*>;

/// The results of a kind of runs, and of a series of them, in the order of the case.
Members members(const RunResults& results, std::string_view kind);
Members members(const RunResults& results, std::string_view kind, const std::string& series);

/// Names of the series of a kind of runs, in the order of their first runs, without the empty one.
std::vector<std::string> series_names(const RunResults& results, std::string_view kind);

/// A field of displacements beside measured ones.
struct Displaced {
  std::string name;    ///< of the press, or "continuum" with its strain
  std::string folder;  ///< of its run
  const DisplacementFile* measured = nullptr;
  const std::vector<calibration::DisplacementDistance>* distances = nullptr;  ///< per sample
};

/// Of every press that names measured displacements, and once of each continuum beside them.
std::vector<Displaced> displaced(const Members& variants);

/// A series of variants as numbers. NaN where a press is missing or there is too little to tell.
struct SeriesMeasures {
  double worst_error = 0.0;   ///< largest |error| of all its presses
  double finest_error = 0.0;  ///< of the press with the smallest spacing (the last of several)
  double spread = 0.0;        ///< largest range of errors at one depth
  /// Slope of the logarithm of a press's worst error against log spacing by least squares, three
  /// spacings or more.
  double order = 0.0;
};

SeriesMeasures measure_series(const Members& series);

/// How far a series of grasps is from the friction limit, where it should begin to hold: the larger
/// of the distances, relative, of its weakest grip that holds and of its strongest that does not.
/// NaN unless there are both, and every grip that holds is stronger than every one that does not.
double limit_error(const Members& series);

/// The largest over the least end_ratio of a series of fits of laws: what their conditions explain,
/// as a factor of stress. NaN unless all have one.
double end_ratio_span(const Members& series);

/// A press's force error in parts, per depth.
struct Budget {
  std::vector<double> depth, total;
  std::vector<std::vector<double>> parts;  ///< per CaseBudget::parts, per depth
  std::vector<double> rest;                ///< total minus all parts
};

/// A series' variants with x >= 1, increasing; empty when none has x = 1.
Members soft_variants(const RunResults& results, const std::string& series);

/// Parts from the softer side, x >= 1: stiffer ties than the press has may lock the lattice, which
/// is no longer the compliance's doing. The total is the press at x = 1 of the first part.
Budget take_budget(const CaseBudget& budget, const RunResults& results);

}  // namespace fingertip::studies::inline cases
