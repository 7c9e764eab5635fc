#include "studies/report/results/comparison_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/material/material.h"
#include "meshes/base/errors.h"
#include "studies/report/figure/format.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline results {
namespace {

namespace fs = std::filesystem;

/// Depths of a table where curves have no samples in common.
constexpr std::size_t max_depths = 20;

/// The force of a sample at `depth`, else the one interpolated between samples around it.
CurveForce told_force(const ComparedCurve& curve, double depth) {
  for (const meshes::PressSample& sample : curve.response.pressing())
    if (std::abs(sample.indentation - depth) <= rounding_of_depths * std::abs(depth))
      return {sample.normal_force, sample.force_error};
  if (!(depth > std::max(0.0, curve.first_depth()) && depth < curve.depth())) return {};
  const double force = curve.response.normal_force_at(depth);
  return {force, std::abs(force) * curve.response.relative_error_at(depth), true};
}

/// A press with a fit that was not accepted tells so in its warnings.
std::vector<std::string> read_rejected(const fs::path& folder, FolderReader& reader) {
  return reader.attempt([&] {
    std::vector<std::string> found;
    for (const JsonEntry& warning : array_if_any(reader.json(folder / "summary.json"), "warnings"))
      if (warning.text().find(calibration::failed_its_tests) != std::string::npos)
        found.push_back(warning.text());
    return found;
  });
}

/// The curves of a run: its own, or those of the runs inside it, continuum first.
std::vector<ComparedCurve> read_curves(const fs::path& folder, FolderReader& reader) {
  const std::string label = folder_name(folder);
  const auto curve = [&](const fs::path& place, const std::string& name, const std::string& model) {
    return ComparedCurve{name,
                         model,
                         place,
                         read_condition(place, reader),
                         read_rejected(place, reader),
                         reader.response(place / "response.csv"),
                         reader.rows<meshes::ContactPoint>(place / "contact_field.csv"),
                         reader.rows<meshes::MarkerRow>(place / "markers.csv"),
                         {}};
  };
  if (fs::exists(folder / "response.csv")) return {curve(folder, label, label)};
  std::vector<ComparedCurve> curves;
  for (const std::string name : {"reference", "published", "central", "hookean"})
    if (fs::exists(folder / name / "response.csv"))
      curves.push_back(curve(folder / name, label + "/" + name, name));
  if (curves.empty()) {
    throw meshes::InvalidInput(
        meshes::Violation{folder.string(), "", "a run to compare must hold response.csv",
                          "name the folder of a press, a reference or a validate run"});
  }
  return curves;
}

/// Equal names become "name (2)" and so on, so that every column and curve can be told apart.
void make_unique(std::vector<ComparedCurve>& curves) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    int copies = 1;
    for (std::size_t j = 0; j < i; ++j) copies += curves[j].label == curves[i].label ? 1 : 0;
    if (copies > 1) curves[i].label += fmt::format(" ({})", copies);
  }
}

/// Whether every curve is a model of its own, so that the models' usual styles tell them apart.
bool are_models(const std::vector<ComparedCurve>& curves) {
  std::set<std::string> left{"reference", "published", "central", "hookean"};
  return std::all_of(curves.begin(), curves.end(),
                     [&](const ComparedCurve& curve) { return left.erase(curve.model) == 1; });
}

/// Sets the curves' styles.
void give_styles(std::vector<ComparedCurve>& curves) {
  const bool models = are_models(curves);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].style = models ? model_style(curves[i].model) : numbered_style(i);
  }
}

/// At most so many of them, the first and the last among them.
std::vector<double> thinned(const std::vector<double>& depths) {
  if (depths.size() <= max_depths) return depths;
  std::vector<double> some;
  for (std::size_t i = 0; i < max_depths; ++i)
    some.push_back(depths[i * (depths.size() - 1) / (max_depths - 1)]);
  return some;
}

/// Samples of the first curve at which another has one, too; where there are fewer than two for a
/// curve, some of the first curve's samples between that curve's.
std::vector<double> compared_depths(const std::vector<ComparedCurve>& curves) {
  std::set<double> depths;
  for (std::size_t i = 1; i < curves.size(); ++i) {
    std::vector<double> common, inside;
    for (const meshes::PressSample& sample : curves.front().response.pressing()) {
      const CurveForce force = told_force(curves[i], sample.indentation);
      if (std::isnan(force.value) || !(sample.indentation > 0.0)) continue;
      inside.push_back(sample.indentation);
      if (!force.interpolated) common.push_back(sample.indentation);
    }
    const std::vector<double> chosen = common.size() < 2 ? thinned(inside) : common;
    depths.insert(chosen.begin(), chosen.end());
  }
  return {depths.begin(), depths.end()};
}

}  // namespace

