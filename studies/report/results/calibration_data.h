/// Fits to curves and their predictions, read back from a run folder; SI, NaN where unknown.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_tables.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline results {

/// A quantity as files name it, "force [N]", and how the reader sees it: in the unit that
/// the table of shown_units.h has for it, else in SI.
struct Quantity {
  std::string name, si_unit;  ///< the unit empty when it is 1 or not given
  std::string unit;           ///< shown
  double factor = 1.0;        ///< from SI to shown

  double operator()(double value) const { return factor * value; }
  std::string label() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

Quantity quantity(const std::string& text);

/// A free parameter of a fit, and how the reader sees it.
struct FitParameter : calibration::ParameterEntry {
  std::string symbol = {};  ///< "E", "κ", …; the name itself when it is not a known one
  std::string shown_unit = {}, si_unit = {};  ///< s as ms; empty when it is 1
  double factor = 1.0;                        ///< from SI to shown
  double truth = meshes::unknown;             ///< known in a synthetic study
  std::string bounded = {};                   ///< symbol of what is at its bound: its own, or "ν"
};

/// A curve of a fit.
struct FitCurve {
  std::string name, condition;
  Quantity x_quantity, y_quantity;
  calibration::CurveEntry entry;
  std::vector<calibration::FitDataRow> rows;  ///< empty without fit_data.csv

  /// Whether something is known of some row.
  bool knows(double calibration::FitDataRow::*value) const;
  /// Some point has its sigma.
  bool has_sigma() const;
  /// Some point's total_sigma holds more than its sigma.
  bool has_model_error() const;
  /// relative_rms of the residuals; NaN without points.
  double relative_rms() const;
  /// Worst relative one of the fit without this curve; NaN where there is none.
  double left_out_error() const;
};

/// One fit: calibration.json, fit_data.csv, surrogate.csv and surrogate.json of a folder.
struct Fit {
  std::string name;  ///< "" when it is the run's only one
  std::string folder, model, problem;
  calibration::FitFile file;  ///< calibration.json
  std::vector<FitParameter> parameters;
  std::vector<FitCurve> curves;
  std::vector<calibration::SurrogateRow> surrogate;
  calibration::SurrogateFile surrogate_notes;

  /// Alone: nothing but Poisson's ratio, and no curves.
  bool of_displacements() const { return file.displacements && curves.empty(); }
  /// An entry that is a square matrix over the parameters; empty when it has another size.
  std::vector<std::vector<double>> square(const std::vector<std::vector<double>>& rows) const;
  /// The index of a parameter; the number of parameters when there is none of that name.
  std::size_t index(const std::string& parameter) const;
};

struct CalibrationData {
  std::vector<Fit> fits;
  std::vector<std::string> predictions;  ///< in the order of the case
  std::vector<TransferRow> transfer;
  /// Largest |error|, fits × predictions, NaN where absent: of transfer.csv, else of summary.json.
  std::vector<std::vector<double>> worst_error;
  bool study = false;  ///< summary.json has an entry "calibration"

  bool empty() const { return fits.empty() && transfer.empty() && predictions.empty(); }
};

/// The fits of `run`: those that summary.json names, else those of its sub-folders fits/NAME, else
/// the folder itself when it is one of `calibrate`. Entries of an unexpected type count as
/// absent. What is damaged stays empty and is noted in `reader`.
CalibrationData read_calibration(const RunData& run, FolderReader& reader);

}  // namespace fingertip::studies::report::inline results
