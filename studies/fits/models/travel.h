/// A press over the travel of a machine: where it touches, and what a blank tells of the machine.
#pragma once

#include <string>
#include <vector>

#include "calibration/press_fit/rig_model.h"
#include "calibration/statistics/curve.h"
#include "studies/config/keys/config.h"
#include "studies/measurements/curve_file.h"

namespace fingertip::studies::inline fits::inline models {

/// A curve of force over a machine's travel.
struct Travel {
  RigSettings settings;
  std::string machine;         ///< files of one name share a compliance
  double touch = 0.0;          ///< travel at which force seems to begin [m]
  double reach = 0.0;          ///< travel from there to the curve's end [m]
  double force = 0.0;          ///< largest, over the load cell's zero [N]
  std::vector<double> depths;  ///< at which the press answers [m]
  calibration::Rig rig;        ///< places among all free parameters of the fit

  /// From these and a start of the fit's parameters: indentations of all values, 0 before touch.
  std::vector<double> indentations(const calibration::Curve& curve,
                                   const Eigen::VectorXd& parameters) const;
};

/// Nothing of it free, at the settings' values.
calibration::Rig rig_of(const RigSettings& settings);

/// `others` of its machine and the blank that the rig names. Throws InvalidInput as curve_sources.
std::vector<CurveSource> blanks_of(const RigSettings& rig, std::vector<CurveSource> others = {});

/// `rig` with the compliance that blanks of its machine tell, if there are any; what is said of
/// that goes into `notes`, once. Throws InvalidInput (key calibration.rig) for a compliance beside
/// a blank, and as readers of files do.
RigSettings with_blank(RigSettings rig, const std::vector<CurveSource>& blanks,
                       MeasuredFiles& files, std::vector<std::string>& notes);

/// The settings that concern `curve`, and what its forces tell of the touch: F^(2/3) of Hertz is
/// straight in delta, from 5 to 40 % of the largest force. Throws InvalidInput (key
/// calibration.rig) for a travel that ends before the given touch, for no force, and for a drift
/// without times.
Travel travel_of(const calibration::Curve& curve, const CalibrationSettings& settings);

/// The travel of further rows of a press, which begin under load: its touch and its zero are those
/// that the rows before tell.
Travel continued(Travel travel, const calibration::Curve& curve, const Travel& before,
                 const calibration::Curve& rows_before);

}  // namespace fingertip::studies::inline fits::inline models
