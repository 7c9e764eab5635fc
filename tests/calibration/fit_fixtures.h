/// Models by formula, presses of the default rubber and curves made of them.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "calibration/press_fit/lattice_forward_model.h"
#include "calibration/press_fit/scaled_model.h"
#include "calibration/statistics/curve_fit.h"
#include "calibration/statistics/curve_residuals.h"
#include "meshes/base/errors.h"
#include "tests/expectations.h"

namespace fit_fixtures {

using namespace fingertip;
using namespace fingertip::calibration;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using enum MaterialParameter;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;

/// Parameters' names mean nothing to it.
class FormulaModel final : public ForwardModel {
 public:
  using Formula = std::function<CurveSlopes(const VectorXd&)>;
  explicit FormulaModel(Formula formula) : formula_(std::move(formula)) {}
  CurveSlopes evaluate(const VectorXd& parameters) override { return formula_(parameters); }

 private:
  Formula formula_;
};

/// F = p0 x + p1 x²
inline FormulaModel parabola(const std::vector<double>& x) {
  return FormulaModel([x](const VectorXd& p) {
    MatrixXd design(Index(x.size()), 2);
    for (Index i = 0; i < design.rows(); ++i)
      design.row(i) << x[std::size_t(i)], x[std::size_t(i)] * x[std::size_t(i)];
    return CurveSlopes{design * p, design};
  });
}

inline const meshes::Rubber rubber;  // E = 40, G = 14 gf/cm²

inline PressSetup press(ContactMode contact, ModelKind model = ModelKind::hookean) {
  PressSetup setup;
  setup.lattice.model = model;
  setup.lattice.spacing = setup.geometry.tip_radius / 6.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = contact;
  return setup;
}

inline PressSetup with_samples(PressSetup setup, const std::vector<double>& samples) {
  setup.protocol.samples = samples;
  setup.protocol.depth = samples.back();
  return setup;
}

/// The lattice as fits of moduli ask it: at few Poisson's ratios.
inline ScaledModel scaled_press(const PressSetup& setup,
                                const std::vector<MaterialParameter>& parameters) {
  const auto solve =
      [press = std::make_shared<LatticeByRatio>(setup)](const std::vector<double>& ratios) {
        std::vector<VectorXd> answers;
        for (const double nu : ratios)
          answers.push_back(press->evaluate(VectorXd::Constant(1, nu)).value);
        return answers;
      };
  return {solve, parameters, setup.rubber};
}

/// A condition per curve: how it was pressed and by what lattice it is computed; depth and samples
/// are the curve's.
inline CurveFit fit_presses(const std::vector<Curve>& curves,
                            const std::vector<PressSetup>& conditions,
                            const CurveFitOptions& options,
                            const std::function<bool()>& go_on = {}) {
  check_curve_fit(curves, options);
  std::vector<LatticeForwardModel> models;
  for (std::size_t i = 0; i < curves.size(); ++i)
    models.emplace_back(with_samples(conditions[i], curves[i].x), parameters_in(options), go_on);
  std::vector<ForwardModel*> addresses;
  for (LatticeForwardModel& model : models) addresses.push_back(&model);
  return fit_curves(curves, addresses, options);
}

inline const std::vector<double> depths = {2e-4, 4e-4, 6e-4, 8e-4, 10e-4, 12e-4};  // [m]
inline const std::vector<double> shallow = {2e-4, 4e-4, 6e-4, 8e-4, 10e-4};        // [m]

/// Forces of the default rubber, with a normal error of `noise` times each, known if `with_sigma`.
inline Curve synthetic(ContactMode contact, const std::vector<double>& at, double noise,
                       unsigned seed, bool with_sigma) {
  Curve curve;
  curve.x = at;
  const PressSetup condition = press(contact);
  LatticeForwardModel model(with_samples(condition, at), {youngs_modulus, shear_modulus});
  const VectorXd force =
      model.evaluate(Eigen::Vector2d(rubber.youngs_modulus, rubber.shear_modulus)).value;
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  for (const double exact : force) {
    curve.y.push_back(exact * (1.0 + noise * normal(generator)));
    if (with_sigma) curve.sigma.push_back(exact * noise);
  }
  return curve;
}

/// Starts 15 and 12 % off, on the incompressible side: Poisson's ratio 0.46 instead of 0.43.
inline CurveFitOptions e_and_g() {
  CurveFitOptions options;
  options.free = {{.parameter = youngs_modulus, .start = 4500.0},
                  {.parameter = shear_modulus, .start = 1540.0}};
  return options;
}

}  // namespace fit_fixtures
