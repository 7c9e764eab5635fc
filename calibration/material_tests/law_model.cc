#include "calibration/material_tests/law_model.h"

#include <ceres/jet.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/rubber/law_terms.h"

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

/// G and the shape of a law from coefficients in the order of law_coefficients.
template <typename Number>
struct Sized {
  Number shear_modulus;
  std::array<Number, 6> shape{};
};
template <typename Number>
Sized<Number> sized(const LawChoice& choice, const std::array<Number, 6>& c) {
  const std::size_t count = law_coefficients(choice).size();
  Sized<Number> law{c[0]};
  switch (choice.law) {
    case RubberLaw::yeoh:
      law.shear_modulus = 2.0 * c[0];
      for (std::size_t i = 1; i < count; ++i) law.shape[i - 1] = c[i] / law.shear_modulus;
      break;
    case RubberLaw::mooney_rivlin:
      law.shear_modulus = 2.0 * (c[0] + c[1]);
      law.shape[0] = 2.0 * c[1] / law.shear_modulus;
      break;
    case RubberLaw::ogden:
      for (std::size_t i = 2; i < count; i += 2) law.shear_modulus += c[i];
      for (std::size_t i = 0; i < count; i += 2) {
        law.shape[i] = c[i] / law.shear_modulus;
        law.shape[i + 1] = c[i + 1];
      }
      break;
    case RubberLaw::gent: law.shape[0] = c[1]; break;
    default: break;
  }
  return law;
}

void check_modulus(double g) {
  if (!(g > 0.0) || !std::isfinite(g))
    throw meshes::InvalidInput({"rubber.shear_modulus", meshes::to_text(g) + " Pa",
                                "the coefficients must make a positive shear modulus",
                                "give tests that reach small strain"});
}

/// With derivatives by its coefficients.
using Jet = ceres::Jet<double, 6>;
Sized<Jet> law_with_slopes(const LawChoice& choice, const VectorXd& coefficients) {
  std::array<Jet, 6> c;
  for (int i = 0; i < int(law_coefficients(choice).size()); ++i)
    c[std::size_t(i)] = Jet(coefficients(i), i);
  const Sized<Jet> law = sized(choice, c);
  check_modulus(law.shear_modulus.a);
  return law;
}

/// Stress parts of the law at a deformation and their derivatives, two columns each; NotConverged
/// beyond its limit.
void put_parts(RubberLaw choice, const Sized<Jet>& law, TestKind kind, double deformation,
               Eigen::Ref<Eigen::RowVectorXd> row) {
  const auto response =
      principal_response(choice, law.shape, principal_stretches(kind, deformation));
  if (!std::isfinite(response.energy.a))
    throw meshes::NotConverged("the stretch " + meshes::to_text(deformation) +
                               " is beyond the limit of the gent law");
  std::array<Jet, 3> kirchhoff;
  for (std::size_t k = 0; k < 3; ++k) kirchhoff[k] = law.shear_modulus * response.kirchhoff[k];
  for (int column = 0; 2 * column + 1 < row.size(); ++column) {
    Three tau;
    for (std::size_t k = 0; k < 3; ++k)
      tau[k] = column == 0 ? kirchhoff[k].a : kirchhoff[k].v(column - 1);
    const auto parts = stress_parts(kind, tau, deformation);
    row(2 * column) = parts[0];
    row(2 * column + 1) = parts[1];
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
    for (law.branches = 0; law.branches <= max_branches; ++law.branches)
      if (name(law) == text) return law;
  return std::nullopt;
}

std::vector<MaterialParameter> coefficients(const LawChoice& choice) {
  using enum MaterialParameter;
  static_assert(int(relaxation_tau5) - int(relaxation_g1) + 1 == 2 * max_branches);
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
  std::array<double, 6> all{};
  std::copy_n(c.data(), law_coefficients(choice).size(), all.begin());
  const Sized<double> law = sized(choice, all);
  check_modulus(law.shear_modulus);
  return {law.shear_modulus, {choice.law, meshes::VolumetricLaw::quadratic, law.shape}};
}

VectorXd shear_modulus_slopes(const LawChoice& choice, const VectorXd& coefficients) {
  return law_with_slopes(choice, coefficients)
      .shear_modulus.v.head(Index(law_coefficients(choice).size()));
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

PartTable LawModel::parts_at(const std::vector<double>& deformations,
                             const VectorXd& parameters) const {
  const Sized<Jet> law = law_with_slopes(choice_, parameters);
  PartTable parts(Index(deformations.size()), 2 + 2 * Index(law_coefficients(choice_).size()));
  for (std::size_t i = 0; i < deformations.size(); ++i)
    put_parts(choice_.law, law, test_.kind, deformations[i], parts.row(Index(i)));
  return parts;
}

PartTable LawModel::equilibrium_parts(const VectorXd& parameters) const {
  return parts_at(course_.states(), parameters);
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
    const PartTable parts = parts_at(test_.deformation, parameters);
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
