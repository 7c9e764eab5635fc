#include "calibration/material_tests/law_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;
using meshes::RubberLaw;
using Three = std::array<double, 3>;

namespace {

double measured_stress(const Three& kirchhoff, TestKind kind, StressMeasure measure, double l) {
  const auto parts = stress_parts(kind, kirchhoff, l), weights = part_weights(kind, measure, l);
  return parts[0] * weights[0] + parts[1] * weights[1];
}

/// d(kirchhoff)/d(alpha) of 2 mu/alpha (l^alpha - 1) at mu = 1.
Three by_exponent(double alpha, const Three& stretch) {
  Three slope;
  for (std::size_t k = 0; k < 3; ++k) {
    const double y = std::log(stretch[k]), ay = alpha * y;
    // (ay e^ay - (e^ay - 1))/alpha², whose terms cancel where ay is small.
    slope[k] = std::abs(ay) < 1e-4 ? y * y * (1.0 + 2.0 / 3.0 * ay)
                                   : 2.0 * (ay * std::exp(ay) - std::expm1(ay)) / (alpha * alpha);
  }
  return slope;
}

/// Kirchhoff stresses of a law whose coefficient `i` is 1 and whose others are 0, or its derivative
/// by coefficient i where the law is no sum of them.
Three by_coefficient(const LawChoice& choice, const VectorXd& c, Index i, const Three& stretch) {
  const auto response = [&](const meshes::StrainEnergy& energy, double modulus) {
    Three tau = principal_response(energy, stretch).kirchhoff;
    for (double& value : tau) value *= modulus;
    return tau;
  };
  const double above =
      stretch[0] * stretch[0] + stretch[1] * stretch[1] + stretch[2] * stretch[2] - 3.0;
  meshes::StrainEnergy energy;
  switch (choice.law) {
    // dW/dI1 over that of neo-Hooke, 1/2: of C_i (I1 - 3)^i.
    case RubberLaw::yeoh: return response(energy, 2.0 * double(i + 1) * std::pow(above, double(i)));
    case RubberLaw::mooney_rivlin:
      energy.law = RubberLaw::mooney_rivlin;
      energy.shape[0] = i == 0 ? 0.0 : 1.0;
      return response(energy, 2.0);
    case RubberLaw::ogden: {
      const double mu = c(i - i % 2), alpha = c(i - i % 2 + 1);
      if (i % 2 == 1) {
        Three slope = by_exponent(alpha, stretch);
        for (double& value : slope) value *= mu;
        return slope;
      }
      energy.law = RubberLaw::ogden;
      energy.shape = {1.0, alpha};
      return response(energy, 1.0);
    }
    case RubberLaw::gent: {
      const double left = c(1) - above;  // W' = G/2 Jm/(Jm - (I1 - 3))
      return response(energy, i == 0 ? c(1) / left : -c(0) * above / (left * left));
    }
    default: return response(energy, 1.0);
  }
}

}  // namespace

std::string name(const LawChoice& choice) {
  const bool series = choice.law == RubberLaw::yeoh || choice.law == RubberLaw::ogden;
  return std::string(name(choice.law)) + (series ? "-" + std::to_string(choice.terms) : "") +
         (choice.branches > 0 ? "+prony-" + std::to_string(choice.branches) : "");
}

const std::vector<LawChoice>& known_laws() {
  static const std::vector<LawChoice> laws = {
      {RubberLaw::neo_hookean, 1}, {RubberLaw::mooney_rivlin, 1}, {RubberLaw::gent, 1},
      {RubberLaw::yeoh, 2},        {RubberLaw::yeoh, 3},          {RubberLaw::ogden, 1},
      {RubberLaw::ogden, 2},       {RubberLaw::ogden, 3}};
  return laws;
}

std::optional<LawChoice> law_named(std::string_view text) {
  for (LawChoice law : known_laws())
    for (law.branches = 0; law.branches <= most_branches; ++law.branches)
      if (name(law) == text) return law;
  return std::nullopt;
}

std::vector<MaterialParameter> coefficients(const LawChoice& choice) {
  using enum MaterialParameter;
  static_assert(int(relaxation_tau5) - int(relaxation_g1) + 1 == 2 * most_branches);
  std::vector<MaterialParameter> all = law_coefficients(choice);
  for (int i = 0; i < 2 * choice.branches; ++i)
    all.push_back(MaterialParameter(int(relaxation_g1) + i));
  return all;
}