bool same_stages(const meshes::PressResponse& a, const meshes::PressResponse& b) {
  const auto one = a.following(), other = b.following();
  if (one.size() != other.size()) return false;
  const double depth = std::max(a.deepest(), b.deepest());
  const double begin = a.pressing().back().time, other_begin = b.pressing().back().time;
  for (std::size_t i = 0; i < one.size(); ++i) {
    // Under a controller the rod is about where it should be.
    constexpr double beside = 0.02, late = 1e-4;
    if (one[i].stage != other[i].stage ||
        std::abs(one[i].indentation - other[i].indentation) > beside * depth)
      return false;
    const double time = one[i].time - begin, other_time = other[i].time - other_begin;
    if (std::isnan(time) != std::isnan(other_time) ||
        std::abs(time - other_time) > late * std::abs(time))
      return false;
  }
  return true;
}

namespace {

/// Fills Comparison::following, and tells of curves that have no part in it.
void compare_following(Comparison& comparison) {
  const std::vector<ComparedCurve>& all = comparison.curves;
  const meshes::PressResponse& first = all.front().response;
  std::vector<bool> takes_part;
  for (const ComparedCurve& curve : all) {
    takes_part.push_back(!first.following().empty() && same_stages(curve.response, first));
    if (!takes_part.back() && !(first.following().empty() && curve.response.following().empty()))
      comparison.remarks.push_back(
          {fmt::format("{} and {} do not go through the same stages: what follows the first "
                       "loading is not compared.",
                       curve.label, all.front().label)});
  }
  if (std::ranges::count(takes_part, true) < 2) return;
  double largest = 0.0;
  for (const meshes::PressSample& sample : first.samples())
    largest = std::max(largest, std::abs(sample.normal_force));
  for (std::size_t i = 0; i < first.following().size(); ++i) {
    const meshes::PressSample& wanted = first.following()[i];
    FollowingRow row{wanted.stage, wanted.time, wanted.indentation, {}};
    for (std::size_t c = 0; c < all.size(); ++c) {
      ComparedForce& cell = row.forces.emplace_back();
      if (!takes_part[c]) continue;
      const meshes::PressSample& sample = all[c].response.following()[i];
      cell.force = {sample.normal_force, sample.force_error};
      // Where hardly a force is left, differences are those of noise.
      constexpr double left = 1e-3;
      if (std::abs(wanted.normal_force) > left * largest)
        cell.difference = cell.force.value / wanted.normal_force - 1.0;
    }
    comparison.following.push_back(std::move(row));
  }
}

Comparison compare(std::vector<ComparedCurve> curves) {
  Comparison comparison{std::move(curves), {}, {}, {}, {}};
  const std::vector<ComparedCurve>& all = comparison.curves;
  comparison.depths = compared_depths(all);
  for (const double depth : comparison.depths) {
    std::vector<ComparedForce> row;
    const double first = told_force(all.front(), depth).value;
    for (const ComparedCurve& curve : all) {
      const CurveForce force = told_force(curve, depth);
      row.push_back({force, force.value / first - 1.0});
    }
    comparison.rows.push_back(std::move(row));
  }
  for (std::size_t i = 1; i < all.size(); ++i) {
    const auto remark =
        remark_on(all[i].label, all[i].condition, all.front().label, all.front().condition);
    if (remark) comparison.remarks.push_back(*remark);
  }
  compare_following(comparison);
  return comparison;
}

}  // namespace

std::string folder_name(const fs::path& folder) {
  const fs::path full = fs::weakly_canonical(folder);
  return full.has_filename() ? full.filename().string() : full.parent_path().filename().string();
}

OverallDifference overall(const ComparedCurve& curve, const ComparedCurve& first) {
  OverallDifference result;
  result.from = std::max({0.0, curve.first_depth(), first.first_depth()});
  result.to = std::min(curve.depth(), first.depth());
  if (result.from < result.to)
    result.l2 =
        meshes::relative_l2_force_error(curve.response, first.response, result.from, result.to);
  return result;
}

std::string interpolated_curves(const Comparison& comparison) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i < comparison.curves.size(); ++i)
    if (comparison.interpolates(i)) names.push_back(comparison.curves[i].label);
  return names.empty() ? "" : enumerate(names);
}

Comparison read_comparison(const std::vector<fs::path>& runs, FolderReader& reader) {
  std::vector<ComparedCurve> curves;
  for (const fs::path& run : runs)
    for (ComparedCurve& curve : read_curves(run, reader)) curves.push_back(std::move(curve));
  std::erase_if(curves, [](const ComparedCurve& curve) { return curve.response.empty(); });
  if (curves.size() < 2) {
    reader.throw_if_damaged();
    throw meshes::InvalidInput(meshes::Violation{"runs",
                                                 std::to_string(curves.size()) + " force curves",
                                                 "a comparison needs at least two force curves",
                                                 "name another run folder with a response.csv"});
  }
  std::ranges::stable_partition(
      curves, [](const ComparedCurve& curve) { return fs::exists(curve.folder / "job.json"); });
  make_unique(curves);
  give_styles(curves);
  return compare(std::move(curves));
}

}  // namespace fingertip::studies::report::inline results
