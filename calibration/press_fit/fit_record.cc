#include "calibration/press_fit/fit_record.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/files/fit_tables.h"
#include "calibration/material/file_parts.h"
#include "calibration/material/moduli.h"
#include "calibration/statistics/curve_residuals.h"
#include "calibration/statistics/fit_entries.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> list(const VectorXd& values) {
  return {values.begin(), values.end()};
}

/// What is at its bound: of E it may be Poisson's ratio.
std::optional<std::string> bound_of(const CurveFit& fit, std::size_t i) {
  if (!fit.at_bound[i]) return std::nullopt;
  return fit.poissons_ratio_bound ? "poissons_ratio" : fit.labels[i];
}

ParameterEntry described(const FitRecord& record, std::size_t i) {
  const CurveFit& fit = record.fit;
  const FreeParameter& free = record.options.free[i];
  ParameterEntry entry = parameter_entry(fit, i);
  entry.name = label(free);
  entry.bound_of = bound_of(fit, i);
  entry.start = free.start;
  if (free.prior) entry.prior = {free.prior->mean, free.prior->deviation};
  entry.interval = i < record.profiled.size() && record.profiled[i] ? "profile" : "linear";
  return entry;
}

std::vector<DirectionEntry> directions(const FitRecord& record,
                                       const std::vector<Direction>& found) {
  std::vector<DirectionEntry> result;
  for (const Direction& direction : found) {
    meshes::Entries<double> changes;
    for (std::size_t i = 0; i < record.fit.parameters.size(); ++i)
      changes[record.fit.labels[i]] = direction.changes(Index(i));
    result.push_back(
        {changes, direction.relative_singular_value, direction.interval, direction.statement});
  }
  return result;
}

struct RelativeSize {
  double worst = 0.0, rms = 0.0;
};

/// |residual| over |y|; where y is zero, and over a travel, whose touch is unknown, over the
/// largest |y|.
RelativeSize relative_size(const VectorXd& residuals, const Curve& curve) {
  const VectorXd values = values_of(curve);
  const double largest = std::max(values.cwiseAbs().maxCoeff(), 1e-300);
  RelativeSize size;
  for (Index i = 0; i < values.size(); ++i) {
    const double base = values(i) != 0.0 && !curve.is_travel ? std::abs(values(i)) : largest;
    const double relative = std::abs(residuals(i)) / base;
    size.worst = std::max(size.worst, relative);
    size.rms += relative * relative / double(values.size());
  }
  size.rms = std::sqrt(size.rms);
  return size;
}

CurveEntry curve_entry(const FitRecord& record, std::size_t i) {
  const Curve& curve = record.curves[i];
  const RelativeSize size = relative_size(own_residuals(record, i), curve);
  CurveEntry entry;
  entry.name = curve.name;
  entry.condition = record.conditions[i];
  entry.x_quantity = curve.x_quantity;
  entry.y_quantity = curve.y_quantity;
  entry.points = curve.x.size();
  entry.worst_relative_residual = size.worst;
  entry.rms_relative_residual = size.rms;
  entry.structure = structure_of(record, i);
  if (!record.left_out.empty()) {
    const LeftOut& without = record.left_out[i];
    entry.left_out = {list(without.estimates),
                      without.failure.empty() ? without.worst_relative_error : unknown,
                      without.failure};
  }
  if (curve.course.rows > 0) entry.course = curve.course;
  return entry;
}

std::optional<ProfileEntry> profile_entry(const FitRecord& record) {
  if (!record.profile) return std::nullopt;
  const Profile& profile = *record.profile;
  return ProfileEntry{std::string(name(record.profile_first)),
                      std::string(name(record.profile_second)), list(profile.first_values),
                      list(profile.second_values), rows(profile.increase)};
}

/// How deep the deepest press went, as a share of the rubber's thickness; null without presses.
ValidityEntry validity_entry(const Material& material) {
  const Validity& validity = material.validity;
  const bool pressed = validity.largest_indentation && validity.thickness;
  return {pressed ? *validity.largest_indentation / *validity.thickness : unknown, material.spacing,
          material.rubber.poissons_ratio(), std::string(lattice::name(material.model)),
          std::string(lattice::name(material.kinematics.value_or(lattice::Kinematics::small)))};
}

std::optional<RigFile> rig_file(const FitRecord& record) {
  if (record.rig.empty()) return std::nullopt;
  RigFile file;
  for (const RigValue& each : record.rig) {
    RigEntry entry{each.of, each.place.has_value(), each.held, unknown, unknown, each.given};
    if (each.place) {
      const Index i = Index(*each.place);
      entry.value = record.fit.estimates(i);
      entry.lower = record.fit.lower(i);
      entry.upper = record.fit.upper(i);
    }
    using enum MaterialParameter;
    (each.quantity == touch_offset   ? file.touch_offset
     : each.quantity == compliance   ? file.compliance
     : each.quantity == force_offset ? file.force_offset
                                     : file.drift)
        .push_back(std::move(entry));
  }
  return file;
}

/// The network's are its rubber's, exactly.
ElasticModuli moduli_of(const Material& material) {
  const meshes::Rubber& rubber = material.rubber;
  if (material.model == lattice::ModelKind::network)
    return moduli_from_stiffness(rubber.lame_lambda() + 2.0 * rubber.shear_modulus,
                                 rubber.lame_lambda(), rubber.shear_modulus);
  return homogenised_moduli(material.constants, material.spacing);
}