meshes::Relaxation relaxation_of(const LawChoice& choice, const VectorXd& c) {
  meshes::Relaxation relaxation;
  const Index own = Index(law_coefficients(choice).size());
  for (Index i = 0; i < choice.branches; ++i)
    relaxation.branches.push_back({c(own + 2 * i), c(own + 2 * i + 1)});
  return relaxation;
}

std::vector<MaterialParameter> law_coefficients(const LawChoice& choice) {
  using enum MaterialParameter;
  const auto first = [&](std::vector<MaterialParameter> all, int count) {
    all.resize(std::size_t(count));
    return all;
  };
  switch (choice.law) {
    case RubberLaw::yeoh: return first({yeoh_c1, yeoh_c2, yeoh_c3}, choice.terms);
    case RubberLaw::mooney_rivlin: return {mooney_c10, mooney_c01};
    case RubberLaw::ogden:
      return first({ogden_mu1, ogden_alpha1, ogden_mu2, ogden_alpha2, ogden_mu3, ogden_alpha3},
                   2 * choice.terms);
    case RubberLaw::gent: return {shear_modulus, gent_jm};
    default: return {shear_modulus};
  }
}

SizedLaw sized_law(const LawChoice& choice, const VectorXd& c) {
  SizedLaw law;
  law.energy.law = choice.law;
  law.energy.volumetric = meshes::VolumetricLaw::quadratic;
  double& g = law.shear_modulus;
  auto& shape = law.energy.shape;
  const Index count = Index(law_coefficients(choice).size());
  switch (choice.law) {
    case RubberLaw::yeoh: g = 2.0 * c(0); break;
    case RubberLaw::mooney_rivlin: g = 2.0 * (c(0) + c(1)); break;
    case RubberLaw::ogden:
      for (Index i = 0; i < count; i += 2) g += c(i);
      break;
    default: g = c(0);
  }
  if (!(g > 0.0) || !std::isfinite(g))
    throw meshes::InvalidInput({"rubber.shear_modulus", meshes::to_text(g) + " Pa",
                                "the coefficients must make a positive shear modulus",
                                "give tests that reach small strain"});
  if (choice.law == RubberLaw::yeoh)
    for (Index i = 1; i < count; ++i) shape[std::size_t(i - 1)] = c(i) / g;
  if (choice.law == RubberLaw::mooney_rivlin) shape[0] = 2.0 * c(1) / g;
  if (choice.law == RubberLaw::ogden)
    for (Index i = 0; i < count; ++i) shape[std::size_t(i)] = i % 2 == 0 ? c(i) / g : c(i);
  if (choice.law == RubberLaw::gent) shape[0] = c(1);
  return law;
}

double test_stress(const SizedLaw& law, TestKind kind, StressMeasure measure, double deformation) {
  const auto response = principal_response(law.energy, principal_stretches(kind, deformation));
  if (!std::isfinite(response.energy)) return std::numeric_limits<double>::infinity();
  return law.shear_modulus * measured_stress(response.kirchhoff, kind, measure, deformation);
}

double mean_stress(double bulk_modulus, double volume_ratio) {
  return bulk_modulus * (volume_ratio - 1.0);
}

LawModel::LawModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
                   std::vector<MaterialParameter> parameters)
    : test_(std::move(test)),
      scales_(std::move(scales)),
      choice_(choice),
      parameters_(std::move(parameters)),
      course_(test_) {}

CurveSlopes LawModel::volume(const VectorXd& parameters) const {
  const Index points = Index(test_.deformation.size()), all = Index(parameters_.size());
  const Index own = Index(coefficients(choice_).size());
  if (all <= own)
    throw meshes::InvalidInput({"test " + test_.name, "volumetric",
                                "an incompressible law says nothing of a volume",
                                "free the bulk modulus"});
  CurveSlopes result{VectorXd(points), Eigen::MatrixXd::Zero(points, all)};
  for (Index p = 0; p < points; ++p) {
    const double at = test_.deformation[std::size_t(p)], scale = scales_[std::size_t(p)];
    result.value(p) = mean_stress(parameters(own), at) / scale;
    result.jacobian(p, own) = mean_stress(1.0, at) / scale;
  }
  return result;
}

