#include "calibration/material_tests/zeroed_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;

double largest_stress(const MaterialTest& test) {
  return VectorXd::Map(test.stress.data(), Index(test.stress.size())).cwiseAbs().maxCoeff();
}

/// From rest to the largest strain.
double reach_of(const MaterialTest& test) {
  double reach = 0.0;
  for (const double l : test.deformation) reach = std::max(reach, std::abs(l - rest_of(test.kind)));
  return reach;
}

ZeroedModel::ZeroedModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
                         std::vector<MaterialParameter> parameters, ZeroPlaces zeros)
    : test_(std::move(test)),
      scales_(std::move(scales)),
      choice_(choice),
      parameters_(std::move(parameters)),
      zeros_(zeros),
      law_(test_, scales_, choice_, parameters_) {}

CurveSlopes ZeroedModel::shifted(double zero, const VectorXd& parameters) const {
  return LawModel(without_zeros(test_, 0.0, zero), scales_, choice_, parameters_)
      .evaluate(parameters);
}

CurveSlopes ZeroedModel::evaluate(const VectorXd& parameters) {
  CurveSlopes answer;
  if (zeros_.strain) {
    const double zero = parameters(*zeros_.strain), step = 1e-5 * reach_of(test_);
    answer = shifted(zero, parameters);
    answer.jacobian.col(*zeros_.strain) =
        (shifted(zero + step, parameters).value - shifted(zero - step, parameters).value) /
        (2.0 * step);
  } else {
    answer = law_.evaluate(parameters);
  }
  if (zeros_.stress)
    for (Index i = 0; i < answer.value.size(); ++i) {
      const double scale = scales_[std::size_t(i)];
      answer.value(i) += parameters(*zeros_.stress) / scale;
      answer.jacobian(i, *zeros_.stress) = 1.0 / scale;
    }
  return answer;
}

MaterialTest without_zeros(MaterialTest test, double stress_zero, double strain_zero) {
  for (double& stress : test.stress) stress -= stress_zero;
  for (double& deformation : test.deformation) deformation -= strain_zero;
  for (double& deformation : test.path.deformation) deformation -= strain_zero;
  return test;
}

}  // namespace fingertip::calibration::inline material_tests
