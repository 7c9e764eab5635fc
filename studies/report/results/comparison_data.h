/// Force curves of several runs, compared at samples of the first one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "meshes/press/contact_field.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "studies/files/folder_reader.h"
#include "studies/files/press_condition.h"
#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline results {

/// Samples of one depth: a controller may stop a rounding error beside it.
inline constexpr double rounding_of_depths = 1e-6;

struct ComparedCurve {
  std::string label;
  std::string model;  ///< name of the folder, perhaps that of a model
  std::filesystem::path folder;
  std::optional<PressCondition> condition;
  std::vector<std::string> rejected;  ///< why the fit of what was pressed was not accepted
  meshes::PressResponse response;
  std::vector<meshes::ContactPoint> contact;
  std::vector<meshes::MarkerRow> markers;
  Style style;

  double first_depth() const { return response.samples().front().indentation; }
  double depth() const { return response.depth(); }
};

/// A force of a curve and where it comes from.
struct CurveForce {
  double value = meshes::unknown;  ///< [N]; NaN outside the curve's samples
  double error = meshes::unknown;  ///< estimated size [N]; NaN where none is told
  bool interpolated = false;
};

/// A force beside the first curve's.
struct ComparedForce {
  CurveForce force;
  double difference = meshes::unknown;  ///< relative
};

/// A moment after the first loading, in the same stage of the same program for all.
struct FollowingRow {
  double stage = meshes::unknown, time = meshes::unknown, indentation = meshes::unknown;
  std::vector<ComparedForce> forces;  ///< per curve; the difference is NaN where no force is left
};

/// Everything that is compared: forces at depths at which the first curve has samples.
struct Comparison {
  std::vector<ComparedCurve> curves;
  std::vector<double> depths;                    ///< [m]
  std::vector<std::vector<ComparedForce>> rows;  ///< per depth and curve
  std::vector<ComparisonRemark> remarks;
  /// Of programs: those rows of the first curve that all curves with the same stages have. A curve
  /// of another program, or of none, has no force there.
  std::vector<FollowingRow> following;

  bool interpolates(std::size_t curve) const {
    return std::ranges::any_of(rows,
                               [&](const auto& row) { return row[curve].force.interpolated; });
  }
};

/// Whether what follows the first loading was asked at the same moments of the same stages. Times
/// count from the end of the first loading, wherever a run begins to count.
bool same_stages(const meshes::PressResponse& a, const meshes::PressResponse& b);

/// Reads the curves of `runs`, the continuum first: the others are measured against it, wherever it
/// was named. Throws InvalidInput when there are fewer than two.
Comparison read_comparison(const std::vector<std::filesystem::path>& runs, FolderReader& reader);

/// The folder's name, also when the path ends in a slash or is ".".
std::string folder_name(const std::filesystem::path& folder);

/// The relative L² difference of a curve from the first one between the samples of both.
struct OverallDifference {
  double from = meshes::unknown, to = meshes::unknown;  ///< [m]
  double l2 = meshes::unknown;
};

OverallDifference overall(const ComparedCurve& curve, const ComparedCurve& first);

/// The names of those whose forces are interpolated somewhere; empty without any.
std::string interpolated_curves(const Comparison& comparison);

}  // namespace fingertip::studies::report::inline results