void LawModel::add_parts(const SizedLaw& law, const VectorXd& parameters, double deformation,
                         Eigen::Ref<Eigen::RowVectorXd> row) const {
  const Three stretch = principal_stretches(test_.kind, deformation);
  const auto response = principal_response(law.energy, stretch);
  if (!std::isfinite(response.energy))
    throw meshes::NotConverged("the stretch " + meshes::to_text(deformation) +
                               " is beyond the limit of the gent law");
  const auto put = [&](Index column, const Three& kirchhoff, double factor) {
    const auto parts = stress_parts(test_.kind, kirchhoff, deformation);
    row(column) = factor * parts[0];
    row(column + 1) = factor * parts[1];
  };
  put(0, response.kirchhoff, law.shear_modulus);
  for (Index i = 0; 2 * i + 3 < row.size(); ++i)
    put(2 * i + 2, by_coefficient(choice_, parameters, i, stretch), 1.0);
}

PartTable LawModel::equilibrium_parts(const VectorXd& parameters) const {
  const SizedLaw law = sized_law(choice_, parameters);
  const std::vector<double>& states = course_.states();
  PartTable parts(Index(states.size()), 2 + 2 * Index(law_coefficients(choice_).size()));
  for (std::size_t i = 0; i < states.size(); ++i)
    add_parts(law, parameters, states[i], parts.row(Index(i)));
  return parts;
}

double LawModel::scaled(std::size_t p, const Eigen::RowVector2d& parts) const {
  const auto weights = part_weights(test_.kind, test_.measure, test_.deformation[p]);
  const double factor = test_.constraint.empty() ? 1.0 : test_.constraint[p];
  return factor / scales_[p] * (weights[0] * parts(0) + weights[1] * parts(1));
}

CurveSlopes LawModel::evaluate(const VectorXd& parameters) {
  if (test_.kind == TestKind::volumetric) return volume(parameters);
  const Index points = Index(test_.deformation.size()), all = Index(parameters_.size());
  const Index own = Index(law_coefficients(choice_).size());
  CurveSlopes result{VectorXd(points), Eigen::MatrixXd::Zero(points, all)};
  const meshes::Relaxation relaxation = relaxation_of(choice_, parameters);
  double left = 1.0;
  for (const auto& branch : relaxation.branches) left -= branch.share;
  if (!(left > 0.0)) throw meshes::NotConverged("the shares of the branches sum to 1 or more");
  const auto add = [&](Index column, const PartTable& parts, Index from, double factor) {
    for (Index p = 0; p < points; ++p) {
      double& to = column < 0 ? result.value(p) : result.jacobian(p, column);
      to += factor * scaled(std::size_t(p), parts.row(p).segment<2>(from));
    }
  };
  result.value.setZero();
  if (relaxation.empty() || course_.empty()) {
    const SizedLaw law = sized_law(choice_, parameters);
    PartTable parts(points, 2 + 2 * own);
    for (Index p = 0; p < points; ++p)
      add_parts(law, parameters, test_.deformation[std::size_t(p)], parts.row(p));
    for (Index i = -1; i < own; ++i) add(i, parts, 2 * i + 2, 1.0);
    return result;
  }
  const PartTable equilibrium = equilibrium_parts(parameters), now = course_.now(equilibrium);
  for (Index i = -1; i < own; ++i) add(i, now, 2 * i + 2, 1.0);
  for (std::size_t n = 0; n < relaxation.branches.size(); ++n) {
    const RelaxingTest::Branch branch = course_.branch(equilibrium, relaxation.branches[n].time);
    const double b = relaxation.relative_modulus(n);
    for (Index i = -1; i < own; ++i) add(i, branch.held, 2 * i + 2, b);
    // b_n = g_n/left.
    for (std::size_t m = 0; m < relaxation.branches.size(); ++m)
      add(own + 2 * Index(m), branch.held, 0, (b + (m == n ? 1.0 : 0.0)) / left);
    add(own + 2 * Index(n) + 1, branch.by_time, 0, b);
  }
  return result;
}

}  // namespace fingertip::calibration::inline material_tests
