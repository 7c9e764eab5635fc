/// Material tests whose zeros of stress and strain are sought with the law.
#pragma once

#include <optional>
#include <vector>

#include "calibration/material_tests/law_result.h"

namespace fingertip::calibration::inline material_tests {

/// Largest |stress| [Pa], and largest distance of the deformation from rest.
double largest_stress(const MaterialTest& test);
double reach_of(const MaterialTest& test);

/// A test that measures s0 + the law's stress at l - e0, over its scales: s0 exact, the slope by e0
/// by central differences of the law's stress.
class ZeroedModel final : public ForwardModel {
 public:
  ZeroedModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
              std::vector<MaterialParameter> parameters, ZeroPlaces zeros);
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

 private:
  /// The law at l - zero.
  CurveSlopes shifted(double zero, const Eigen::VectorXd& parameters) const;

  MaterialTest test_;
  std::vector<double> scales_;
  LawChoice choice_;
  std::vector<MaterialParameter> parameters_;
  ZeroPlaces zeros_;
  LawModel law_;
};

/// The test with its zeros taken off.
MaterialTest without_zeros(MaterialTest test, double stress_zero, double strain_zero);

}  // namespace fingertip::calibration::inline material_tests
