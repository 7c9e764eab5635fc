/// From run folders to pages: the validation report and the comparison of runs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshes/base/errors.h"
#include "studies/files/shown_units.h"

namespace fingertip::studies::report {

/// What was wrong with files of run folders; empty when nothing was.
using Damages = std::vector<meshes::Violation>;

/// Writes `report.html` (self-contained) and the folder `figures/` (one SVG and one CSV per
/// figure) into a run folder of any verb. Everything is read from disk; chapters whose files are
/// missing are left out and named as not run. Damaged files do not keep the rest from being
/// reported: the page names them and lacks what they hold, and they are returned.
/// The old report stays until the new one is complete.
/// The page is in `units`, without them in those of the run.
/// Throws meshes::InvalidInput when the folder is none of a run (no summary.json, calibration.json
/// or bench.json) and when gnuplot cannot be started; std::runtime_error when a figure cannot be
/// drawn or a file cannot be written.
Damages write_report(const std::filesystem::path& run_folder,
                     std::optional<UnitSystem> units = std::nullopt);

struct ComparisonResult {
  std::string text;  ///< for a terminal: table, differences, remarks
  Damages damage;
};

/// Writes `comparison.html`, `comparison.csv` and `figures/` into `out_folder` (made if missing):
/// the force-indentation curves of the runs and their differences relative to the first one, which
/// is a continuum where there is one.
/// A run is a folder with `response.csv`; a folder of `validate` counts as the runs inside it.
/// Depths are samples of the first run at which another has a sample, too, or, where a run shares
/// fewer than two, samples of the first within that run's; there its force is interpolated, which
/// is told. Nothing is told outside the samples of a run.
/// Where runs differ in contact, geometry, rubber, tilt, lateral motion, strain or speed, page and
/// text say so (press_condition.h).
/// comparison.csv has the columns `indentation [m]`, then per run `NAME normal_force [N]` and, from
/// the second on, `NAME relative_difference` and `NAME interpolated` (1 or 0); cells beyond the
/// samples of a run are empty.
/// Damaged runs are left out while two are left. Throws like write_report, and InvalidInput for
/// fewer than two curves.
ComparisonResult write_comparison(const std::vector<std::filesystem::path>& runs,
                                  const std::filesystem::path& out_folder);

/// What the contact of a press or a continuum holds by Coulomb friction (limit_surface.h), sample by
/// sample, for a terminal; writes limit_surface.csv into the run folder: `sample`, `indentation
/// [m]`, `centre [m]`, `force [N]`, `moment [N m]`, both per unit of the coefficient. Throws
/// meshes::InvalidInput without contact_field.csv, for one that is damaged, without a push, and for
/// a frictionless press.
std::string write_limit_surface(const std::filesystem::path& run_folder);

/// What the page of a `validate` or `calibrate` run folder tells in its main tables, for a
/// terminal, then the criteria. Throws meshes::InvalidInput like write_report, and for damaged
/// files.
std::string verdict_text(const std::filesystem::path& run_folder);

}  // namespace fingertip::studies::report