/// What the contract's readers of a fit to moduli know, too.
void add_material(const FitRecord& record, FitFile& file) {
  const Material& material = record.material;
  file.problem = record.problem;
  file.model = lattice::name(material.model);
  file.spacing = material.spacing;
  file.constants = constants_entry(material.model, material.constants, material.rubber);
  file.damping = {material.rubber.retardation_time};
  if (record.target) file.target = rubber_entry(*record.target);
  file.rubber = rubber_entry(material.rubber);
  file.achieved = moduli_of(material);
  file.forward = record.forward;
}

void add_statistics(const FitRecord& record, FitFile& file) {
  const CurveFit& fit = record.fit;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    file.parameters.push_back(described(record, i));
  file.covariance = rows(fit.covariance);
  file.correlation = rows(fit.correlation);
  file.singular_values = list(fit.singular_values);
  file.unidentifiable = directions(record, fit.unidentifiable);
  file.only_from_priors = directions(record, fit.only_from_priors);
  file.degrees_of_freedom = fit.degrees_of_freedom;
  file.chi_square = fit.chi_square.value_or(unknown);
  file.chi_square_probability = fit.chi_square_probability.value_or(unknown);
  file.birge_ratio = fit.birge_ratio;
  if (!record.model_error.empty()) file.model_error = record.model_error;
  file.converged = fit.converged;
  file.poissons_ratio_bound = fit.poissons_ratio_bound.value_or(unknown);
  file.residual_deviation = fit.residual_deviation;
  file.minima = minimum_entries(fit);
  file.iterations = fit.iterations;
  file.evaluations = fit.evaluations;
}

}  // namespace

std::vector<double> total_sigma(const FitRecord& record, std::size_t curve) {
  std::vector<double> result = record.curves[curve].sigma;
  const MatrixXd& known = record.options.model_covariance;
  if (known.size() == 0) return result;
  Index value = first_value(record.curves, curve);
  for (double& sigma : result) sigma = std::hypot(sigma, std::sqrt(known(value, value))), ++value;
  return result;
}

const VectorXd& own_residuals(const FitRecord& record, std::size_t curve) {
  return record.own_residuals.empty() ? record.fit.residuals[curve] : record.own_residuals[curve];
}

ResidualStructure structure_of(const FitRecord& record, std::size_t curve) {
  const VectorXd& residuals = record.fit.residuals[curve];
  const std::vector<double>& sigma = record.curves[curve].sigma;
  if (sigma.empty()) return residual_structure(own_residuals(record, curve));
  const MatrixXd& known = record.options.model_covariance;
  if (known.size() == 0) return residual_structure(residuals);
  const Index first = first_value(record.curves, curve);
  // Whitened by itself: errors that presses share would bring one press's order into another's.
  const Index count = residuals.size();
  const auto eigen = decomposed_covariance(known.block(first, first, count, count),
                                           VectorXd::Map(sigma.data(), count));
  return residual_structure(VectorXd(eigen.inverse_root() * residuals));
}

std::size_t rubber_parameters(const CurveFit& fit) {
  return std::size_t(std::ranges::count_if(
      fit.parameters, [](MaterialParameter parameter) { return !is_behind_the_press(parameter); }));
}

double worst_relative_residual(const FitRecord& record) {
  double worst = 0.0;
  for (std::size_t c = 0; c < record.curves.size(); ++c)
    worst = std::max(worst, worst_relative_error(own_residuals(record, c), record.curves[c]));
  return worst;
}

void write_fit_json(const FitRecord& record, const std::filesystem::path& file) {
  FitFile fit;
  add_material(record, fit);
  add_statistics(record, fit);
  fit.x_quantity = record.curves.front().x_quantity;
  fit.y_quantity = record.curves.front().y_quantity;
  for (std::size_t i = 0; i < record.curves.size(); ++i) {
    fit.curves.push_back(curve_entry(record, i));
    fit.residuals.push_back(list(record.fit.residuals[i]));
  }
  fit.influence = rows(record.fit.influence);
  fit.profile = profile_entry(record);
  fit.wall_time = record.wall_time;
  fit.validity = validity_entry(record.material);
  fit.failed = failed_tests(record);
  fit.rig = rig_file(record);
  fit.lack_of_fit = record.lack_of_fit;
  fit.errors = record.errors;
  fit.sensitivities = record.sensitivities;
  fit.rivals = record.rivals;
  fit.predicted = record.predicted;
  fit.next = next_entries(record.next, record.fit.labels, record.fit.estimates, record.fit.lower,
                          record.fit.upper);
  fit.repeats = record.repeats;
  fit.statement = fit_statement(record);
  meshes::write_json_file(fit, file);
}

void write_fit_data(const FitRecord& record, const std::filesystem::path& file) {
  std::vector<FitDataRow> rows;
  for (std::size_t c = 0; c < record.curves.size(); ++c) {
    const Curve& curve = record.curves[c];
    const std::vector<double> total = total_sigma(record, c);
    // A fit without the curve that failed predicts nothing.
    const bool predicted = !record.left_out.empty() && record.left_out[c].failure.empty();
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      FitDataRow& row = rows.emplace_back();
      row.curve = curve.name;
      row.x = curve.x[i], row.measured = curve.y[i];
      row.fitted = curve.y[i] - record.fit.residuals[c](Index(i));
      if (predicted) row.left_out = curve.y[i] - record.left_out[c].residuals(Index(i));
      if (!record.indentation.empty()) row.indentation = record.indentation[c][i];
      if (curve.sigma.empty()) continue;
      row.sigma = curve.sigma[i], row.total_sigma = total[i];
      row.whitened_residual = record.fit.whitened_residuals[c](Index(i));
    }
  }
  meshes::write_rows(rows, file);
}

}  // namespace fingertip::calibration::inline press_fit
