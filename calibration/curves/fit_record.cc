#include "calibration/curves/fit_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>

#include "calibration/json_parts.h"
#include "calibration/moduli.h"
#include "meshes/files.h"

namespace fingertip::calibration {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::to_text;
using nlohmann::ordered_json;

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

ordered_json or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json list(const VectorXd& values) {
  ordered_json result = ordered_json::array();
  for (const double value : values) result.push_back(or_null(value));
  return result;
}

ordered_json rows(const MatrixXd& matrix) {
  ordered_json result = ordered_json::array();
  for (Index i = 0; i < matrix.rows(); ++i) result.push_back(list(matrix.row(i).transpose()));
  return result;
}

ordered_json or_null(const std::optional<double>& value) {
  return value ? or_null(*value) : ordered_json();
}

/// What is at its bound: of E it may be Poisson's ratio.
ordered_json bound_of(const CurveFit& fit, std::size_t i) {
  if (!fit.at_bound[i]) return nullptr;
  return fit.poissons_ratio_bound ? "poissons_ratio" : name(fit.parameters[i]);
}

ordered_json parameter_entry(const FitRecord& record, std::size_t i) {
  const CurveFit& fit = record.fit;
  const FreeParameter& free = record.options.free[i];
  ordered_json prior;
  if (free.prior) prior = {{"mean", free.prior->mean}, {"deviation", free.prior->deviation}};
  return {{"name", name(free.parameter)},
          {"unit", unit(free.parameter)},
          {"estimate", or_null(fit.estimates(Index(i)))},
          {"standard_error", or_null(fit.standard_errors(Index(i)))},
          {"lower", or_null(fit.lower(Index(i)))},
          {"upper", or_null(fit.upper(Index(i)))},
          {"at_bound", bool(fit.at_bound[i])},
          {"bound_of", bound_of(fit, i)},
          {"start", free.start},
          {"prior", prior},
          {"bias", nullptr}};
}

ordered_json directions(const FitRecord& record, const std::vector<Direction>& found) {
  ordered_json result = ordered_json::array();
  for (const Direction& one : found) {
    ordered_json changes = ordered_json::object();
    for (std::size_t i = 0; i < record.fit.parameters.size(); ++i)
      changes[std::string(name(record.fit.parameters[i]))] = or_null(one.changes(Index(i)));
    result.push_back({{"direction", changes},
                      {"relative_singular_value", or_null(one.relative_singular_value)},
                      {"interval", or_null(one.interval)},
                      {"statement", one.statement}});
  }
  return result;
}

struct RelativeSize {
  double worst = 0.0, rms = 0.0;
};

/// |residual| over |y|; where y is zero over the largest |y|.
RelativeSize relative_size(const VectorXd& residuals, const std::vector<double>& y) {
  const VectorXd values = Eigen::Map<const VectorXd>(y.data(), Index(y.size()));
  const double largest = std::max(values.cwiseAbs().maxCoeff(), 1e-300);
  RelativeSize size;
  for (Index i = 0; i < values.size(); ++i) {
    const double base = values(i) != 0.0 ? std::abs(values(i)) : largest;
    const double relative = std::abs(residuals(i)) / base;
    size.worst = std::max(size.worst, relative);
    size.rms += relative * relative / double(values.size());
  }
  size.rms = std::sqrt(size.rms);
  return size;
}

ordered_json curve_entry(const FitRecord& record, std::size_t i) {
  const Curve& curve = record.curves[i];
  const VectorXd& residuals = record.fit.residuals[i];
  const ResidualStructure structure = structure_of(record, i);
  const RelativeSize size = relative_size(residuals, curve.y);
  ordered_json left_out;
  if (!record.left_out.empty()) {
    const LeftOut& without = record.left_out[i];
    left_out = {{"estimates", list(without.estimates)},
                {"worst_relative_error",
                 without.failure.empty() ? or_null(without.worst_relative_error) : ordered_json()},
                {"failure", without.failure}};
  }
  return {{"name", curve.name},
          {"condition", record.conditions[i]},
          {"x_quantity", curve.x_quantity},
          {"y_quantity", curve.y_quantity},
          {"points", curve.x.size()},
          {"worst_relative_residual", or_null(size.worst)},
          {"rms_relative_residual", or_null(size.rms)},
          {"structure",
           {{"runs", structure.runs},
            {"probability", or_null(structure.probability)},
            {"statement", structure.statement}}},
          {"left_out", left_out}};
}

ordered_json profile_entry(const FitRecord& record) {
  if (!record.profile) return nullptr;
  const Profile& profile = *record.profile;
  return {{"first", name(record.profile_first)},
          {"second", name(record.profile_second)},
          {"first_values", list(profile.first_values)},
          {"second_values", list(profile.second_values)},
          {"increase", rows(profile.increase)}};
}

/// How deep the deepest press went, as a share of the rubber's thickness; null without presses.
ordered_json validity_entry(const Material& material) {
  const Validity& validity = material.validity;
  const bool pressed = validity.largest_indentation && validity.thickness;
  return {{"largest_strain_measure",
           pressed ? or_null(*validity.largest_indentation / *validity.thickness) : ordered_json()},
          {"spacing", material.spacing},
          {"poissons_ratio", material.rubber.poissons_ratio()},
          {"model", lattice::name(material.model)},
          {"kinematics", lattice::name(material.kinematics.value_or(lattice::Kinematics::small))}};
}

ordered_json minima(const CurveFit& fit) {
  ordered_json result = ordered_json::array();
  for (const Minimum& one : fit.minima)
    result.push_back({{"estimates", list(one.estimates)},
                      {"loss", or_null(one.loss)},
                      {"iterations", one.iterations},
                      {"converged", one.converged}});
  return result;
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
ordered_json material_entries(const FitRecord& record) {
  const Material& material = record.material;
  ordered_json json = {
      {"problem", record.problem},
      {"model", lattice::name(material.model)},
      {"spacing", material.spacing},
      {"constants", constants_json(material.model, material.constants, material.rubber)},
      {"damping", {{"retardation_time", material.rubber.retardation_time}}}};
  json["target"] = record.target ? rubber_json(*record.target) : ordered_json();
  json["rubber"] = rubber_json(material.rubber);
  json["achieved"] = moduli_json(moduli_of(material));
  json["forward"] = record.forward;
  return json;
}

ordered_json statistics_entries(const FitRecord& record) {
  const CurveFit& fit = record.fit;
  ordered_json json;
  json["parameters"] = ordered_json::array();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    json["parameters"].push_back(parameter_entry(record, i));
  json["covariance"] = rows(fit.covariance);
  json["correlation"] = rows(fit.correlation);
  json["singular_values"] = list(fit.singular_values);
  json["unidentifiable"] = directions(record, fit.unidentifiable);
  json["only_from_priors"] = directions(record, fit.only_from_priors);
  json["degrees_of_freedom"] = fit.degrees_of_freedom;
  json["chi_square"] = or_null(fit.chi_square);
  json["chi_square_probability"] = or_null(fit.chi_square_probability);
  json["birge_ratio"] = fit.birge_ratio;
  json["model_error"] =
      record.model_error.empty() ? ordered_json() : ordered_json(record.model_error);
  json["converged"] = fit.converged;
  json["poissons_ratio_bound"] = or_null(fit.poissons_ratio_bound);
  json["residual_deviation"] = or_null(fit.residual_deviation);
  json["minima"] = minima(fit);
  return json;
}

/// All curves' lists one below the other; NaN where there are none.
struct Columns {
  std::vector<VectorXd> fitted, left_out;
};

Columns columns(const FitRecord& record) {
  Columns result;
  for (std::size_t i = 0; i < record.curves.size(); ++i) {
    const Curve& curve = record.curves[i];
    const VectorXd y = Eigen::Map<const VectorXd>(curve.y.data(), Index(curve.y.size()));
    result.fitted.push_back(y - record.fit.residuals[i]);
    // A fit without the curve that failed predicts nothing.
    const bool predicted = !record.left_out.empty() && record.left_out[i].failure.empty();
    result.left_out.push_back(predicted ? VectorXd(y - record.left_out[i].residuals)
                                        : VectorXd::Constant(y.size(), unknown));
  }
  return result;
}

std::string cell(double value) {
  return std::isfinite(value) ? to_text(value) : "";
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

}  // namespace

ResidualStructure structure_of(const FitRecord& record, std::size_t curve) {
  const std::vector<VectorXd>& residuals = record.fit.residuals;
  if (record.curves[curve].sigma.empty()) return residual_structure(residuals[curve]);
  Index count = 0, first = 0;
  for (std::size_t c = 0; c < residuals.size(); ++c) {
    if (c == curve) first = count;
    count += residuals[c].size();
  }
  VectorXd all(count);
  count = 0;
  for (const VectorXd& one : residuals) {
    all.segment(count, one.size()) = one;
    count += one.size();
  }
  return residual_structure(
      VectorXd((record.fit.whitening * all).segment(first, residuals[curve].size())));
}

double worst_relative_residual(const FitRecord& record) {
  double worst = 0.0;
  for (std::size_t c = 0; c < record.curves.size(); ++c)
    for (std::size_t i = 0; i < record.curves[c].y.size(); ++i)
      if (record.curves[c].y[i] != 0.0)
        worst =
            std::max(worst, std::abs(record.fit.residuals[c](Index(i)) / record.curves[c].y[i]));
  return worst;
}

void write_fit_json(const FitRecord& record, const std::filesystem::path& file) {
  ordered_json json = material_entries(record);
  json.update(statistics_entries(record));
  json["x_quantity"] = record.curves.front().x_quantity;
  json["y_quantity"] = record.curves.front().y_quantity;
  json["curves"] = ordered_json::array();
  json["residuals"] = ordered_json::array();
  for (std::size_t i = 0; i < record.curves.size(); ++i) {
    json["curves"].push_back(curve_entry(record, i));
    json["residuals"].push_back(list(record.fit.residuals[i]));
  }
  json["influence"] = rows(record.fit.influence);
  json["profile"] = profile_entry(record);
  json["iterations"] = record.fit.iterations;
  json["evaluations"] = record.fit.evaluations;
  json["wall_time"] = record.wall_time;
  json["validity"] = validity_entry(record.material);
  json["failed"] = failed_tests(record);
  json["statement"] = fit_statement(record);
  meshes::write_atomically(file, [&](std::ostream& out) { out << json.dump(2) << '\n'; });
}

void write_fit_data(const FitRecord& record, const std::filesystem::path& file) {
  const Columns computed = columns(record);
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "curve,x,measured,sigma,fitted,left_out\n";
    for (std::size_t c = 0; c < record.curves.size(); ++c) {
      const Curve& curve = record.curves[c];
      for (std::size_t i = 0; i < curve.x.size(); ++i)
        out << quoted(curve.name) << ',' << to_text(curve.x[i]) << ',' << to_text(curve.y[i]) << ','
            << (curve.sigma.empty() ? "" : to_text(curve.sigma[i])) << ','
            << cell(computed.fitted[c](Index(i))) << ',' << cell(computed.left_out[c](Index(i)))
            << '\n';
    }
  });
}

}  // namespace fingertip::calibration
