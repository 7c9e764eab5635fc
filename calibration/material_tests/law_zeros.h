/// What a machine tells of a specimen at rest: zeros of stress and strain beside a law.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/material_tests/law_model.h"
#include "calibration/material_tests/law_result.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline material_tests {

/// Where a test's zeros stand among a fit's parameters; none: they are zero.
struct ZeroPlaces {
  std::optional<Eigen::Index> stress, strain;
};

/// Adds the zeros that tests seek behind the other parameters, starts and all.
std::vector<ZeroPlaces> add_zeros(const std::vector<MaterialTest>& tests, CurveFitOptions& options);

/// A test that measures s0 + the law's stress at l - e0, over its scales: s0 exact, the slope by e0
/// by central differences of the law's stress.
class ZeroedModel final : public ForwardModel {
 public:
  ZeroedModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
              std::vector<MaterialParameter> parameters, ZeroPlaces zeros);
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

 private:
  Eigen::VectorXd shifted(double zero, const Eigen::VectorXd& parameters) const;

  MaterialTest test_;
  std::vector<double> scales_;
  LawChoice choice_;
  std::vector<MaterialParameter> parameters_;
  ZeroPlaces zeros_;
  LawModel law_;
};

/// The test with its zeros taken off.
MaterialTest without_zeros(MaterialTest test, double stress_zero, double strain_zero);

/// Stress at rest that a test's own rows near rest tell, and its standard error [Pa]: a parabola in
/// neo-Hooke's stress through the lower third of its strains; none of fewer than six such rows, or
/// of a test that keeps the volume's change.
struct StressAtRest {
  double value = 0.0, error = 0.0;
};
std::optional<StressAtRest> stress_at_rest(const MaterialTest& test);

/// Why tests whose stress does not vanish at rest, or vanishes where their rows begin away from it,
/// are no law's, a sentence each, and LawFit::with_free_zero of the laws that were tried;
/// `ranking`, the least AICc first, is of fits without further zeros. Fits of a few of its laws
/// with a free zero of every test's stress, or of every slow test's strain, must have an AICc lower
/// by ten and a zero of four standard errors; of a stress 1 % of the largest, with the rows near
/// rest not against it; of a strain 5 % of the largest, near to where a line through the least
/// stresses vanishes.
std::vector<std::string> zeros_that_show(const std::vector<MaterialTest>& tests,
                                         std::vector<LawFit>& ranking,
                                         const LawFitOptions& options);

}  // namespace fingertip::calibration::inline material_tests
