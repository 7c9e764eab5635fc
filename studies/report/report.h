/// From run folders to pages: the validation report and the comparison of runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fingertip::studies {

/// Writes `report.html` (self-contained) and the folder `figures/` (one SVG and one CSV per
/// figure) into the run folder of `validate`, of `bench` (it holds bench.json), or of a `calibrate`
/// that fitted curves. Everything is
/// read from disk; chapters whose files are missing are left out and named as not run. The old
/// report stays until the new one is complete.
/// Throws meshes::InvalidInput when the folder is not one of these (no readable summary.json, nor a
/// calibration.json with its problem) or holds a damaged file; std::runtime_error when gnuplot
/// cannot draw a figure or a file cannot be written.
void write_report(const std::filesystem::path& run_folder);

/// Writes `comparison.html`, `comparison.csv` and `figures/` into `out_folder` (made if missing):
/// the force-indentation curves of the runs and their differences relative to the first one.
/// A run is a folder with `response.csv`; a folder of `validate` counts as the runs inside it,
/// the continuum first.
/// comparison.csv has the columns `indentation [m]` (the samples of the first run), then per run
/// `NAME normal_force [N]` and, from the second on, `NAME relative_difference`; cells beyond the
/// depth of a run are empty.
/// Throws like write_report, and InvalidInput for fewer than two curves.
void write_comparison(const std::vector<std::filesystem::path>& runs,
                      const std::filesystem::path& out_folder);

/// The verdict table of a `validate` run folder as plain ASCII for a terminal, gf and cm: per
/// model the elastic constants and the force error at each depth, then the criteria.
/// Throws meshes::InvalidInput like write_report.
std::string verdict_text(const std::filesystem::path& run_folder);

}  // namespace fingertip::studies
