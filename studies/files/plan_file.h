/// plan.json: what presses that are not made yet would tell, SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// A parameter of a plan, in `unit`: its value there and the 95 % interval that is to be expected.
struct PlannedParameter {
  std::string name, unit;
  double value = meshes::unknown, standard_error = meshes::unknown, lower = meshes::unknown,
         upper = meshes::unknown;
  std::optional<calibration::PriorEntry> prior;
};
FINGERTIP_FIELDS(PlannedParameter, name, unit, value, standard_error, lower, upper, prior);

/// Two parameters that the presses hardly tell apart.
struct CollinearEntry {
  std::string first, second;
  double correlation = meshes::unknown, times = meshes::unknown;
};
FINGERTIP_FIELDS(CollinearEntry, first, second, correlation, times);

/// A press of a plan.
struct PlannedPress {
  std::string name, condition;
  std::size_t points = 0;
  double depth = meshes::unknown, largest_force = meshes::unknown;
};
FINGERTIP_FIELDS(PlannedPress, name, condition, points, depth, largest_force);

/// plan.json of `calibrate --plan`.
struct PlanFile {
  std::string problem, forward;
  double noise = meshes::unknown, noise_force = meshes::unknown;
  calibration::RubberEntry rubber;
  std::vector<PlannedPress> presses;
  std::vector<PlannedParameter> parameters;
  std::vector<std::vector<double>> correlation;
  std::vector<CollinearEntry> collinear;
  std::vector<calibration::NextEntry> next;
  double wall_time = meshes::unknown;
  std::string statement;
};
FINGERTIP_FIELDS(PlanFile, problem, forward, noise, noise_force, rubber, presses, parameters,
                 correlation, collinear, next, wall_time, statement);

}  // namespace fingertip::studies::inline files
