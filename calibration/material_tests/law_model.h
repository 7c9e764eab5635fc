/// From coefficients of a law at large strain to the stresses of material tests, in closed form.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calibration/curves/forward_model.h"
#include "calibration/material_tests/material_test.h"
#include "meshes/strain_energy.h"

namespace fingertip::calibration {

/// A law and how many terms of its series it has: yeoh and ogden 1 to 3, the others 1.
struct LawChoice {
  meshes::RubberLaw law = meshes::RubberLaw::neo_hookean;
  int terms = 1;
  bool operator==(const LawChoice&) const = default;
};
/// "neo-hookean", "yeoh-3", "ogden-2".
std::string name(const LawChoice& choice);
/// Every law that can be fitted, the simplest first. Yeoh of one term is neo-hookean.
const std::vector<LawChoice>& known_laws();
std::optional<LawChoice> law_named(std::string_view name);

/// Its coefficients, in the order in which they are fitted.
std::vector<MaterialParameter> coefficients(const LawChoice& choice);

/// A law with its shear modulus; what `meshes::StrainEnergy` is made of.
struct SizedLaw {
  double shear_modulus = 0.0;  ///< G at rest [Pa]
  meshes::StrainEnergy energy;
};
/// From coefficients in that order. neo_hookean G; yeoh C_i, G = 2 C1; mooney_rivlin C10, C01,
/// G = 2 (C10 + C01); ogden mu_i, alpha_i, G = sum mu_i; gent G, Jm. Throws InvalidInput unless
/// G > 0.
SizedLaw sized_law(const LawChoice& choice, const Eigen::VectorXd& coefficients);

/// Stress [Pa] of an incompressible body: with tau_k of `principal_response` and l the deformation
///
///   uniaxial               (tau_1 - tau_2)/l        nominal; times l: true
///   equibiaxial, planar    (tau_1 - tau_3)/l        likewise
///   simple shear           (tau_1 - tau_3)/sqrt(4 + l²)
///
/// the last by dW/d(shear), ln of the longest stretch being asinh(l/2). Infinite beyond the limit
/// of a gent law. Not for volumetric tests.
double test_stress(const SizedLaw& law, TestKind kind, StressMeasure measure, double deformation);

/// Mean stress K (J - 1) [Pa] of the volumetric law `quadratic`, which the deviatoric law does not
/// enter; d/dK is J - 1.
double mean_stress(double bulk_modulus, double volume_ratio);

/// A material test as a curve of deformation, every stress over a scale of its own. Derivatives are
/// exact: a law is a sum over its coefficients but for Ogden's exponents and Jm.
class LawModel final : public ForwardModel {
 public:
  /// `scales` > 0, one per point [Pa]. `parameters` are the choice's coefficients, bulk_modulus
  /// after them where it is sought.
  LawModel(MaterialTest test, std::vector<double> scales, LawChoice choice,
           std::vector<MaterialParameter> parameters);

  /// Throws InvalidInput unless G > 0, NotConverged beyond the limit of a gent law.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;

 private:
  MaterialTest test_;
  std::vector<double> scales_;
  LawChoice choice_;
  std::vector<MaterialParameter> parameters_;
};

}  // namespace fingertip::calibration
