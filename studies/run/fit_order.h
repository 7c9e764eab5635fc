/// Everything that a fit to curves depends on, as one job.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/curves/curve.h"
#include "calibration/curves/curve_fit.h"
#include "calibration/curves/fit_record.h"
#include "calibration/curves/scaled_table.h"
#include "lattice/settings.h"
#include "studies/config/config.h"
#include "studies/run/job.h"

namespace fingertip::studies {

/// What answers for one curve.
enum class CurveKind {
  press,         ///< the static lattice
  table,         ///< the continuum, tabulated over Poisson's ratio
  uniaxial,      ///< law A
  simple_shear,  ///< law A
  loss_factor,
  creep,
  ramp,          ///< a press to a depth, held: FitOrder::presses' static lattice, damped
  moving_press,  ///< the moving lattice
};

/// SI. `curves`, `conditions` and `kinds` have an entry per curve; `presses` too where a lattice
/// answers, `tables` where the continuum does.
struct FitOrder {
  CalibrationProblem problem = CalibrationProblem::curve;
  std::vector<calibration::Curve> curves;
  std::vector<std::string> conditions;
  std::vector<CurveKind> kinds;
  std::vector<lattice::PressSetup> presses;
  std::vector<calibration::ScaledTable> tables;
  lattice::PressSetup base;   ///< of the configuration: rubber and lattice that are not sought
  bool rubber_known = false;  ///< the data were made of base.rubber
  calibration::CurveFitOptions options;
  std::vector<double> start_ratios;     ///< Poisson's ratios to start from beside options.free
  std::vector<std::string> profile;     ///< two parameters, or none
  std::vector<std::string> table_keys;  ///< of the continuum jobs that tables are made of
  std::string provenance, program;      ///< for material.toml
};

/// Of `order.options.free`.
std::vector<calibration::MaterialParameter> parameters_of(const FitOrder& order);

/// The fit. Files: calibration.json, material.toml, fit_data.csv, summary.json; while it runs,
/// evaluations/, from which it goes on when it is run again in the same folder.
Job fit_job(const FitOrder& order);

}  // namespace fingertip::studies
