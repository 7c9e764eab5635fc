/// plan.json: what presses that are not made yet would tell, SI.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::studies::inline files {

/// A parameter of a plan, in `unit`: its value there and the 95 % interval that is to be expected.
struct PlannedParameter {
  std::string name, unit;
  double value = meshes::unknown, standard_error = meshes::unknown, lower = meshes::unknown,
         upper = meshes::unknown;
  std::optional<calibration::PriorEntry> prior;
};
constexpr auto fields_of(const PlannedParameter*) {
  using meshes::named;
  using Whole = PlannedParameter;
  return named("name unit value standard_error lower upper prior", &Whole::name, &Whole::unit,
               &Whole::value, &Whole::standard_error, &Whole::lower, &Whole::upper, &Whole::prior);
}

/// Two parameters that the presses hardly tell apart.
struct CollinearEntry {
  std::string first, second;
  double correlation = meshes::unknown, times = meshes::unknown;
};
constexpr auto fields_of(const CollinearEntry*) {
  using meshes::named;
  using Whole = CollinearEntry;
  return named("first second correlation times", &Whole::first, &Whole::second, &Whole::correlation,
               &Whole::times);
}

/// A press of a plan.
struct PlannedPress {
  std::string name, condition;
  std::size_t points = 0;
  double depth = meshes::unknown, largest_force = meshes::unknown;
};
constexpr auto fields_of(const PlannedPress*) {
  using meshes::named;
  using Whole = PlannedPress;
  return named("name condition points depth largest_force", &Whole::name, &Whole::condition,
               &Whole::points, &Whole::depth, &Whole::largest_force);
}

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
constexpr auto fields_of(const PlanFile*) {
  using meshes::named;
  using Whole = PlanFile;
  return named(
      "problem forward noise noise_force rubber presses parameters correlation collinear next "
      "wall_time statement",
      &Whole::problem, &Whole::forward, &Whole::noise, &Whole::noise_force, &Whole::rubber,
      &Whole::presses, &Whole::parameters, &Whole::correlation, &Whole::collinear, &Whole::next,
      &Whole::wall_time, &Whole::statement);
}

}  // namespace fingertip::studies::inline files
